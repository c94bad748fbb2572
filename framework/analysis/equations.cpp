#include <hamel/framework/analysis/equations.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <hamel/framework/analysis/central_differences.hpp>
#include <hamel/framework/analysis/equations_text.hpp>
#include <hamel/framework/analysis/recorded_jacobian.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/natural_units.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/run/run/reactions.hpp>

namespace hamel {
namespace {

std::vector<double> numbers_of(const Eigen::VectorXd& x) { return {x.data(), x.data() + x.size()}; }

NumberMatrix matrix_of(const Eigen::MatrixXd& m) {
  NumberMatrix out(static_cast<int>(m.rows()), static_cast<int>(m.cols()));
  for (int i = 0; i < out.rows; ++i)
    for (int j = 0; j < out.columns; ++j) out(i, j) = m(i, j);
  return out;
}

void check_numbers(const char* name, const std::vector<double>& got, int expected,
                   std::vector<std::string>& mistakes) {
  if (static_cast<int>(got.size()) != expected)
    mistakes.push_back(fmt::format("{}: got {} numbers, expected {}", name, got.size(), expected));
  else if (!std::ranges::all_of(got, [](double x) { return std::isfinite(x); }))
    mistakes.push_back(fmt::format("{}: expected finite numbers", name));
}

constexpr double kEpsilonOfEquations = std::numeric_limits<double>::epsilon();

}  // namespace

// At the last state.
struct Equations::Insides {
  Simulation simulation;
  Run run;
  const RunPlan& plan;
  const Mechanics& mechanics;
  std::unique_ptr<Reactions> motion;  // of systems with rows or without
  Eigen::VectorXd g, xi;
  Snapshot state;

  explicit Insides(const Simulation& of)
      : simulation(of),
        run(of.build()),
        plan(run.driver().plan()),
        mechanics(*plan.setup.mechanics) {
    if (plan.geometry == nullptr)
      throw ConfigError({fmt::format(
          "equations: the group of {} is not registered: its equations are its own types'",
          plan.system->name)});
    motion = std::make_unique<Reactions>(plan.geometry, plan.setup.mechanics, plan.setup.inputs,
                                         plan.contacts);
    g.setZero(plan.geometry->size());
    xi.setZero(mechanics.dim());
  }

  Eigen::MatrixXd inertia() const {
    Eigen::MatrixXd out(mechanics.dim(), mechanics.dim());
    mechanics.inertia(g.data(), out);
    return out;
  }

  // The coordinates of g tau(eta).
  std::vector<double> moved(const Eigen::VectorXd& from, const Eigen::VectorXd& eta) const {
    Eigen::VectorXd there(from.size());
    plan.geometry->tau(eta.data(), there.data());
    plan.geometry->compose(from.data(), there.data(), there.data());
    std::vector<double> out(static_cast<size_t>(plan.geometry->columns()));
    plan.geometry->coordinates(there.data(), out.data());
    return out;
  }

