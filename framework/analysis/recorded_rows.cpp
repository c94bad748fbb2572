#include <hamel/framework/analysis/recorded_rows.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/framework/graph/nilpotent.hpp>
#include <hamel/framework/run/data/recorded_formulas.hpp>

namespace hamel {
namespace {

using graph::Number;
using Numbers = std::vector<Number>;

constexpr double kSameRow = 1e-9;  // relative to a row: formulas are those of the system

// Rows as formulas of t, the coordinates, the velocities and the inputs of a run, which are 0.
std::optional<graph::RowFields> rows_of_formulas(const SystemModel& model, const Geometry& geometry,
                                                 const double* g) {
  const RecordedFormulas formulas = recorded_formulas(model, *model.mechanics, g);
  if (!formulas) return std::nullopt;
  const auto recording = std::make_shared<graph::Recording>();
  std::vector<std::string> names;
  for (const InputField& input : model.inputs) names.push_back(input.name);
  const graph::MotionVariables at({factor_shapes(model.group), {}}, model.group.columns,
                                  model.rates, names);
  const graph::SystemFormulas terms = formulas(at.all());
  graph::RowFields out{recording, {}, terms.drift, {}, 0, {}};
  const auto append = [](Numbers& to, const Numbers& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  for (const Numbers& row : terms.rows) append(out.rows, row);
  for (const Number& phi : terms.holonomic)
    append(out.rows, at.pulled_back(graph::gradient({phi}, {1}, at.coordinates)));
  const size_t n = at.velocities.size();
  out.drift.resize(out.rows.size() / n);
  out.moves.resize(n);  // of t
  for (const Number& rate : at.coordinate_rates)
    append(out.moves, graph::gradient({rate}, {1}, at.velocities));
  const size_t count = recording->inputs().size();
  out.moves.resize(n * count);
  recording->end();
  out.inputs = [count, &geometry](const double* element, double t) {
    std::vector<double> values(count, 0.0);
    values[0] = t;
    geometry.coordinates(element, values.data() + 1);
    return values;
  };
  return out;
}

// Whether the formulas are those of the rows of a system, at two times.
bool agree(const graph::RowFields& fields, const Mechanics& mechanics, const double* g) {
  const int k = mechanics.constraint_count(), n = mechanics.dim();
  if (fields.drift.size() != static_cast<size_t>(k)) return false;
  Numbers outputs = fields.rows;
  outputs.insert(outputs.end(), fields.drift.begin(), fields.drift.end());
  graph::NilpotentEvaluation evaluation(*fields.recording, outputs);
  Eigen::MatrixXd a(k, n);
  Eigen::VectorXd b(k);
  for (const double t : {0.0, 0.37}) {
    mechanics.constraints(t, g, a, b);
    const std::vector<double>& found = evaluation(0, fields.inputs(g, t));
    for (int i = 0; i < k; ++i) {
      const Eigen::Map<const Eigen::RowVectorXd> row(found.data() + i * n, n);
      const double lack = std::abs(found[static_cast<size_t>(k * n + i)] - b[i]);
      if (!((row - a.row(i)).norm() <= kSameRow * a.row(i).norm() &&
            lack <= kSameRow * (std::abs(b[i]) + a.row(i).norm())))
        return false;
    }
  }
  return true;
}

}  // namespace

std::optional<graph::RowFields> recorded_rows(const SystemModel& model, const Geometry& geometry,
                                              const double* g) {
  try {
    const auto* own = dynamic_cast<const graph::HasRowFields*>(model.mechanics.get());
    std::optional<graph::RowFields> out =
        own == nullptr ? rows_of_formulas(model, geometry, g) : own->row_fields();
    if (out && !agree(*out, *model.mechanics, g)) out.reset();
    return out;
  } catch (const std::domain_error&) {
    return std::nullopt;
  }
}

}  // namespace hamel
