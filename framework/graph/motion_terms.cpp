#include <hamel/framework/graph/motion_terms.hpp>

#include <stdexcept>
#include <utility>

#include <hamel/framework/graph/derivatives.hpp>

namespace hamel::graph {
namespace {

using Numbers = std::vector<Number>;

Numbers inputs_named(const std::vector<std::string>& names) {
  Numbers out;
  for (const std::string& name : names) out.push_back(Recording::current().input(name));
  return out;
}

// so2 and se2 lay out cos, sin and turns, rotations their columns.
void add_element(const FactorShape& factor, const Number* x, Numbers& element) {
  const auto circle = [&] { element.insert(element.end(), {cos(x[0]), sin(x[0]), 0}); };
  const auto rotation = [&] {
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) element.push_back(x[3 * i + j]);
  };
  if (factor.name == "so2") {
    circle();
  } else if (factor.name == "se2") {
    circle();
    element.insert(element.end(), {x[1], x[2]});
  } else if (factor.name == "so3") {
    rotation();
  } else if (factor.name == "se3") {
    rotation();
    element.insert(element.end(), {x[9], x[10], x[11]});
  } else if (factor.name == "heisenberg" || factor.is_shape) {
    element.insert(element.end(), x, x + factor.columns);
  } else {
    throw std::domain_error("the group " + factor.name + " has no formulas of its coordinates");
  }
}

}  // namespace

Numbers element_of(const std::vector<FactorShape>& factors, std::span<const Number> coordinates) {
  Numbers out;
  size_t column = 0;
  for (const FactorShape& factor : factors) {
    add_element(factor, coordinates.data() + column, out);
    column += static_cast<size_t>(factor.columns);
  }
  return out;
}

MotionVariables::MotionVariables(const GroupShape& group,
                                 const std::vector<std::string>& coordinate_names,
                                 const std::vector<std::string>& velocity_names,
                                 const std::vector<std::string>& input_names)
    : t(Recording::current().input("t")),
      coordinates(inputs_named(coordinate_names)),
      velocities(inputs_named(velocity_names)),
      inputs(inputs_named(input_names)),
      element(element_of(group.factors, coordinates)),
      group_(group) {
  size_t column = 0, velocity = 0;
  for (const FactorShape& factor : group.factors) {
    add_rates(factor, column, velocity);
    column += static_cast<size_t>(factor.columns);
    velocity += static_cast<size_t>(factor.dim);
  }
}

void MotionVariables::add_rates(const FactorShape& factor, size_t column, size_t velocity) {
  const Number* x = coordinates.data() + column;
  const Number* v = velocities.data() + velocity;
  const auto rotation = [&] {  // R' = R hat(omega)
    for (int i = 0; i < 3; ++i) {
      const Number* row = x + 3 * i;
      coordinate_rates.push_back(row[1] * v[2] - row[2] * v[1]);
      coordinate_rates.push_back(row[2] * v[0] - row[0] * v[2]);
      coordinate_rates.push_back(row[0] * v[1] - row[1] * v[0]);
    }
  };
  if (factor.name == "se2") {
    coordinate_rates.push_back(v[0]);
    coordinate_rates.push_back(cos(x[0]) * v[1] - sin(x[0]) * v[2]);
    coordinate_rates.push_back(sin(x[0]) * v[1] + cos(x[0]) * v[2]);
  } else if (factor.name == "so3") {
    rotation();
  } else if (factor.name == "se3") {
    rotation();
    for (int i = 0; i < 3; ++i)
      coordinate_rates.push_back(x[3 * i] * v[3] + x[3 * i + 1] * v[4] + x[3 * i + 2] * v[5]);
  } else if (factor.name == "heisenberg") {
    coordinate_rates.insert(coordinate_rates.end(),
                            {v[0], v[1], v[2] + 0.5 * (x[0] * v[1] - x[1] * v[0])});
  } else {
    coordinate_rates.insert(coordinate_rates.end(), v, v + factor.dim);
  }
}

Number MotionVariables::coordinate(int velocity) const {
  size_t column = 0;
  int first = 0;
  for (const FactorShape& factor : group_.factors) {
    if (velocity < first + factor.dim) {
      if (factor.columns != factor.dim)
        throw std::domain_error("a velocity of " + factor.name + " has no coordinate of its own");
      return coordinates[column + static_cast<size_t>(velocity - first)];
    }
    column += static_cast<size_t>(factor.columns);
    first += factor.dim;
  }
  throw std::out_of_range("graph::MotionVariables::coordinate");
}

MotionVariables::Numbers MotionVariables::all() const {
  Numbers out = coordinates;
  out.push_back(t);
  out.insert(out.end(), inputs.begin(), inputs.end());
  out.insert(out.end(), velocities.begin(), velocities.end());
  return out;
}

Numbers MotionVariables::ad_transpose(const Numbers& mu) const {
  const size_t n = velocities.size();
  Numbers out(n);
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < n; ++j)
      for (size_t k = 0; k < n; ++k)
        out[k] += group_.structure[(i * n + j) * n + k] * (velocities[i] * mu[j]);
  return out;
}

Numbers MotionVariables::pulled_back(const Numbers& slope) const {
  return gradient(coordinate_rates, slope, velocities);
}

namespace {

Numbers product(const std::vector<Numbers>& m, const Numbers& x) {
  Numbers out(m.size());
  for (size_t i = 0; i < m.size(); ++i)
    for (size_t j = 0; j < x.size(); ++j) out[i] += m[i][j] * x[j];
  return out;
}

}  // namespace

MotionTerms terms_of(const SystemFormulas& formulas, const MotionVariables& at) {
  MotionTerms out{formulas.inertia, formulas.rows, formulas.drift, {}, {}};
  for (const Number& phi : formulas.holonomic)
    out.rows.push_back(at.pulled_back(gradient({phi}, {1}, at.coordinates)));
  out.drift.resize(out.rows.size());

  Numbers lacks = product(out.rows, at.velocities);  // b - A xi
  for (size_t i = 0; i < lacks.size(); ++i) lacks[i] = out.drift[i] - lacks[i];
  Numbers moving = at.coordinates, moves = at.coordinate_rates;
  moving.push_back(at.t);
  moves.push_back(1);
  out.row_rates = along(lacks, moving, moves);

  const Numbers momentum = product(out.inertia, at.velocities);
  Number lagrangian = -formulas.potential;
  for (size_t i = 0; i < momentum.size(); ++i) lagrangian += 0.5 * (momentum[i] * at.velocities[i]);
  const Numbers slopes = at.pulled_back(gradient({lagrangian}, {1}, at.coordinates));
  const Numbers held = along(momentum, at.coordinates, at.coordinate_rates);
  out.change = at.ad_transpose(momentum);
  for (size_t i = 0; i < out.change.size(); ++i) {
    out.change[i] += slopes[i] - held[i];
    if (!formulas.force.empty()) out.change[i] += formulas.force[i];
  }
  return out;
}

}  // namespace hamel::graph