  void put(const Start& given, double t) {
    const Start& usual = plan.config.start;
    const bool by_momentum = !given.momentum.empty();
    std::vector<std::string> mistakes;
    state.time = t;
    state.element.clear();
    state.coordinates = given.configuration.empty() ? usual.configuration : given.configuration;
    state.velocity = given.velocity.empty() ? usual.velocity : given.velocity;
    if (!std::isfinite(t)) mistakes.push_back(fmt::format("t: got {}, expected a finite time", t));
    if (by_momentum && !given.velocity.empty())
      mistakes.emplace_back("state: expected a velocity or a momentum, not both");
    check_numbers("configuration", state.coordinates, plan.geometry->columns(), mistakes);
    check_numbers("velocity", state.velocity, mechanics.dim(), mistakes);
    if (by_momentum) check_numbers("momentum", given.momentum, mechanics.dim(), mistakes);
    if (!mistakes.empty()) throw ConfigError(mistakes);
    try {
      plan.geometry->from_coordinates(state.coordinates, g.data());
    } catch (const std::invalid_argument& error) {
      throw ConfigError({fmt::format("configuration: {}", error.what())});
    }
    if (by_momentum) {
      const Eigen::Map<const Eigen::VectorXd> mu(given.momentum.data(), mechanics.dim());
      state.velocity = numbers_of(inertia().llt().solve(mu));
    }
    xi = Eigen::Map<const Eigen::VectorXd>(state.velocity.data(), mechanics.dim());
  }
};

Equations::Equations(const Simulation& run) : insides_(std::make_shared<Insides>(run)) {}

const SystemModel& Equations::system() const { return *insides_->plan.system; }
const std::string& Equations::name() const { return system().name; }
const std::vector<std::string>& Equations::columns() const { return system().group.columns; }
const std::vector<std::string>& Equations::velocities() const { return system().rates; }
const Start& Equations::start() const { return insides_->plan.config.start; }

std::vector<double> Equations::rate(double t, const Start& state) const {
  insides_->put(state, t);
  return numbers_of(insides_->motion->acceleration(insides_->state));
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
  RowsOfState out{system().reactions, matrix_of(a), numbers_of(b), numbers_of(phi)};
  for (auto i = static_cast<int>(out.names.size()); i < k; ++i)
    out.names.push_back(fmt::format("lambda{}", i + 1));
  return out;
}

std::vector<double> Equations::reactions(const Start& state, double t) const {
  insides_->put(state, t);
  return numbers_of(insides_->motion->at(insides_->state));
}

std::vector<double> Equations::momentum(const Start& state) const {
  insides_->put(state, 0);
  return numbers_of(insides_->inertia() * insides_->xi);
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
  return record_motion(model, *mechanics, *at.plan.geometry, numbers_of(at.g), at.state.velocity);
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

// Derivatives of the recorded rates; none where there are no formulas, or inputs that change.
std::optional<JacobianOfState> Equations::exact_jacobian(const std::string& of, const Start& at,
                                                         double t) const {
  insides_->put(at, t);
  const std::shared_ptr<Inputs>& given = insides_->plan.setup.inputs;
  std::vector<double> values = {t};
  values.insert(values.end(), at.configuration.begin(), at.configuration.end());
  values.insert(values.end(), at.velocity.begin(), at.velocity.end());
  for (size_t i = 0; i < system().inputs.size(); ++i) {
    if (given != nullptr && !given->tables()[i].times.empty()) return {};
    values.push_back(given == nullptr ? 0 : given->at(t)[static_cast<Eigen::Index>(i)]);
  }
  std::optional<RecordedJacobian> recorded_jacobian;
  try {
    recorded_jacobian.emplace(recorded(), of);
  } catch (const std::domain_error&) {
    return {};
  }
  const auto rows = static_cast<int>(at.velocity.size());
  const std::vector<double> found = (*recorded_jacobian)(values);
  const int columns = static_cast<int>(found.size()) / rows;
  const Eigen::VectorXd noise = noise_of(
      [&](double e) -> Eigen::VectorXd {
        std::vector<double> there = values;
        for (size_t i = 0; i < there.size(); ++i)
          there[i] += e * std::max(1.0, std::abs(there[i])) *
                      std::sin(12.9898 * static_cast<double>(i + 1));
        const std::vector<double> moved = (*recorded_jacobian)(there);
        return Eigen::Map<const Eigen::VectorXd>(moved.data(),
                                                 static_cast<Eigen::Index>(moved.size()));
      },
      0x1p-30);
  JacobianOfState out{NumberMatrix(rows, columns), NumberMatrix(rows, columns)};
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < rows; ++i) {
      out.values(i, j) = found[static_cast<size_t>(j * rows + i)];
      out.errors(i, j) = noise[j * rows + i];
    }
  }
  return out;
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

// The round-off of a quantity, which is that of a linear solve: along a line on which all numbers
// of the state change, in units of the system's own.
std::vector<double> Equations::round_off_of(const std::string& quantity, const Start& state,
                                            double t) const {
  insides_->put(state, t);
  const Eigen::VectorXd g = insides_->g, xi = insides_->xi;
  const std::vector<double> scales =
      natural_units(components_of(system()), insides_->mechanics, g.data());
  const Eigen::Map<const Eigen::VectorXd> units(scales.data(), xi.size());
  double rate = xi.cwiseQuotient(units).lpNorm<Eigen::Infinity>();
  if (!(rate > 0)) rate = 1;
  Eigen::VectorXd along(xi.size());
  for (Eigen::Index i = 0; i < along.size(); ++i)
    along[i] = units[i] * std::sin(12.9898 * static_cast<double>(i + 1));
  const Eigen::VectorXd noise = noise_of(
      [&](double e) -> Eigen::VectorXd {
        Start there = state;
        there.configuration = insides_->moved(g, e * along);
        there.velocity = numbers_of(xi + e * rate * along);
        const std::vector<double> values = quantity_at(quantity, there, t);
        return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                                 static_cast<Eigen::Index>(values.size()));
      },
      0x1p-30);
  return numbers_of(noise);
}

