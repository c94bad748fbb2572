#include <hamel/framework/analysis/equations.hpp>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Core>

#include <hamel/framework/analysis/equations_insides.hpp>
#include <hamel/framework/analysis/equations_text.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {
namespace {

NumberMatrix matrix_of(const Eigen::MatrixXd& m) {
  NumberMatrix out(static_cast<int>(m.rows()), static_cast<int>(m.cols()));
  for (int i = 0; i < out.rows; ++i)
    for (int j = 0; j < out.columns; ++j) out(i, j) = m(i, j);
  return out;
}

}  // namespace

Equations::Equations(const Simulation& run) : insides_(std::make_shared<Insides>(run)) {}

const SystemModel& Equations::system() const { return *insides_->plan.system; }
const std::string& Equations::name() const { return system().name; }
const std::vector<std::string>& Equations::columns() const { return system().group.columns; }
const std::vector<std::string>& Equations::velocities() const { return system().rates; }
const Start& Equations::start() const { return insides_->plan.config.start; }

std::vector<double> Equations::rate(double t, const Start& state) const {
  const Insides& at = *insides_;
  insides_->put(state, t);
  return Insides::numbers_of(at.recorded != nullptr ? at.recorded->acceleration(at.g, at.xi, t)
                                                    : at.motion->acceleration(at.state));
}

NumberMatrix Equations::inertia(const Start& state) const {
  insides_->put(state, 0);
  return matrix_of(insides_->inertia());
}

RowsOfState Equations::rows(const Start& state, double t) const {
  Insides& at = *insides_;
  at.put(state, t);
  const int k = at.mechanics.constraint_count();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(k, at.mechanics.dim());
  Eigen::VectorXd b = Eigen::VectorXd::Zero(k), phi(at.mechanics.holonomic_rows());
  if (k > 0) at.mechanics.constraints(t, at.g.data(), a, b);
  at.mechanics.holonomic(at.g.data(), phi);
  RowsOfState out{system().reactions, matrix_of(a), Insides::numbers_of(b),
                  Insides::numbers_of(phi)};
  for (auto i = static_cast<int>(out.names.size()); i < k; ++i)
    out.names.push_back(fmt::format("lambda{}", i + 1));
  return out;
}

std::vector<double> Equations::reactions(const Start& state, double t) const {
  insides_->put(state, t);
  return Insides::numbers_of(insides_->motion->at(insides_->state));
}

std::vector<double> Equations::momentum(const Start& state) const {
  insides_->put(state, 0);
  return Insides::numbers_of(insides_->inertia() * insides_->xi);
}

double Equations::energy(const Start& state) const {
  Insides& at = *insides_;
  at.put(state, 0);
  return 0.5 * at.xi.dot(at.inertia() * at.xi) + at.mechanics.potential(at.g.data());
}

const std::vector<std::string>& Equations::notations() {
  static const std::vector<std::string> names = {"latex", "c", "numpy", "sympy"};
  return names;
}

// The formulas near the last state, inputs among their variables. Throws std::domain_error.
MotionFormulas Equations::recorded() const {
  const SystemModel& model = system();
  Insides& at = *insides_;
  std::shared_ptr<const Mechanics> mechanics = at.plan.setup.mechanics;
  if (model.drive && at.plan.setup.inputs == nullptr) {
    const InputTable zero{{}, {0}};
    mechanics = model.drive(
        std::make_shared<Inputs>(model.inputs, std::vector<InputTable>(model.inputs.size(), zero)));
  }
  return record_motion(model, *mechanics, *at.plan.geometry, Insides::numbers_of(at.g),
                       at.state.velocity);
}

std::string Equations::formulas(const std::string& notation) const {
  const auto known = std::ranges::find(notations(), notation);
  if (known == notations().end())
    throw ConfigError({unknown_name("equations", notation, notations())});
  const SystemModel& model = system();
  std::vector<std::string> parameters;
  for (const Field& field : model.fields)
    if (!field.value.empty())
      parameters.push_back(fmt::format("{} = {}", field.name, fmt::join(field.value, ", ")));
  std::string title = fmt::format("{} on {}", model.name, model.group.name);
  if (!parameters.empty()) title += fmt::format(": {}", fmt::join(parameters, "; "));
  insides_->put({}, 0);
  try {
    return equations_text(recorded(), std::filesystem::path(model.name).stem().string(), title,
                          static_cast<graph::Notation>(known - notations().begin()));
  } catch (const std::domain_error& error) {
    throw ConfigError(
        {fmt::format("equations: {} has no formulas to write: {}", model.name, error.what())});
  }
}

const std::vector<std::string>& Equations::quantities() {
  static const std::vector<std::string> names = {"rate", "momentum", "reactions", "energy"};
  return names;
}

std::vector<std::string> Equations::arguments() const {
  std::vector<std::string> out = {"velocity", "configuration", "time"};
  for (const Field& field : system().fields) out.push_back(field.name);
  for (const InputField& input : system().inputs) out.push_back(input.name);
  return out;
}

std::vector<double> Equations::quantity_at(const std::string& quantity, const Start& state,
                                           double t) const {
  if (quantity == "rate") return rate(t, state);
  if (quantity == "momentum") return momentum(state);
  if (quantity == "reactions") return reactions(state, t);
  return {energy(state)};
}

}  // namespace hamel
