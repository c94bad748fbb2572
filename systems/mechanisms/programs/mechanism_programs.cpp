#include <hamel/systems/mechanisms/programs/mechanism_programs.hpp>

#include <string>
#include <tuple>
#include <utility>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/systems/mechanisms/programs/force_formulas.hpp>
#include <hamel/systems/mechanisms/programs/recorded_mechanism.hpp>

namespace hamel::mechanisms {
namespace {

using Numbers = std::vector<Number>;

constexpr size_t kLongProgram = 20'000;  // instructions: machine code of more takes seconds to make

Numbers joined(Numbers a, const Numbers& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

size_t MechanismParts::first_foot() const {
  return static_cast<size_t>(tree.size() + tree.dim()) + count_signals(forces);
}

size_t MechanismParts::first_coupled() const { return first_foot() + rows.foot_count(); }

void MechanismParts::find_feet(std::span<double> state) const {
  if (!rows.ground.height) return;
  size_t next = first_foot();
  for (const Contact& contact : rows.contacts)
    for (const double x : contact.model->foot(contact, tree, rows.ground)) state[next++] = x;
}

size_t MechanismParts::state_size() const {
  return first_coupled() + rows.coupled_links.size() + rows.couplings.size() +
         3 * rows.prescribed.size();
}

void MechanismParts::find_coupled(std::span<double> state) const {
  if (rows.couplings.empty()) return;
  size_t next = first_coupled();
  for (const int link : rows.coupled_links)
    state[next++] = tree.joint(link).coordinate(state.data() + tree.element(link));
}

void MechanismParts::find_closures(std::span<double> state) const {
  size_t next = state.size() - 3 * rows.prescribed.size() - rows.couplings.size();
  for (const Coupling& coupling : rows.couplings)
    state[next++] = coupling.beyond(tree, state.data());
}

FilledProgram::FilledProgram(std::shared_ptr<const graph::Recording> recording,
                             const Numbers& values)
    : recording_(std::move(recording)), constants_(values.size(), 0.0) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (values[i].constant()) {
      constants_[i] = values[i].value();
    } else {
      values_.push_back(values[i]);
      places_.push_back(i);
    }
  }
}

void FilledProgram::evaluate(const double* state) {
  if (places_.empty()) return;
  if (!code_) {
    graph::Program::Outputs outputs;
    for (size_t i = 0; i < places_.size(); ++i)
      outputs.emplace_back(std::to_string(places_[i]), values_[i]);
    const auto program = std::make_shared<graph::Program>(*recording_, outputs);
    const bool is_long = program->instructions().size() > kLongProgram;
    code_.emplace(program, 1, is_long ? graph::Machine::refused : graph::Machine::allowed);
    results_.resize(places_.size());
    work_.resize(code_->work_size());
  }
  (*code_)(state, results_.data(), work_.data());
}

// Everything recorded, while it is made into programs.
struct MechanismPrograms::Recorded {
  explicit Recorded(const MechanismParts& parts) : mechanism(parts) {
    const size_t n = mechanism.xi.size();
    const BodyFormulas& bodies = mechanism.bodies;
    const BodyFormulas::Matrix i = bodies.inertia();
    for (size_t column = 0; column < n; ++column)
      for (size_t row = 0; row < n; ++row) inertia.push_back(i[row][column]);
    for (size_t column = 0; column < n; ++column)
      for (const RecordedRow& row : mechanism.rows) rows.push_back(row.coefficients[column]);
    for (const RecordedRow& row : mechanism.rows) {
      drift.push_back(row.drift);
      values.push_back(row.value);
    }
    for (size_t k = mechanism.rows.size() - static_cast<size_t>(parts.holonomic);
         k < mechanism.rows.size(); ++k)
      phi.push_back(mechanism.rows[k].phi);
    std::tie(momentum, inertial) = bodies.momentum();
    given.resize(n);
    mechanism.add_given_forces(given);
    applied = weight = bodies.weight();
    mechanism.add_spring_forces(applied);
    for (size_t k = 0; k < n; ++k) applied[k] += given[k];
    potential = {bodies.potential() + mechanism.spring_potential()};
  }
  FilledProgram program(const Numbers& numbers) const { return {mechanism.recording(), numbers}; }
  RecordedMechanism mechanism;
  Numbers inertia, rows, drift, values, phi, momentum, inertial, weight, applied, given, potential;
};

MechanismPrograms::MechanismPrograms(const MechanismParts& parts)
    : MechanismPrograms(Recorded(parts)) {}

MechanismPrograms::MechanismPrograms(const Recorded& recorded)
    : inertia(recorded.program(recorded.inertia)),
      rows(recorded.program(recorded.rows)),
      drift(recorded.program(recorded.drift)),
      row_values(recorded.program(recorded.values)),
      holonomic(recorded.program(recorded.phi)),
      momentum(recorded.program(joined(recorded.momentum, recorded.inertial))),
      inertial_force(recorded.program(recorded.inertial)),
      applied_force(recorded.program(recorded.applied)),
      given_force(recorded.program(recorded.given)),
      weight(recorded.program(recorded.weight)),
      potential(recorded.program(recorded.potential)) {}

FilledProgram record_rates(const MechanismParts& parts) {
  const RecordedMechanism mechanism(parts);
  Numbers change = mechanism.bodies.efforts(Numbers(mechanism.xi.size()));
  for (Number& x : change) x = -x;
  mechanism.add_spring_forces(change);
  mechanism.add_given_forces(change);
  return {mechanism.recording(), joined(mechanism.row_rates(), change)};
}

}  // namespace hamel::mechanisms
