// Start of a run on its constraints: inertia and rows there, and the projection onto them.
#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/framework/run/run/plan/plan.hpp>
#include <hamel/framework/run/run/plan/start_contacts.hpp>
#include <hamel/framework/schemes/dynamic_problem.hpp>

namespace hamel {
namespace {

// "omega1 = 0.5, omega3 = -2": what is above the round-off of the largest.
std::string by_names(const SystemModel& system, const Eigen::VectorXd& values) {
  const std::vector<Component> components = components_of(system);
  const double unknown = 1e-13 * values.lpNorm<Eigen::Infinity>();
  std::string out;
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (std::abs(values[i]) > unknown)
      out += fmt::format("{}{} = {:.6g}", out.empty() ? "" : ", ",
                         components[static_cast<size_t>(i)].name, values[i]);
  return out;
}

// An inertia that depends on g may be symmetric at the start only.
void check_symmetry_beside(const Mechanics& mechanics, const Geometry& geometry,
                           const Eigen::VectorXd& g, Mistakes& mistakes) {
  const Eigen::Index n = mechanics.dim();
  Eigen::VectorXd shift(n), there(g.size());
  Eigen::MatrixXd beside(n, n);
  for (int place = 1; place <= 2; ++place) {
    for (Eigen::Index i = 0; i < n; ++i)
      shift[i] = 0.2 * std::sin(static_cast<double>(3 * i + 2 * place));
    geometry.tau(shift.data(), there.data());
    geometry.compose(g.data(), there.data(), there.data());
    mechanics.inertia(there.data(), beside);
    if (!beside.allFinite()) continue;
    Eigen::Index row = 0, column = 0;
    const double most = (beside - beside.transpose()).cwiseAbs().maxCoeff(&row, &column);
    if (most < 1e-10 * beside.norm()) continue;
    return mistakes.add(
        fmt::format("inertia: symmetric at the start, but not beside it: entries ({}, {}) "
                    "and ({}, {}) differ by {:.3g}",
                    row + 1, column + 1, column + 1, row + 1, most));
  }
}

// Onto phi(g) = 0 by Newton's method, g <- g tau(-I^-1 A^T (A I^-1 A^T)^-1 phi), A the rows of phi:
// the start may be the last state of a run whose scheme keeps phi only to its order.
void satisfy(const Mechanics& mechanics, const Geometry& geometry, double t, Eigen::VectorXd phi,
             Eigen::VectorXd& g, PlannedStart& planned, Mistakes& mistakes) {
  constexpr double most = 0.01;
  const Eigen::Index held = phi.size();
  const double off = phi.lpNorm<Eigen::Infinity>();
  for (int k = 0; k < 10 && off <= most && !(phi.lpNorm<Eigen::Infinity>() < 1e-15); ++k) {
    const Eigen::MatrixXd a = planned.constraints.bottomRows(held);
    const Eigen::MatrixXd reach = dense::solve_symmetric(planned.inertia, a.transpose());
    const Eigen::VectorXd move = -reach * dense::solve_symmetric(a * reach, phi);
    Eigen::VectorXd turn(g.size());
    geometry.tau(move.data(), turn.data());
    geometry.compose(g.data(), turn.data(), g.data());
    mechanics.inertia(g.data(), planned.inertia);
    mechanics.constraints(t, g.data(), planned.constraints, planned.drift);
    mechanics.holonomic(g.data(), phi);
  }
  if (!(phi.lpNorm<Eigen::Infinity>() < 1e-12)) {
    mistakes.add(
        fmt::format("configuration: {} does not satisfy the holonomic constraint, phi = {:.3g}",
                    join(planned.start.configuration), off));
    return;
  }
  geometry.coordinates(g.data(), planned.start.configuration.data());
  if (off > 1e-9) {
    planned.notes.push_back(fmt::format(
        "the start's configuration was moved onto the holonomic constraint: phi was {:.3g}", off));
  }
}

}  // namespace

// I, A and b where the run starts, checked.
void evaluate_start(const SystemModel& system, const std::shared_ptr<const Inputs>& inputs,
                    const Geometry* geometry, const Config& config, PlannedStart& planned,
                    Mistakes& mistakes) {
  const double t = config.from;
  const int n = system.group.dim;
  const Mechanics& mechanics = *system.mechanics;
  const Start& start = planned.start;
  planned.inertia = Eigen::MatrixXd::Identity(n, n);
  planned.constraints.resize(0, n);
  Eigen::VectorXd g;
  if (geometry != nullptr) {
    g.resize(geometry->size());
    geometry->from_coordinates(start.configuration, g.data());
  } else if (!mechanics.left_invariant()) {
    return;
  }
  bool said = false;
  if (system.start_mistakes && geometry != nullptr) {
    std::vector<double> xi = start.velocity;
    if (xi.size() != static_cast<size_t>(n)) xi.assign(static_cast<size_t>(n), 0);
    const auto wrong = system.start_mistakes(t, g.data(), xi, inputs);
    said = !wrong.empty();
    mistakes.add(wrong);
  }
  planned.constraints.resize(mechanics.constraint_count(), mechanics.dim());
  planned.inertia.resize(mechanics.dim(), mechanics.dim());
  planned.drift.resize(mechanics.constraint_count());
  mechanics.inertia(g.data(), planned.inertia);
  mechanics.constraints(t, g.data(), planned.constraints, planned.drift);
  Eigen::VectorXd phi(mechanics.holonomic_rows());
  mechanics.holonomic(g.data(), phi);
  const bool open = !planned.refused && look_at_gaps(system, phi, mistakes);
  if (!planned.refused && !open && phi.size() > 0 && !(phi.lpNorm<Eigen::Infinity>() < 1e-13))
    satisfy(mechanics, *geometry, t, phi, g, planned, mistakes);
  if (said) return;
  if (!planned.refused && !system.contact_laws.empty())
    release_rows(system, phi, config.slip, planned);
  if (planned.refused) planned.constraints.resize(0, n);
  // Where all rows leave no motion, a contact that slides does.
  const bool moves = mechanics.has_drift() || !system.contact_laws.empty();
  const std::vector<std::string> wrong =
      check_system_matrices(planned.inertia, planned.constraints, n, moves);
  mistakes.add(wrong);
  if (wrong.empty() && !mechanics.constant_inertia())
    check_symmetry_beside(mechanics, *geometry, g, mistakes);
}

// The admissible start, E^T I xi = E^T mu, and what the projection dropped.
void project_start(const SystemModel& system, PlannedStart& planned) {
  Start& start = planned.start;
  const auto& [inertia, constraints, drift] =
      std::tie(planned.inertia, planned.constraints, planned.drift);
  const Eigen::Index n = inertia.rows();
  if (planned.frame.size() == 0) planned.frame = hamel_frame(inertia, constraints);
  const Eigen::MatrixXd& frame = planned.frame;
  const bool by_velocity = !start.velocity.empty();
  const auto& given = by_velocity ? start.velocity : start.momentum;
  const Eigen::VectorXd datum = Eigen::Map<const Eigen::VectorXd>(given.data(), n);
  const Eigen::VectorXd mu = by_velocity ? Eigen::VectorXd(inertia * datum) : datum;
  const Eigen::VectorXd mu_bar = frame.transpose() * mu;
  Eigen::VectorXd velocity = frame * mu_bar;
  if (!drift.isZero(0)) {  // E y + xi_b with A xi_b = b and E^T I xi_b = 0
    const Eigen::VectorXd some =
        constraints.transpose() *
        dense::solve_symmetric(constraints * constraints.transpose(), drift);
    velocity += some - frame * (frame.transpose() * (inertia * some));
  }
  Eigen::VectorXd dropped = datum - (by_velocity ? velocity : Eigen::VectorXd(inertia * velocity));
  for (Eigen::Index i = 0; i < n; ++i)  // a velocity without inertia is no datum, but follows
    if (inertia.row(i).isZero(0)) dropped[i] = 0;
  if (dropped.norm() > 1e-10 * datum.norm()) {  // not round-off, which is 4e-12 with 60 trailers
    planned.notes.push_back(fmt::format("the start's {} was projected onto {}: dropped {}",
                                        by_velocity ? "velocity" : "momentum",
                                        by_velocity ? "d" : "d*", by_names(system, dropped)));
  }
  start.velocity = {velocity.begin(), velocity.end()};
  start.momentum.clear();
}

}  // namespace hamel
