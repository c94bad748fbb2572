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

// The energy and forces of a mechanism by its parts: inertia, rows that are no differentials, their
// drift, phi, potential and given forces.
struct RecordedParts {
  RecordedParts(const MechanismParts& parts) {
    const RecordedMechanism mechanism(parts);
    recording = mechanism.recording();
    const size_t held = mechanism.rows.size() - static_cast<size_t>(parts.holonomic);
    const auto append = [this](const Numbers& from) {
      values.insert(values.end(), from.begin(), from.end());
    };
    for (const Numbers& row : mechanism.bodies.inertia()) append(row);
    for (size_t i = 0; i < held; ++i) append(mechanism.rows[i].coefficients);
    for (const RecordedRow& row : mechanism.rows) values.push_back(row.drift);
    for (size_t i = held; i < mechanism.rows.size(); ++i) {
      if (mechanism.rows[i].phi.constant()) refuse("a row of a held joint");
      values.push_back(mechanism.rows[i].phi);
    }
    values.push_back(mechanism.bodies.potential() + mechanism.spring_potential());
    Numbers given(mechanism.xi.size());
    mechanism.add_given_forces(given);
    append(given);
  }
  std::shared_ptr<const graph::Recording> recording;
  Numbers values;
};

class Taker {
 public:
  explicit Taker(const Numbers& values) : next_(values.begin()) {}
  Numbers take(size_t count) {
    const auto first = next_;
    next_ += static_cast<std::ptrdiff_t>(count);
    return {first, next_};
  }

 private:
  Numbers::const_iterator next_;
};

}  // namespace

// The state of the programs, of formulas.
Numbers Multibody::recorded_state(const RecordedPlace& at) const {
  if (rows_.ground.height) refuse("the height of the ground under a contact");
  Numbers state = at.element;
  const auto append = [&state](const Numbers& from) {
    state.insert(state.end(), from.begin(), from.end());
  };
  append(at.velocities);
  for (const Spring& spring : forces_.springs)
    state.push_back(spring.joint < 0 ? Number(0) : at.coordinate(spring.joint));
  const size_t own = forces_.motors.size() - driven_motors_;
  if (own > 0) refuse("the effort of the motor " + forces_.motors.front().name);
  Numbers rates(rows_.prescribed.size());
  for (size_t i = 0; i < drivers_.size(); ++i) {
    if (!drivers_[i].rate) state.push_back(at.inputs[i]);
    for (size_t k = 0; k < rates.size(); ++k)
      if (drivers_[i].rate && rows_.prescribed[k].dof == drivers_[i].dof) rates[k] = at.inputs[i];
  }
  if (!forces_.forces.empty()) refuse("the force " + forces_.forces.front().name);
  for (const int link : rows_.coupled_links) state.push_back(at.coordinate(link));
  append(Numbers(rows_.couplings.size()));  // closures: of phi alone
  for (size_t k = 0; k < rates.size(); ++k) {
    const Prescribed& p = rows_.prescribed[k];
    if (p.driven) continue;
    if (p.time_dependent) refuse("the rate of " + p.name);
    rates[k] = p.rate(0);
  }
  append(rates);
  append(Numbers(2 * rates.size()));  // slopes, as inputs are held; gaps
  return state;
}

graph::MotionTerms Multibody::motion_terms(const graph::MotionVariables& at) const {
  const Numbers state = recorded_state({at.element, at.velocities, at.inputs, [&](int link) {
                                          return at.coordinate(tree_.first(link));
                                        }});
  const RecordedTerms recorded(parts());
  const Numbers values = graph::substituted(*recorded.recording, recorded.values, state);
  Taker values_of(values);
  const auto take = [&values_of](size_t count) { return values_of.take(count); };
  graph::MotionTerms out;
  const auto n = static_cast<size_t>(dim()), k = kept_.size();
  for (size_t i = 0; i < n; ++i) out.inertia.push_back(take(n));
  for (size_t i = 0; i < k; ++i) out.rows.push_back(take(n));
  out.drift = take(k);
  out.row_rates = take(k);
  out.change = take(n);
  return out;
}

graph::SystemFormulas Multibody::system_formulas(std::span<const Number> variables) const {
  std::vector<graph::FactorShape> factors;
  std::vector<size_t> columns;  // where those of a link begin
  size_t size = 0;
  for (int link = 0; link < tree_.links(); ++link) {
    columns.push_back(size);
    for (const GroupFactor& factor : tree_.joint(link).group().factors) {
      factors.push_back({factor.name, factor.dim, factor.columns, factor.name == "r1"});
      size += static_cast<size_t>(factor.columns);
    }
  }
  const auto n = static_cast<size_t>(dim()), k = kept_.size(),
             held = static_cast<size_t>(holonomic_);
  const std::span<const Number> coordinates = variables.first(size),
                                given =
                                    variables.subspan(size + 1, variables.size() - size - 1 - n),
                                velocities = variables.last(n);
  Numbers inputs(given.begin(), given.end());
  inputs.resize(drivers_.size());  // 0 in a run that is given none
  const Numbers state =
      recorded_state({graph::element_of(factors, coordinates),
                      {velocities.begin(), velocities.end()},
                      inputs,
                      [&](int link) { return coordinates[columns[static_cast<size_t>(link)]]; }});
  const RecordedParts recorded(parts());
  const Numbers values = graph::substituted(*recorded.recording, recorded.values, state);
  Taker values_of(values);
  graph::SystemFormulas out;
  for (size_t i = 0; i < n; ++i) out.inertia.push_back(values_of.take(n));
  for (size_t i = held; i < k; ++i) out.rows.push_back(values_of.take(n));
  out.drift = values_of.take(k);
  out.holonomic = values_of.take(held);
  out.potential = values_of.take(1).front();
  out.force = values_of.take(n);
  return out;
}

}  // namespace hamel::mechanisms
