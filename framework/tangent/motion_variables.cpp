#include <hamel/framework/tangent/motion_variables.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/tangent/step_map.hpp>

namespace hamel {
namespace {

using Kind = MotionVariable::Kind;

// The first columns of matrices of rotation: their entries are not free.
std::vector<size_t> entries_of_rotations(const GroupInfo& group) {
  std::vector<size_t> out;
  const std::vector<std::string> units = units_of_element(group);
  for (size_t i = 0; i < units.size(); ++i)
    if (units[i].empty()) out.push_back(i);
  return out;
}

// Names and their variables.
class VariableResolver {
 public:
  VariableResolver(const std::string& what, const Simulation& simulation, const Run& run)
      : what_(what), config_(simulation.config()), run_(run), system_(run.system()) {
    add_fields();
    add_start();
  }
  std::string resolve(const std::string& name, MotionVariable& out) const {
    std::string known_as = name;
    if (name.starts_with("start.")) {
      const QuantityNames names(system_);
      if (const auto place = names.find(name.substr(6))) known_as = "start." + names.all()[*place];
    }
    for (const MotionVariable& one : known_) {
      if (one.name != known_as) continue;
      out = one;
      if (one.kind != Kind::coordinate) return "";
      const std::vector<size_t> bound = entries_of_rotations(system_.group);
      return std::ranges::find(bound, one.index) == bound.end()
                 ? ""
                 : fmt::format("{}: {}: an entry of a matrix is not free", what_, name);
    }
    std::vector<std::string> names;
    for (const MotionVariable& one : known_) names.push_back(one.name);
    return fmt::format("{}: {}", what_, unknown_name("name", name, names));
  }

 private:
  void add_fields() {
    for (const Field& field : system_.fields) {
      for (size_t i = 0; i < field.value.size(); ++i) {
        const std::string name =
            field.value.size() == 1 ? field.name : fmt::format("{}{}", field.name, i + 1);
        const bool matrix = field.range.moments && field.value.size() > 3;
        known_.push_back({Kind::parameter, name, field.name, field.unit, i, field.value[i],
                          matrix ? Range{} : field.range});
      }
    }
    for (size_t i = 0; i < system_.inputs.size(); ++i) {
      const InputField& input = system_.inputs[i];
      const auto& inputs = run_.driver().plan().setup.inputs;
      if (inputs != nullptr && inputs->tables()[i].times.size() > 1) continue;
      const double now =
          inputs == nullptr ? 0 : inputs->at(config_.from)[static_cast<Eigen::Index>(i)];
      known_.push_back({Kind::input, input.name, input.name, input.unit, 0, now, input.range});
    }
  }
  void add_start() {
    const Start& start = run_.config().start;
    std::vector<std::string> units = units_of_element(system_.group);
    units.resize(system_.group.columns.size());
    for (size_t i = 0; i < units.size(); ++i)
      known_.push_back({Kind::coordinate, "start." + system_.group.columns[i], "", units[i], i,
                        start.configuration[i]});
    const std::vector<Component> components = components_of(system_);
    for (size_t i = 0; i < components.size(); ++i)
      known_.push_back({Kind::velocity, "start." + components[i].name, "", components[i].unit, i,
                        start.velocity[i]});
  }

  const std::string& what_;
  const Config& config_;
  const Run& run_;
  const SystemModel& system_;
  std::vector<MotionVariable> known_;
};

}  // namespace

MotionVariables::MotionVariables(const std::string& what, const Simulation& simulation,
                                 const std::vector<std::string>& names)
    : simulation_(simulation) {
  const Run run = simulation.build();
  const VariableResolver resolver(what, simulation, run);
  std::vector<std::string> mistakes;
  for (const std::string& name : names) {
    MotionVariable one;
    const std::string wrong = resolver.resolve(name, one);
    const bool twice = wrong.empty() && std::ranges::any_of(all_, [&](const MotionVariable& v) {
                         return v.name == one.name;
                       });
    if (!wrong.empty()) mistakes.push_back(wrong);
    else if (twice) mistakes.push_back(fmt::format("{}: {} is given twice", what, name));
    else all_.push_back(one);
    moves_start_ = moves_start_ || !one.of_system();
    for (const Field& field : run.system().fields)
      if (field.name == one.field) entries_[field.name] = field.value;
  }
  if (!mistakes.empty()) throw ConfigError(mistakes);
}

Eigen::VectorXd MotionVariables::values() const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(all_.size()));
  for (size_t i = 0; i < all_.size(); ++i) out[static_cast<Eigen::Index>(i)] = all_[i].value;
  return out;
}

MotionVariables MotionVariables::from(double t, const Start& start,
                                      const Eigen::MatrixXd& directions) const {
  MotionVariables out = *this;
  Config config = simulation_.config();
  config.from = t;
  config.start = start;
  config.speed.reset();
  config.start_values.clear();
  out.simulation_.config(std::move(config));
  std::erase_if(out.all_, [](const MotionVariable& one) { return !one.of_system(); });
  for (Eigen::Index i = 0; i < directions.cols(); ++i)
    out.all_.push_back(
        {Kind::direction, fmt::format("direction {}", i + 1), "", "", static_cast<size_t>(i), 0});
  out.directions_ = directions;
  out.moves_start_ = directions.cols() > 0;
  return out;
}

