// The rows of a mechanism with the numbers that move them (graph/row_fields.hpp).
#include <algorithm>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/systems/mechanisms/multibody.hpp>
#include <hamel/systems/mechanisms/programs/recorded_mechanism.hpp>

namespace hamel::mechanisms {

graph::RowFields record_row_fields(const MechanismParts& parts) {
  const RecordedMechanism mechanism(parts);
  graph::RowFields out;
  out.recording = mechanism.recording();
  for (const RecordedRow& row : mechanism.rows) {
    out.rows.insert(out.rows.end(), row.coefficients.begin(), row.coefficients.end());
    out.drift.push_back(row.drift);
  }
  const size_t n = mechanism.xi.size();
  for (const Number& rate : mechanism.number_rates()) {
    if (rate.constant()) out.moves.resize(out.moves.size() + n);
    else
      for (const Number& slope : graph::gradient({rate}, {1}, mechanism.xi))
        out.moves.push_back(slope);
  }
  return out;
}

std::optional<graph::RowFields> Multibody::row_fields() const {
  const auto changes = [](const Prescribed& p) { return p.time_dependent && !p.driven; };
  if (std::ranges::any_of(rows_.prescribed, changes)) return std::nullopt;
  graph::RowFields out = record_row_fields(parts());
  out.inputs = [this](const double* g, double t) {
    state(g);
    take_rates(t);
    return std::vector<double>(state_.begin(), state_.end());
  };
  return out;
}

}  // namespace hamel::mechanisms
