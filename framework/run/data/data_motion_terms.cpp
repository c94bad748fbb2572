// The equations of a system by data as formulas (graph/motion_terms.hpp).
#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/framework/run/data/data_mechanics.hpp>

namespace hamel {
namespace {

using graph::Number;
using Numbers = std::vector<Number>;

std::vector<Numbers> recorded(const FormulaMatrix& matrix, const Numbers& variables) {
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

Numbers recorded_vector(const FormulaMatrix& vector, const Numbers& variables) {
  Numbers out;
  for (const Numbers& row : recorded(vector, variables)) out.push_back(row.front());
  return out;
}

}  // namespace

graph::MotionTerms DataMechanics::motion_terms(const graph::MotionVariables& at) const {
  const auto n = static_cast<size_t>(n_), states = static_cast<size_t>(states_);
  Numbers variables = at.coordinates;
  variables.push_back(at.t);
  variables.insert(variables.end(), at.inputs.begin(), at.inputs.end());
  Numbers at_rest = variables;
  variables.insert(variables.end(), at.velocities.begin(), at.velocities.end());
  at_rest.resize(variables.size());

  graph::StatedFormulas out;
  out.inertia = recorded(f_.inertia, variables);
  for (Numbers& row : out.inertia) row.resize(n);
  out.inertia.resize(n, Numbers(n));
  out.rows = recorded(f_.rows, variables);
  for (Numbers& row : out.rows) row.resize(n);
  out.drift = recorded_vector(f_.drift, variables);
  const Numbers rates = recorded_vector(f_.states, variables);
  const Numbers still = recorded_vector(f_.states, at_rest);
  for (size_t i = 0; i < states; ++i) {  // z' - f = 0, f linear in velocities
    Numbers row = graph::gradient({rates[i]}, {1}, at.velocities);
    for (Number& x : row) x = -x;
    row[n - states + i] += 1;
    out.rows.push_back(std::move(row));
    out.drift.push_back(still[i]);
  }
  out.holonomic = recorded_vector(f_.holonomic, variables);
  out.potential = recorded_vector(f_.potential, variables).front();
  out.force = recorded_vector(f_.force, variables);
  out.force.resize(n);
  return graph::terms_of(out, at);
}

}  // namespace hamel
