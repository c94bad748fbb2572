// The equations of a mechanism as formulas of its coordinates (graph/motion_terms.hpp).
#include <stdexcept>

#include <hamel/framework/graph/substitute.hpp>
#include <hamel/systems/mechanisms/multibody.hpp>
#include <hamel/systems/mechanisms/programs/recorded_mechanism.hpp>

namespace hamel::mechanisms {
namespace {

using Numbers = std::vector<Number>;

[[noreturn]] void refuse(const std::string& part) {
  throw std::domain_error(part + " is evaluated outside of the recorded formulas");
}

// Inertia, rows, drift, row rates and change, one after the other, and their recording.
struct RecordedTerms {
  explicit RecordedTerms(const MechanismParts& parts) {
    const RecordedMechanism mechanism(parts);
    recording = mechanism.recording();
    const auto append = [this](const Numbers& from) {
      values.insert(values.end(), from.begin(), from.end());
    };
    for (const Numbers& row : mechanism.bodies.inertia()) append(row);
    for (const RecordedRow& row : mechanism.rows) append(row.coefficients);
    for (const RecordedRow& row : mechanism.rows) values.push_back(row.drift);
    append(mechanism.row_rates());
    Numbers change = mechanism.bodies.efforts(Numbers(mechanism.xi.size()));
    for (Number& x : change) x = -x;
    mechanism.add_spring_forces(change);
    mechanism.add_given_forces(change);
    append(change);
  }
  std::shared_ptr<const graph::Recording> recording;
  Numbers values;
};

}  // namespace

graph::MotionTerms Multibody::motion_terms(const graph::MotionVariables& at) const {
  if (rows_.ground.height) refuse("the height of the ground under a contact");
  Numbers state = at.element;
  const auto append = [&state](const Numbers& from) {
    state.insert(state.end(), from.begin(), from.end());
  };
  append(at.velocities);
  for (const Spring& spring : forces_.springs)
    state.push_back(spring.joint < 0 ? Number(0) : at.coordinate(tree_.first(spring.joint)));
  const size_t own = forces_.motors.size() - driven_motors_;
  if (own > 0) refuse("the effort of the motor " + forces_.motors.front().name);
  Numbers rates(rows_.prescribed.size());
  for (size_t i = 0; i < drivers_.size(); ++i) {
    if (!drivers_[i].rate) state.push_back(at.inputs[i]);
    for (size_t k = 0; k < rates.size(); ++k)
      if (drivers_[i].rate && rows_.prescribed[k].dof == drivers_[i].dof) rates[k] = at.inputs[i];
  }
  if (!forces_.forces.empty()) refuse("the force " + forces_.forces.front().name);
  for (const int link : rows_.coupled_links) state.push_back(at.coordinate(tree_.first(link)));
  append(Numbers(rows_.couplings.size()));  // closures: of phi alone
  for (size_t k = 0; k < rates.size(); ++k) {
    const Prescribed& p = rows_.prescribed[k];
    if (p.driven) continue;
    if (p.time_dependent) refuse("the rate of " + p.name);
    rates[k] = p.rate(0);
  }
  append(rates);
  append(Numbers(2 * rates.size()));  // slopes, as inputs are held; gaps

  const RecordedTerms recorded(parts());
  const Numbers values = graph::substituted(*recorded.recording, recorded.values, state);
  graph::MotionTerms out;
  auto next = values.begin();
  const auto take = [&next](size_t count) {
    const auto first = next;
    next += static_cast<std::ptrdiff_t>(count);
    return Numbers(first, next);
  };
  const auto n = static_cast<size_t>(dim()), k = kept_.size();
  for (size_t i = 0; i < n; ++i) out.inertia.push_back(take(n));
  for (size_t i = 0; i < k; ++i) out.rows.push_back(take(n));
  out.drift = take(k);
  out.row_rates = take(k);
  out.change = take(n);
  return out;
}

}  // namespace hamel::mechanisms
