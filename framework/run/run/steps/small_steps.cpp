#include <hamel/framework/run/run/steps/small_steps.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/framework/run/run/rows/rows_watch.hpp>
#include <hamel/framework/schemes/dynamic_problem.hpp>

namespace hamel {
namespace {

// Parts of the tolerance that round-off may be of: where steps are rejected, and where they have
// shrunk to what it leaves of them, as a truncation error of the size of the tolerance has less.
constexpr double kNoise = 0.1, kNoiseOfSmall = 3e-3;

Eigen::VectorXd vector_of(const std::vector<double>& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

std::optional<std::string> dependent_rows(const SystemModel& system, const KernelSetup& setup,
                                          const Snapshot& now) {
  if (setup.mechanics->constraint_count() == 0 || !system.contact_laws.empty()) return {};
  RowsWatch rows(setup.geometry, system, setup.mechanics);
  const double condition = rows.condition(now);
  if (!(condition > RowsWatch::kNearlyDependent)) return {};
  return fmt::format("the rows are nearly dependent at t = {:.6g} (condition {:.1e}): {}", now.time,
                     condition, rows.names());
}

// The line through two states, beyond both.
class Line {
 public:
  Line(const KernelSetup& setup, const Snapshot& from, const Snapshot& to)
      : setup_(setup),
        time_{from.time, to.time},
        x_{vector_of(from.coordinates), vector_of(to.coordinates)},
        xi_{vector_of(from.velocity), vector_of(to.velocity)},
        g_(setup.geometry->size()) {}

  // f - dV at a place, 0 and 1 the two states.
  Eigen::VectorXd force(double place) {
    const Eigen::VectorXd x = at(x_, place), xi = at(xi_, place);
    setup_.geometry->from_coordinates({x.data(), static_cast<size_t>(x.size())}, g_.data());
    Eigen::VectorXd out(xi.size());
    setup_.mechanics->force(time_[0] + place * (time_[1] - time_[0]), g_.data(), xi, out);
    return out;
  }

 private:
  static Eigen::VectorXd at(const Eigen::VectorXd (&ends)[2], double place) {
    return ends[0] + place * (ends[1] - ends[0]);
  }
  const KernelSetup& setup_;
  double time_[2];
  Eigen::VectorXd x_[2], xi_[2], g_;
};

// A change of a force that stays as it is however near the two places are.
std::optional<std::string> jumping_force(const SystemModel& system, const KernelSetup& setup,
                                         const Snapshot& before, const Snapshot& now) {
  constexpr int kSides = 8, kPieces = 4, kHalvings = 40;
  Line line(setup, before, now);
  Eigen::VectorXd last = line.force(-kSides), size = last.cwiseAbs();
  double most = 0, place = 0;
  Eigen::Index component = 0;
  for (int i = 1; i <= kPieces * (2 * kSides + 1); ++i) {
    const double there = static_cast<double>(i) / kPieces - kSides;
    const Eigen::VectorXd force = line.force(there);
    size = size.cwiseMax(force.cwiseAbs());
    Eigen::Index which = 0;
    const double change = (force - last).cwiseAbs().maxCoeff(&which);
    if (change > most) {
      most = change;
      place = there;
      component = which;
    }
    last = force;
  }
  double low = place - 1.0 / kPieces, high = place;
  double below = line.force(low)[component], above = line.force(high)[component];
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = (low + high) / 2, force = line.force(middle)[component];
    if (std::abs(force - below) < std::abs(force - above)) {
      low = middle;
      below = force;
    } else {
      high = middle;
      above = force;
    }
  }
  const double jump = std::abs(above - below);
  if (!(jump > 1e-6 * size[component])) return {};
  const auto i = static_cast<size_t>(component);
  const std::string entry = setup.mechanics->dim() == 1 ? "force" : fmt::format("force[{}]", i + 1);
  std::string formula;
  for (const auto& [name, text] : system.formulas)
    if (name == entry) formula = fmt::format(", {} = {}", name, text);
  return fmt::format(
      "the force on {} jumps by {:.4g} near t = {:.6g}{}: a formula with sign, a "
      "comparison or a corner; write a smooth one, tanh(rate/small) for sign(rate)",
      components_of(system)[i].name, jump, now.time, formula);
}

// The error estimate of a step cannot be below what round-off in the place makes of xi'. usual: the
// size of earlier steps, to which these have shrunk; 0: they have not.
std::optional<std::string> below_round_off(const KernelSetup& setup, const Snapshot& now,
                                           double step, double usual = 0) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  EquationsOfMotion<DynamicProblem> motion(DynamicProblem(setup.geometry, setup.mechanics));
  Eigen::VectorXd g(setup.geometry->size()), turned(g.size());
  setup.geometry->from_coordinates(now.coordinates, g.data());
  const Eigen::VectorXd xi = vector_of(now.velocity);
  motion.solve(now.time, g, xi);
  const Eigen::VectorXd rate = motion.acceleration();
  double noise = 0;  // of a step, relative to the tolerance
  for (int sample = 1; sample <= 4; ++sample) {
    Eigen::VectorXd eta(xi.size()), moved = xi;
    for (Eigen::Index i = 0; i < xi.size(); ++i) {
      eta[i] = epsilon * std::sin(12.9898 * static_cast<double>(i + 1) + 78.233 * sample);
      moved[i] *= 1 + epsilon * std::sin(39.346 * static_cast<double>(i + 1) + 11.135 * sample);
    }
    setup.geometry->tau(eta.data(), turned.data());
    setup.geometry->compose(g.data(), turned.data(), turned.data());
    motion.solve(now.time, turned, moved);
    for (Eigen::Index i = 0; i < xi.size(); ++i)
      noise = std::max(noise, std::abs(motion.acceleration()[i] - rate[i]) * std::abs(step) /
                                  setup.errors.at(std::abs(xi[i])));
  }
  if (!(noise > (usual > 0 ? kNoiseOfSmall : kNoise))) return {};
  const double reached = usual > 0 ? noise * usual / std::abs(step) : 100 * noise;
  return fmt::format(
      "rtol = {:g} is below the round-off of the equations of motion at t = {:.6g}: "
      "at least {:.0e} can be reached",
      setup.errors.relative, now.time, reached * setup.errors.relative);
}

}  // namespace

std::string reason_of_small_steps(const SystemModel& system, const KernelSetup& setup,
                                  Kernel& kernel, double usual) {
  Snapshot before, now;
  kernel.node(before);
  static_cast<void>(kernel.advance(1));
  kernel.node(now);
  const double step = now.time - before.time;
  std::optional<std::string> found;
  if (setup.geometry != nullptr) try {
      found = dependent_rows(system, setup, now);
      if (!found) found = jumping_force(system, setup, before, now);
      if (!found) found = below_round_off(setup, now, step, usual);
    } catch (const std::exception&) {  // no element, no value beyond the states
    }
  return fmt::format("steps of {:.1e} s do not reach the end: {}", step,
                     found.value_or(fmt::format(
                         "the motion is nearly singular at t = {:.6g}, or stiff", now.time)));
}

std::optional<std::string> reason_of_round_off(const SystemModel& system, const KernelSetup& setup,
                                               Kernel& kernel, double usual) {
  if (setup.geometry == nullptr) return {};
  Snapshot now;
  kernel.node(now);
  if (dependent_rows(system, setup, now)) return {};  // round-off is theirs: do the steps creep?
  return below_round_off(setup, now, kernel.next_step(), usual);
}

}  // namespace hamel
