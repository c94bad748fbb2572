// Measurements of a run: one list of quantities by name, and the largest values over the recorded
// states. The columns of a run, its record and its report, and the tables of a study take names and
// meanings from here.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/loop/snapshot.hpp>
#include <hamel/framework/mechanics/quantities.hpp>

namespace hamel {

// Over a run.
inline constexpr Quantity kEnergyBalanceError = {"energy_balance_error", "1",
                                                 "(E - E0 - work) / max |E|"};
inline constexpr Quantity kReactionWork = {
    "reaction_work", "J", "of A^T lambda, by trapezoids over the rows", "work of reactions"};

inline constexpr Quantity kEstimatedError = {"estimated_error", "columns of g",
                                             "distance of the end from the motion, by Richardson "
                                             "from two finer runs (check)"};
inline constexpr Quantity kObservedOrder = {"observed_order", "1", "that of these three runs"};

/// How far an invariant of the exact motion moved.
struct InvariantDrift {
  std::string name;
  double start = 0;
  double drift_max = 0;  // max |value - start|
  template <class Archive>
  void serialize(Archive& archive) {
    archive(name, start, drift_max);
  }
};

/// The energy balance at a state, (M48).
struct BalancedState {
  double work = 0;    // J, since the start
  double defect = 0;  // J, E - E0 - work
  double scale = 1;   // J, the largest |E| so far
  template <class Archive>
  void serialize(Archive& archive) {
    archive(work, defect, scale);
  }
};

/// (E - E0) / |E0|; E where E0 = 0.
inline double energy_error(double energy, double start) {
  return (energy - start) / (start != 0 ? std::abs(start) : 1.0);
}

/// Euclidean distance of two elements' columns, or of two velocities, of one length.
inline double euclidean_distance(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size());
  double sum = 0;
  for (std::size_t i = 0; i < b.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// The largest |value| so far; NaN for good once a value was not finite.
inline void update_max_abs(double& largest, double value) {
  if (std::isnan(largest)) return;
  largest = std::isfinite(value) ? std::max(largest, std::abs(value))
                                 : std::numeric_limits<double>::quiet_NaN();
}

/// Over the recorded states of one run, and its last. NaN: there is no such thing, or it was not
/// finite.
struct Measurements {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double constraint_max = 0;
  double holonomic_max = kNone;
  double group_defect_max = 0;
  double energy_error_max = 0;
  double rotation_per_step_max = kNone;
  double energy_balance_error_max = kNone,
         work = kNone;  // the same number, and W, where work is done
  double reaction_work = kNone;
  double exact_error_final = kNone, exact_error_max = kNone, exact_velocity_error_max = kNone;
  double estimated_error = kNone, observed_order = kNone;
  std::vector<InvariantDrift> invariants;

  /// Calls f(Quantity, suffix of its name, member pointer), in the order of the record.
  template <class F>
  static void fields(F&& f) {
    f(kConstraint, "_max", &Measurements::constraint_max);
    f(kHolonomic, "_max", &Measurements::holonomic_max);
    f(kGroupDefect, "_max", &Measurements::group_defect_max);
    f(kEnergyError, "_max", &Measurements::energy_error_max);
    f(kRotation, "_max", &Measurements::rotation_per_step_max);
    f(kEnergyBalanceError, "_max", &Measurements::energy_balance_error_max);
    f(kWork, "", &Measurements::work);
    f(kReactionWork, "", &Measurements::reaction_work);
    f(kExactError, "_final", &Measurements::exact_error_final);
    f(kExactError, "_max", &Measurements::exact_error_max);
    f(kExactVelocityError, "_max", &Measurements::exact_velocity_error_max);
    f(kEstimatedError, "", &Measurements::estimated_error);
    f(kObservedOrder, "", &Measurements::observed_order);
  }

  /// Takes in a state; returns its energy error.
  double take(const Snapshot& state, double energy_start) {
    const double error = energy_error(state.energy, energy_start);
    update_max_abs(energy_error_max, error);
    update_max_abs(constraint_max, state.constraint);
    update_max_abs(holonomic_max, state.holonomic);
    update_max_abs(group_defect_max, state.group_defect);
    if (std::isfinite(state.rotation)) {
      rotation_per_step_max = std::fmax(rotation_per_step_max, state.rotation);
    }
    return error;
  }
  /// After the last state, where work is done: the balance in place of what take() saw.
  void balance(double error_max, double work_done) {
    energy_error_max = energy_balance_error_max = error_max;
    work = work_done;
  }
  template <class Archive>
  void serialize(Archive& archive) {
    fields([&](const Quantity&, const char*, auto member) { archive(this->*member); });
    archive(invariants);
  }
  /// The distances of the element's columns and of the velocity.
  std::pair<double, double> compare(const Snapshot& state, std::span<const double> element,
                                    std::span<const double> velocity) {
    exact_error_final = euclidean_distance(state.coordinates, element);
    const double velocity_error = euclidean_distance(state.velocity, velocity);
    update_max_abs(exact_error_max, exact_error_final);
    update_max_abs(exact_velocity_error_max, velocity_error);
    return {exact_error_final, velocity_error};
  }
};

}  // namespace hamel
