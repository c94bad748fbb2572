// The equations of a system by data as formulas (graph/system_formulas.hpp).
#include <algorithm>

#include <hamel/framework/run/data/data_mechanics.hpp>

namespace hamel {
namespace {

using graph::Number;
using Numbers = std::vector<Number>;

std::vector<Numbers> recorded(const FormulaMatrix& matrix, std::span<const Number> variables) {
  std::vector<Numbers> out;
  for (Eigen::Index i = 0; i < matrix.constant.rows(); ++i) {
    out.emplace_back();
    for (Eigen::Index j = 0; j < matrix.constant.cols(); ++j)
      out.back().emplace_back(matrix.constant(i, j));
  }
  for (const FormulaMatrix::Entry& e : matrix.entries)
    out[static_cast<size_t>(e.row)][static_cast<size_t>(e.column)] = e.value.record(variables);
  return out;
}

Numbers recorded_vector(const FormulaMatrix& vector, std::span<const Number> variables) {
  Numbers out;
  for (const Numbers& row : recorded(vector, variables)) out.push_back(row.front());
  return out;
}

}  // namespace

graph::SystemFormulas DataMechanics::system_formulas(std::span<const Number> variables) const {
  const auto n = static_cast<size_t>(n_), states = static_cast<size_t>(states_);
  const auto at_velocity = [&](size_t unit) {  // one of them 1, the others 0
    Numbers out(variables.begin(), variables.end());
    std::fill(out.end() - n_, out.end(), Number(0));
    if (unit < n) out[out.size() - n + unit] = 1;
    return recorded_vector(f_.states, out);
  };

  graph::SystemFormulas out;
  out.inertia = recorded(f_.inertia, variables);
  for (Numbers& row : out.inertia) row.resize(n);
  out.inertia.resize(n, Numbers(n));
  out.rows = recorded(f_.rows, variables);
  for (Numbers& row : out.rows) row.resize(n);
  out.drift = recorded_vector(f_.drift, variables);
  if (states > 0) {  // z' - f = 0, f linear in velocities but for terms without one
    const Numbers still = at_velocity(n);
    std::vector<Numbers> rows(states, Numbers(n));
    for (size_t j = 0; j < n; ++j) {
      const Numbers along = at_velocity(j);
      for (size_t i = 0; i < states; ++i) rows[i][j] = still[i] - along[i];
    }
    for (size_t i = 0; i < states; ++i) rows[i][n - states + i] += 1;
    out.rows.insert(out.rows.end(), rows.begin(), rows.end());
    out.drift.insert(out.drift.end(), still.begin(), still.end());
  }
  out.holonomic = recorded_vector(f_.holonomic, variables);
  out.potential = recorded_vector(f_.potential, variables).front();
  out.force = recorded_vector(f_.force, variables);
  out.force.resize(n);
  return out;
}

}  // namespace hamel
