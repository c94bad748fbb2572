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
      feet(inputs("foot", parts.rows.foot_count())),
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

RecordedMechanism::Numbers RecordedMechanism::number_rates() const {
  Numbers out = bodies.element_rates();
  const auto append = [&out](const Numbers& more) {
    out.insert(out.end(), more.begin(), more.end());
  };
  append(Numbers(xi.size() + signals.size()));
  append(foot_rates());
  for (const int link : parts_.rows.coupled_links)
    out.push_back(xi[static_cast<size_t>(parts_.tree.first(link))]);
  append(Numbers(closures.size()));
  append(slopes);
  append(Numbers(slopes.size() + gaps.size()));
  return out;
}

RecordedMechanism::Numbers RecordedMechanism::row_rates() const {
  Numbers lacks, all;
  for (const RecordedRow& row : rows) lacks.push_back(-row.value);
  for (const auto* part : {&g, &xi, &signals, &feet, &coupled, &closures, &rates, &slopes, &gaps})
    all.insert(all.end(), part->begin(), part->end());
  return graph::along(lacks, all, number_rates());
}

// The equations of each foot stay 0.
RecordedMechanism::Numbers RecordedMechanism::foot_rates() const {
  Numbers out;
  if (feet.empty()) return out;
  const Numbers zero = record_feet(parts_.rows, bodies, feet);
  const Numbers change = graph::along(zero, g, bodies.element_rates());
  for (size_t i = 0; i < feet.size(); i += 2) {
    const Numbers own = {zero[i], zero[i + 1]}, foot = {feet[i], feet[i + 1]};
    const Numbers by_x = graph::along(own, foot, {1, 0}), by_y = graph::along(own, foot, {0, 1});
    const Number determinant = by_x[0] * by_y[1] - by_x[1] * by_y[0];
    out.push_back((by_y[0] * change[i + 1] - by_y[1] * change[i]) / determinant);
    out.push_back((by_x[1] * change[i] - by_x[0] * change[i + 1]) / determinant);
  }
  return out;
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