Simulation MotionVariables::with(const Eigen::VectorXd& values) const {
  Simulation out = simulation_;
  std::map<std::string, std::vector<double>> fields;
  for (size_t i = 0; i < all_.size(); ++i) {
    const MotionVariable& one = all_[i];
    const double value = values[static_cast<Eigen::Index>(i)];
    if (one.kind == Kind::input) out.input(one.field, value);
    if (one.kind != Kind::parameter) continue;
    std::vector<double>& entries = fields[one.field];
    if (entries.empty()) entries = entries_.at(one.field);
    entries[one.index] = value;
  }
  for (const auto& [name, entries] : fields) out.set(name, entries);
  return out;
}

namespace {

// From all xi with A xi = b and the given components that which is nearest to the start's:
//   xi = xi0 + I^-1 C^T (C I^-1 C^T)^+ (d - C xi0),  C = (A; e_j), d = (b; values),
// rows of length 1 in I^-1, so that what is left of them is the root of an energy.
void give_velocity(const RunPlan& plan, const std::vector<std::pair<size_t, double>>& given,
                   Start& start) {
  const Mechanics& mechanics = *plan.setup.mechanics;
  const Eigen::Index n = mechanics.dim(), k = mechanics.constraint_count(),
                     c = static_cast<Eigen::Index>(given.size());
  Eigen::VectorXd g(plan.geometry->size()), b = Eigen::VectorXd::Zero(k);
  plan.geometry->from_coordinates(start.configuration, g.data());
  Eigen::MatrixXd inertia(n, n), rows = Eigen::MatrixXd::Zero(k, n);
  mechanics.inertia(g.data(), inertia);
  if (k > 0) mechanics.constraints(plan.config.from, g.data(), rows, b);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(k + c, n);
  Eigen::VectorXd right(k + c);
  all.topRows(k) = rows;
  right.head(k) = b;
  for (Eigen::Index j = 0; j < c; ++j) {
    const auto& [component, value] = given[static_cast<size_t>(j)];
    all(k + j, static_cast<Eigen::Index>(component)) = 1;
    right[k + j] = value;
  }
  Eigen::Map<Eigen::VectorXd> xi(start.velocity.data(), n);
  const Eigen::LLT<Eigen::MatrixXd> factors = inertia.llt();
  for (Eigen::Index j = 0; j < k + c; ++j) {
    const Eigen::VectorXd row = all.row(j).transpose();
    const double length = std::sqrt(row.dot(factors.solve(row)));
    if (!(length > 0)) continue;
    all.row(j) /= length;
    right[j] /= length;
  }
  const double size = std::sqrt(xi.dot(inertia * xi)) + right.lpNorm<Eigen::Infinity>();
  right -= all * xi;
  const Eigen::MatrixXd reach = factors.solve(all.transpose());
  const Eigen::VectorXd move = reach * (all * reach).completeOrthogonalDecomposition().solve(right);
  if (!((all * move - right).lpNorm<Eigen::Infinity>() <= 1e-9 * size))
    throw ConfigError({fmt::format(
        "start: the constraint rows of {} leave no choice of these components of the velocity",
        plan.system->name)});
  xi += move;
}

// g tau(eta), xi + dxi.
void displace_start(const RunPlan& plan, const Eigen::VectorXd& by, Start& start) {
  const Geometry& geometry = *plan.geometry;
  MotionState state, moved;
  state.g.resize(geometry.size());
  geometry.from_coordinates(start.configuration, state.g.data());
  state.xi = Eigen::Map<const Eigen::VectorXd>(start.velocity.data(), geometry.dim());
  displace(geometry, state, by, 1, moved);
  geometry.coordinates(moved.g.data(), start.configuration.data());
  start.velocity.assign(moved.xi.begin(), moved.xi.end());
}

}  // namespace

Start MotionVariables::start_of(Run& run, const Eigen::VectorXd& values) const {
  if (!moves_start_) return run.config().start;
  const Start usual = run.config().start;
  Start out = usual;
  std::vector<std::pair<size_t, double>> given;
  bool placed = false;
  if (directions_.cols() > 0) {
    const Eigen::VectorXd by = directions_ * values.tail(directions_.cols());
    placed = !by.isZero(0);
    if (placed) displace_start(run.driver().plan(), by, out);
  }
  for (size_t i = 0; i < all_.size(); ++i) {
    const double value = values[static_cast<Eigen::Index>(i)];
    if (all_[i].kind == Kind::coordinate) {
      out.configuration[all_[i].index] = value;
      placed = true;
    }
    if (all_[i].kind == Kind::velocity) given.emplace_back(all_[i].index, value);
  }
  if (placed) run.restart(out);
  out = run.config().start;
  if (!given.empty()) {
    give_velocity(run.driver().plan(), given, out);
    run.restart(out);
    out = run.config().start;
  }
  run.restart(usual);
  return out;
}

}  // namespace hamel
