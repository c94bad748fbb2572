// The admissible velocities of a mechanism as formulas (graph/vector_fields.hpp).
#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/framework/graph/vector_fields.hpp>
#include <hamel/systems/mechanisms/programs/recorded_mechanism.hpp>

namespace hamel::mechanisms {

std::shared_ptr<const graph::VectorFields> record_fields(const MechanismParts& parts,
                                                         std::span<const double> state) {
  const RecordedMechanism mechanism(parts);
  const size_t n = mechanism.xi.size();
  const Frame frame =
      find_frame(parts, mechanism, state, std::vector<Number>(mechanism.rows.size()));
  auto out = std::make_shared<graph::VectorFields>();
  out->recording = mechanism.recording();
  std::vector<Number> element_rates = mechanism.bodies.element_rates();
  for (int link = 0; link < parts.tree.links(); ++link)  // nothing depends on the angle of a rotor
    if (parts.tree.rotor(link))
      element_rates[static_cast<size_t>(parts.tree.element(link))] =
          mechanism.xi[static_cast<size_t>(parts.tree.first(link))];
  std::vector<std::vector<Number>> moves;  // columns of T
  for (size_t i = 0; i < n; ++i) {
    std::vector<Number> unit(n);
    unit[i] = 1;
    moves.push_back(graph::along(element_rates, mechanism.xi, unit));
    out->moves.insert(out->moves.end(), moves[i].begin(), moves[i].end());
  }
  for (size_t a = 0; a < frame.independent.size(); ++a) {
    std::vector<Number> rates(element_rates.size());
    for (size_t i = 0; i < n; ++i) {
      out->velocities.push_back(frame.e[i][a]);
      for (size_t k = 0; k < rates.size(); ++k) rates[k] += frame.e[i][a] * moves[i][k];
    }
    out->rates.insert(out->rates.end(), rates.begin(), rates.end());
  }
  return out;
}

}  // namespace hamel::mechanisms
