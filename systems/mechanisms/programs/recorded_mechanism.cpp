#include <hamel/systems/mechanisms/programs/recorded_mechanism.hpp>

#include <string>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/systems/mechanisms/programs/force_formulas.hpp>

namespace hamel::mechanisms {
namespace {

std::vector<RecordedRow> kept_rows(const MechanismParts& parts, std::vector<RecordedRow> all) {
  std::vector<RecordedRow> out;
  for (const int i : parts.kept) out.push_back(std::move(all[static_cast<size_t>(i)]));
  return out;
}

}  // namespace

RecordedMechanism::RecordedMechanism(const MechanismParts& parts)
    : parts_(parts),
      g(inputs("g", static_cast<size_t>(parts.tree.size()))),
      xi(inputs("xi", static_cast<size_t>(parts.tree.dim()))),
      signals(inputs("signal", count_signals(parts.forces))),
      coupled(inputs("coupled", parts.rows.coupled_links.size())),
      closures(inputs("closure", parts.rows.couplings.size())),
      rates(inputs("rate", parts.rows.prescribed.size())),
      slopes(inputs("slope", rates.size())),
      gaps(inputs("gap", rates.size())),
      bodies(parts.tree, g, xi, parts.forces.gravity),
      rows(kept_rows(parts, record_rows(parts.rows, bodies, row_inputs()))) {}

RecordedMechanism::Numbers RecordedMechanism::inputs(const char* name, size_t count) {
  Numbers out;
  for (size_t i = 0; i < count; ++i) out.push_back(recording_->input(name + std::to_string(i + 1)));
  return out;
}

RecordedMechanism::Numbers RecordedMechanism::row_rates() const {
  Numbers lacks, moving = g, moves = bodies.element_rates();
  for (const RecordedRow& row : rows) lacks.push_back(-row.value);
  moving.insert(moving.end(), rates.begin(), rates.end());
  moves.insert(moves.end(), slopes.begin(), slopes.end());
  moving.insert(moving.end(), coupled.begin(), coupled.end());
  for (const int link : parts_.rows.coupled_links)
    moves.push_back(xi[static_cast<size_t>(parts_.tree.first(link))]);
  return graph::along(lacks, moving, moves);
}

void RecordedMechanism::add_spring_forces(Numbers& out) const {
  add_springs(parts_.forces, bodies, signals, out);
}
void RecordedMechanism::add_given_forces(Numbers& out) const {
  add_given(parts_.forces, bodies, xi, signals, out);
}
Number RecordedMechanism::spring_potential() const {
  return potential_of_springs(parts_.forces, bodies, signals);
}

}  // namespace hamel::mechanisms