JacobianOfState Equations::jacobian(const std::string& quantity, const std::string& of,
                                    const Start& state, double t) const {
  std::vector<std::string> mistakes;
  const std::vector<std::string> known = arguments();
  if (std::ranges::count(quantities(), quantity) == 0)
    mistakes.push_back(unknown_name("quantity", quantity, quantities()));
  if (std::ranges::count(known, of) == 0) mistakes.push_back(unknown_name("of", of, known));
  if (!mistakes.empty()) throw ConfigError(mistakes);

  insides_->put(state, t);
  const Start here{insides_->state.coordinates, insides_->state.velocity, {}};
  const bool of_parameter = std::ranges::count(system().fields, of, &Field::name) > 0;
  if (quantity == "rate" && !of_parameter) {
    if (auto exact = exact_jacobian(of, here, t)) return std::move(*exact);
    insides_->put(here, t);
  }
  const Eigen::VectorXd g = insides_->g;
  const int n = insides_->mechanics.dim();
  const RunPlan& plan = insides_->plan;
  // The quantity with the j-th component of the argument moved by x.
  std::function<std::vector<double>(int j, double x)> moved;
  std::vector<double> sizes;  // of the components, whose round-off is that of the argument
  if (of == "velocity") {
    sizes = here.velocity;
    moved = [&](int j, double x) {
      Start there = here;
      there.velocity[static_cast<size_t>(j)] += x;
      return quantity_at(quantity, there, t);
    };
  } else if (of == "configuration") {
    const auto [least, most] = std::ranges::minmax(here.configuration);
    sizes.assign(static_cast<size_t>(n), std::max(std::abs(least), std::abs(most)));
    moved = [&](int j, double x) {
      Start there = here;
      there.configuration = insides_->moved(g, x * Eigen::VectorXd::Unit(n, j));
      return quantity_at(quantity, there, t);
    };
  } else if (of == "time") {
    sizes = {t};
    moved = [&](int /*j*/, double x) { return quantity_at(quantity, here, t + x); };
  } else {
    const auto field = std::ranges::find(system().fields, of, &Field::name);
    const bool parameter = field != system().fields.end();
    if (parameter) {
      sizes = field->value;
    } else {
      const auto input = std::ranges::find(system().inputs, of, &InputField::name);
      const auto i = static_cast<Eigen::Index>(input - system().inputs.begin());
      sizes = {plan.setup.inputs == nullptr ? 0 : plan.setup.inputs->at(t)[i]};
    }
    moved = [&, parameter](int j, double x) {
      std::vector<double> there = sizes;
      there[static_cast<size_t>(j)] += x;
      Simulation other = insides_->simulation;
      if (parameter) other.set(of, there);
      else other.input(of, there.front());
      return Equations(other).quantity_at(quantity, here, t);
    };
  }

  const std::vector<double> noise = round_off_of(quantity, here, t);
  const auto columns = static_cast<int>(sizes.size());
  const auto rows = static_cast<int>(quantity_at(quantity, here, t).size());
  JacobianOfState out{NumberMatrix(rows, columns), NumberMatrix(rows, columns)};
  for (int j = 0; j < columns; ++j) {
    const auto curve = [&](double x) -> Eigen::VectorXd {
      try {
        const std::vector<double> values = moved(j, x);
        return Eigen::Map<const Eigen::VectorXd>(values.data(), rows);
      } catch (const ConfigError&) {  // out of the range of the argument
        return Eigen::VectorXd::Constant(rows, std::numeric_limits<double>::quiet_NaN());
      }
    };
    StepRange steps =
        steps_of_any_scale(kEpsilonOfEquations * std::abs(sizes[static_cast<size_t>(j)]));
    steps.noise = Eigen::Map<const Eigen::VectorXd>(noise.data(), rows);
    const Derivative found = CentralDifferences(curve, steps).derivative(1);
    for (int i = 0; i < rows; ++i) {
      out.values(i, j) = found.value[i];
      out.errors(i, j) = found.error[i];
    }
  }
  return out;
}

}  // namespace hamel
