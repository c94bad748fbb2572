#include <hamel/framework/check/system_laws.hpp>

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/framework/run/run/simulation.hpp>
#include <hamel/framework/schemes/dynamic_problem.hpp>

namespace hamel {
namespace check {
namespace {

// Inputs that are zero change neither f nor b; each that is one changes f or b somewhere near the
// start.
void inputs_of_zero(const SystemModel& model, const Geometry& geometry, const Start& start,
                    LawReport& report) {
  Eigen::VectorXd g(geometry.size());
  geometry.from_coordinates(start.configuration, g.data());
  const Eigen::VectorXd xi = Eigen::Map<const Eigen::VectorXd>(
      start.velocity.data(), static_cast<Eigen::Index>(start.velocity.size()));
  // F and b, one below the other.
  const auto acting = [&](const Mechanics& mechanics) {
    const Eigen::Index n = mechanics.dim(), k = mechanics.constraint_count();
    Eigen::VectorXd force(n), b(k), out(n + k);
    Eigen::MatrixXd a(k, n);
    mechanics.force(0.3, g.data(), xi, force);
    mechanics.constraints(0.3, g.data(), a, b);
    out << force, b;
    return out;
  };
  std::vector<InputTable> tables(model.inputs.size(), {{}, {0}});
  const auto driven = [&] {
    return acting(*model.drive(std::make_shared<Inputs>(model.inputs, tables)));
  };
  const Eigen::VectorXd zero = driven();
  report.push_back(
      {"inputs of zero add nothing", (zero - acting(*model.mechanics)).norm(), algebraic});
  std::string idle;
  for (size_t i = 0; i < tables.size(); ++i) {
    tables[i].values = {1};
    if ((driven() - zero).norm() == 0) idle += " " + model.inputs[i].name;
    tables[i].values = {0};
  }
  report.push_back({"every input acts", idle.empty() ? 0.0 : 1.0, 0,
                    idle.empty() ? "" : "no force and no row change with" + idle});
}

// The start, and four configurations near it.
void place_near(const Geometry& geometry, const Start& start, int i, Eigen::VectorXd& g) {
  Eigen::VectorXd shift(geometry.dim());
  for (Eigen::Index j = 0; j < shift.size(); ++j)
    shift[j] = i * std::sin(1.0 + i + 2.0 * double(j)) / 5;
  Eigen::VectorXd moved(g);
  geometry.from_coordinates(start.configuration, g.data());
  geometry.tau(shift.data(), moved.data());
  geometry.compose(g.data(), moved.data(), g.data());
}

// Checks that what a system states without I and A is theirs.
void without_matrices(const SystemModel& model, const Geometry& geometry, const Start& start,
                      LawReport& report) {
  const Mechanics& mechanics = *model.mechanics;
  const Eigen::Index n = mechanics.dim(), k = mechanics.constraint_count();
  Eigen::VectorXd g(geometry.size()), momentum(n), force(n), same(n), b(k), rows(k);
  Eigen::MatrixXd inertia(n, n), a(k, n);
  const Eigen::VectorXd xi = Eigen::VectorXd::LinSpaced(n, 0.7, -1.2);
  Largest momenta, forces, values;
  for (int i = 0; i < 5; ++i) {
    place_near(geometry, start, i, g);
    mechanics.momentum(g.data(), xi, momentum, force);
    mechanics.inertia(g.data(), inertia);
    mechanics.inertial_force(g.data(), xi, same);
    momenta((momentum - inertia * xi).norm() / (inertia.norm() * xi.norm()));
    forces((force - same).norm() / (inertia.norm() * xi.squaredNorm()));
    if (k == 0) continue;
    mechanics.constraint_values(0.3, g.data(), xi, rows);
    mechanics.constraints(0.3, g.data(), a, b);
    values((rows - a * xi + b).norm() / (a.norm() * xi.norm()));
  }
  report.push_back({"the momentum is I xi", momenta.value, algebraic});
  report.push_back({"the inertial force is the same beside it", forces.value, algebraic});
  if (k > 0) report.push_back({"the values of the rows are A xi - b", values.value, algebraic});
}

// Checks that the rates that a system computes along a motion are those of its I and A, found by
// differences.
void rates_along(const SystemModel& model, const Geometry& geometry, const Start& start,
                 LawReport& report) {
  const Mechanics& mechanics = *model.mechanics;
  const Eigen::Index n = mechanics.dim(), k = mechanics.constraint_count();
  const DynamicProblem problem({std::shared_ptr<const void>(), &geometry}, model.mechanics);
  Eigen::VectorXd g(geometry.size()), moved(g), step(n), rows(k), change(n), other(n), b(k);
  Eigen::MatrixXd inertia(n, n), a(k, n);
  const Eigen::VectorXd xi = Eigen::VectorXd::LinSpaced(n, 0.7, -1.2);
  Largest wrong_rows, wrong_momentum;
  for (int i = 0; i < 5; ++i) {
    place_near(geometry, start, i, g);
    if (!mechanics.autonomous() || !mechanics.exact_rates()) return;
    mechanics.inertia(g.data(), inertia);
    mechanics.constraints(0, g.data(), a, b);
    mechanics.motion(geometry, 0, g.data(), xi, inertia, a, b, rows, change);
    const Eigen::VectorXd mu = inertia * xi;
    geometry.ad_transpose(xi.data(), mu.data(), other.data());
    Eigen::VectorXd momentum = other - change;  // (dI/dt) xi
    mechanics.force(0, g.data(), xi, other);
    momentum += other;
    const double row_size = a.norm() * xi.squaredNorm() + b.norm() * xi.norm();
    Eigen::VectorXd by_rows = Eigen::VectorXd::Zero(k), by_inertia = Eigen::VectorXd::Zero(n);
    differentiate_along(problem, g, xi, step, moved, [&](double, double weight) {
      mechanics.constraints(0, moved.data(), a, b);
      mechanics.inertia(moved.data(), inertia);
      by_rows += weight * (b - a * xi);
      by_inertia += weight * (inertia * xi);
    });
    if (k > 0) wrong_rows((rows - by_rows).norm() / row_size);
    wrong_momentum((momentum - by_inertia).norm() / (inertia.norm() * xi.squaredNorm()));
  }
  if (k > 0) report.push_back({"the rates of the rows are theirs", wrong_rows.value, 1e-9});
  report.push_back({"the rate of the inertia is its own", wrong_momentum.value, 1e-9});
}

// Checks that the accelerations that a system has at once are those of its parts.
void accelerations(const SystemModel& model, const Geometry& geometry, const Start& start,
                   LawReport& report) {
  const Mechanics& mechanics = *model.mechanics;
  if (!mechanics.has_accelerations()) return;
  const Eigen::Index n = mechanics.dim();
  const DynamicProblem problem({std::shared_ptr<const void>(), &geometry}, model.mechanics);
  EquationsOfMotion<DynamicProblem> motion(problem);
  Eigen::VectorXd g(geometry.size()), found(n);
  Largest wrong;
  for (int i = 0; i < 5; ++i) {
    place_near(geometry, start, i, g);
    Eigen::VectorXd xi(n);
    for (Eigen::Index j = 0; j < n; ++j) xi[j] = std::sin(1.7 * static_cast<double>(j + i) + 0.3);
    motion.solve(0.3, g, xi);
    mechanics.accelerations(0.3, g.data(), xi, found);
    wrong((found - motion.acceleration()).norm() /
          (motion.acceleration().norm() + xi.squaredNorm()));
  }
  report.push_back({"the accelerations are those of I, A and the forces", wrong.value, 1e-10});
}

// The frame that a system states: A E = 0, and the rates of y are those of the equations with
// multipliers.
void frame(const SystemModel& model, const Geometry& geometry, const Start& start,
           LawReport& report) {
  const Mechanics& mechanics = *model.mechanics;
  const Eigen::Index n = mechanics.dim(), m = mechanics.framed_size();
  const DynamicProblem problem({std::shared_ptr<const void>(), &geometry}, model.mechanics);
  EquationsOfMotion<DynamicProblem> motion(problem);
  Eigen::VectorXd g(geometry.size()), xi(n), rate(n);
  Largest rows, rates;
  for (int i = 0; i < 5; ++i) {
    place_near(geometry, start, i, g);
    Eigen::MatrixXd a(n - m, n);
    Eigen::VectorXd b(n - m);
    mechanics.constraints(0, g.data(), a, b);
    for (Eigen::Index j = 0; j < m; ++j) {
      mechanics.expand(g.data(), Eigen::VectorXd::Unit(n, j), xi);
      rows((a * xi).norm() / (a.norm() * xi.norm()));
      rows(xi.head(m) == Eigen::VectorXd::Unit(m, j) ? 0 : 1);
    }
    const Eigen::VectorXd y = Eigen::VectorXd::LinSpaced(n, 0.7, -1.2);
    mechanics.framed_motion(0, g.data(), y, xi, rate);
    motion.solve(0, g, xi);
    rates((rate - motion.acceleration()).norm() / (1 + rate.norm()));
  }
  report.push_back({"the frame spans ker A", rows.value, algebraic});
  report.push_back({"rates in the frame are those with multipliers", rates.value, 1e-10});
}

}  // namespace
}  // namespace check

LawReport check_system(const SystemModel& model, double until, const Geometry* geometry) {
  LawReport report;
  const auto initial = check::matrices_at(
      model, geometry,
      model.start.configuration.empty() ? model.group.identity : model.start.configuration);
  const Eigen::MatrixXd& inertia = initial.inertia;
  const Eigen::MatrixXd& rows = initial.rows;
  report.push_back({"inertia symmetric", (inertia - inertia.transpose()).norm() / inertia.norm(),
                    check::algebraic});
  const Eigen::VectorXd values = dense::symmetric_eigenvalues(inertia);
  report.push_back(
      {"inertia positive definite", values.minCoeff() > 1e-14 * values.maxCoeff() ? 0.0 : 1.0, 0,
       fmt::format("eigenvalues from {:.3g} to {:.3g}", values.minCoeff(), values.maxCoeff())});
  if (rows.rows() > 0) {
    const Eigen::VectorXd singular = dense::svd(rows).values;
    report.push_back({"constraint rows independent",
                      singular.minCoeff() > 1e-12 * singular.maxCoeff() ? 0.0 : 1.0, 0,
                      fmt::format("singular values from {:.3g} to {:.3g}", singular.minCoeff(),
                                  singular.maxCoeff())});
  }
  const Start start = check::admissible_start(model, geometry);
  if (start.velocity.empty()) return report;
  const auto& given = model.start.velocity;
  if (!given.empty()) {
    double size = 1;  // of the velocities, where they are large
    for (const double x : given) size = std::max(size, std::abs(x));
    report.push_back({"the default start is admissible",
                      check::difference(given, start.velocity) / size, check::algebraic});
  }
  report.push_back(
      {"the default configuration is an element",
       check::difference(model.group.element(start.configuration), start.configuration),
       check::algebraic});
  if (model.drive && geometry != nullptr) check::inputs_of_zero(model, *geometry, start, report);
  if (geometry != nullptr) check::without_matrices(model, *geometry, start, report);
  if (geometry != nullptr) check::rates_along(model, *geometry, start, report);
  if (geometry != nullptr) check::accelerations(model, *geometry, start, report);
  if (model.mechanics->framed_size() > 0 && geometry != nullptr)
    check::frame(model, *geometry, start, report);
  if (!model.exact) return report;

  for (const double sign : {1.0, -1.0}) {
    const std::string direction = sign > 0 ? "forwards" : "backwards";
    const ExactFlow flow = model.exact(start);
    const auto [g0, xi0] = flow(0);
    report.push_back(
        {"exact motion starts at the start, " + direction,
         check::difference(g0, start.configuration) + check::difference(xi0, start.velocity),
         check::algebraic});
    check::Largest residual, element;
    std::vector<check::Largest> drift(model.invariants.size());
    for (int i = 1; i <= 50; ++i) {
      const auto [g, xi] = flow(sign * until * i / 50);
      const Eigen::VectorXd velocity =
          Eigen::Map<const Eigen::VectorXd>(xi.data(), static_cast<Eigen::Index>(xi.size()));
      if (rows.rows() > 0) {
        const auto here = check::matrices_at(model, geometry, g, sign * until * i / 50);
        residual((here.rows * velocity - here.drift).norm() / (1 + velocity.norm()));
      }
      element(check::difference(model.group.element(g), g));
      for (size_t j = 0; j < drift.size(); ++j) {
        const double at_start = model.invariants[j].value(start.configuration, start.velocity);
        drift[j](std::abs(model.invariants[j].value(g, xi) - at_start) / (1 + std::abs(at_start)));
      }
    }
    report.push_back(
        {"A xi = b along the exact motion, " + direction, residual.value, check::algebraic});
    report.push_back(
        {"the exact motion stays in the group, " + direction, element.value, check::algebraic});
    for (size_t j = 0; j < drift.size(); ++j) {
      report.push_back({"exact motion keeps '" + model.invariants[j].name + "', " + direction,
                        drift[j].value, check::algebraic});
    }
  }
  return report;
}

LawReport check_system(const Registry& registry, const std::string& name, double until) {
  const SystemInfo* info = registry.system(name);
  if (info == nullptr)
    throw ConfigError({unknown_name("system", name, registry.systems_and_files())});
  SystemModel model = info->make({});
  registry.complete(model);
  const std::string retraction = registry.retractions_or_common(model.group.name).front();
  const auto geometry = registry.geometry(model.group.name, retraction);
  LawReport report = check_system(model, until, geometry.get());

  // Parameters: what describe shows is what a run gets, and a parameter that is set comes back.
  Parameters as_shown, changed;
  for (const Field& field : info->fields) {
    as_shown[field.name] = field.value;
    changed[field.name] = check::changed_value(*info, field);
  }
  const SystemModel again = info->make(as_shown), other = info->make(changed);
  const auto& g =
      model.start.configuration.empty() ? model.group.identity : model.start.configuration;
  const auto before = check::matrices_at(model, geometry.get(), g),
             after = check::matrices_at(again, geometry.get(), g);
  double lost = (after.inertia - before.inertia).norm() + (after.rows - before.rows).norm() +
                (after.drift - before.drift).norm();
  for (const Field& field : other.fields) {
    lost += check::difference(field.value, changed[field.name]);
  }
  report.push_back({"fields round trip", lost, 0});
  double accepted = 0;
  try {
    info->make({{"no_such_parameter", {1.0}}});
    accepted = 1;
  } catch (const ConfigError&) {
  }
  report.push_back({"an unknown parameter is refused", accepted, 0});

  if (model.exact) {
    Simulation run(registry, name);
    const Result result = run.scheme("lift")
                              .s(0.5)
                              .retraction("exp")
                              .compose("suzuki_umeno8")
                              .step(0.01)
                              .until(until)
                              .every(1000000)
                              .run();
    report.push_back({"exact motion against lift composed to order 8",
                      result.status.ok ? result.exact_error_final + result.exact_velocity_error_max
                                       : std::numeric_limits<double>::quiet_NaN(),
                      1e-9});
  }
  return report;
}

}  // namespace hamel
