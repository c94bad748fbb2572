#include <hamel/framework/analysis/linearisation.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/analysis/linearisation_slopes.hpp>
#include <hamel/framework/analysis/steady_equations.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/mechanics/coordinate_rates.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel {
namespace {

using namespace reduced;

NumberMatrix numbers_of(const Matrix& m) {
  NumberMatrix out(static_cast<int>(m.rows()), static_cast<int>(m.cols()));
  for (int i = 0; i < out.rows; ++i)
    for (int j = 0; j < out.columns; ++j) out(i, j) = m(i, j);
  return out;
}
Matrix matrix_of(const NumberMatrix& m) {
  Matrix out(m.rows, m.columns);
  for (int i = 0; i < m.rows; ++i)
    for (int j = 0; j < m.columns; ++j) out(i, j) = m(i, j);
  return out;
}

// exp(m): a Taylor polynomial of order 18 of m 2^-k, of size 1/2 at most, squared k times.
Matrix exponential(const Matrix& m) {
  int squarings = 0;
  double size = m.size() > 0 ? m.cwiseAbs().rowwise().sum().maxCoeff() : 0;
  for (; size > 0.5; size /= 2) ++squarings;
  const Matrix small = m / std::pow(2.0, squarings);
  Matrix term = Matrix::Identity(m.rows(), m.rows()), out = term;
  for (int k = 1; k <= 18; ++k) {
    term = (term * small / k).eval();
    out += term;
  }
  for (int k = 0; k < squarings; ++k) out = (out * out).eval();
  return out;
}

// The coordinates and velocities of a point, moved by (delta, nu).
Vector columns_of(const SteadyEquations& equations, const SteadyPoint& at, const Vector& z) {
  const int n = equations.dim(), columns = equations.geometry().columns();
  Vector out(columns + n);
  const Vector g = equations.flow().moved(at.g, z.head(n));
  equations.geometry().coordinates(g.data(), out.data());
  out.tail(n) = at.xi + z.tail(n);
  return out;
}
// True of a row with a slope beyond its error, and beyond a part of the largest one of all rows.
bool is_beyond(const Slopes& slopes, Eigen::Index row, double part) {
  if (slopes.value.cols() == 0) return false;
  const double least = part * slopes.value.lpNorm<Eigen::Infinity>();
  return ((slopes.value.row(row).cwiseAbs() - slopes.error.row(row)).array() > least).any();
}

// Names of the 2n numbers, a coordinate that is the integral of a component by its own, and of the
// columns; and how much each of the numbers is preferred as a state: shape, then other
// displacements, then velocities.
struct Names {
  std::vector<std::string> numbers, columns;
  Vector preference;
};
Names names_of(const SystemModel& model) {
  const std::vector<Component> components = components_of(model);
  const auto n = static_cast<Eigen::Index>(components.size());
  Names out{
      .numbers = {}, .columns = model.group.columns, .preference = Vector::Constant(2 * n, 30)};
  for (const Component& component : components) out.numbers.push_back("delta." + component.name);
  for (const ShapeCoordinate& shape : shape_of(model.group)) {
    out.numbers[static_cast<size_t>(shape.component)] = shape.name;
    out.preference[shape.component] = 100;
  }
  for (const Component& component : components) {
    out.numbers.push_back(component.name);
    out.columns.push_back(component.name);
  }
  out.preference.tail(n).setConstant(10);
  // The first of equals, whatever their round-off.
  for (Eigen::Index i = 0; i < 2 * n; ++i)
    out.preference[i] *= 1 - 1e-3 * static_cast<double>(i) / static_cast<double>(2 * n);
  return out;
}

// B in the coordinates of the basis: what a unit of each input adds to the acceleration. Inputs of
// rates are left out.
Slopes input_slopes(const SteadyEquations& equations,
                    const std::shared_ptr<const Geometry>& geometry, const SystemModel& model,
                    const SteadyPoint& at, const ReducedLinearisation& linear, Linearisation& out) {
  const Matrix& dual = linear.dual;
  const int n = equations.dim(), k = equations.flow().constraint_count();
  Slopes slopes{.value = Matrix(dual.rows(), 0), .error = Matrix(dual.rows(), 0)};
  if (!model.drive) return slopes;
  const Slopes all = equations.flow().recorded() != nullptr
                         ? exact_input_slopes(equations, at, linear.sizes)
                         : differenced_input_slopes(equations, geometry, model, at);
  for (size_t i = 0; i < model.inputs.size(); ++i) {
    const Vector value = all.value.col(static_cast<Eigen::Index>(i)),
                 error = all.error.col(static_cast<Eigen::Index>(i));
    if (((value.tail(k).cwiseAbs() - error.tail(k)).array() > 0).any()) {  // it slips
      out.unused.push_back(model.inputs[i].name);
      continue;
    }
    out.inputs.push_back(model.inputs[i].name);
    for (Matrix* m : {&slopes.value, &slopes.error})
      m->conservativeResize(Eigen::NoChange, m->cols() + 1);
    slopes.value.rightCols<1>() = dual.rightCols(n) * value.head(n);
    slopes.error.rightCols<1>() = dual.rightCols(n).cwiseAbs() * error.head(n);
  }
  return slopes;
}

}  // namespace

Linearisation linearisation(const Registry& registry, const Simulation& run) {
  const Run built = run.build();
  const SystemModel& model = built.system();
  const SteadyEquations equations(registry, model, guess_of(run, built));
  bool held = true;
  const SteadyPoint at = equations.find_near_guess(held);
  Linearisation out;
  out.motion = equations.motion(at, -1);
  if (!out.motion.found) {
    throw ConfigError(
        {fmt::format("{}: no steady motion near this start: a residual of {:.2e} is left",
                     model.name, out.motion.residual)});
  }
  const ReducedLinearisation linear = equations.linearise(at);
  // The 2n numbers that distinguish the states best.
  const Names names = names_of(model);
  const Matrix own = linear.sizes.cwiseInverse().asDiagonal() * linear.basis;
  std::vector<int> chosen = dense::pivots(own.transpose() * names.preference.asDiagonal());
  chosen.resize(static_cast<size_t>(linear.basis.cols()));
  std::sort(chosen.begin(), chosen.end());
  Matrix to_states(linear.basis.cols(), linear.basis.cols());
  for (size_t i = 0; i < chosen.size(); ++i) {
    to_states.row(static_cast<Eigen::Index>(i)) = linear.basis.row(chosen[i]);
    out.states.push_back(names.numbers[static_cast<size_t>(chosen[i])]);
  }
  const Matrix from_states = dense::inverse(to_states), embedding = linear.basis * from_states;
  const Matrix size_to = to_states.cwiseAbs(), size_from = from_states.cwiseAbs();
  out.a = numbers_of(to_states * linear.flow * from_states);
  out.a_error = numbers_of(size_to * linear.error * size_from);
  out.embedding = numbers_of(embedding);
  const Slopes inputs =
      input_slopes(equations, registry.geometry(model.group.name, "exp"), model, at, linear, out);
  out.b = numbers_of(to_states * inputs.value);
  out.b_error = numbers_of(size_to * inputs.error);

  // Columns that no symmetry changes, here and where the states are others.
  const CoordinateRates rates(model.group, registry.geometry(model.group.name, "exp"));
  const Eigen::Index columns = static_cast<Eigen::Index>(model.group.columns.size());
  std::vector<bool> changes(static_cast<size_t>(columns + equations.dim()), false);
  for (int sample = 0; sample < 3; ++sample) {
    Vector x(linear.basis.cols());
    for (Eigen::Index i = 0; i < x.size(); ++i)
      x[i] = sample == 0 ? 0 : 0.2 * std::sin(12.9898 * static_cast<double>(i + 1) + sample);
    const Vector z = linear.basis * x;
    const int n = equations.dim();
    const SteadyPoint there = {equations.flow().moved(at.g, z.head(n)), at.xi + z.tail(n), {}, 0};
    const Slopes moved =
        column_slopes(equations, rates, there, equations.orbit(there), linear.sizes);
    for (size_t i = 0; i < changes.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      changes[i] = changes[i] || is_beyond(moved, row, 1e-8);
    }
  }
  const Slopes slopes = column_slopes(equations, rates, at, embedding, linear.sizes);
  const Vector values = columns_of(equations, at, Vector::Zero(2 * equations.dim()));
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (changes[static_cast<size_t>(i)] || !is_beyond(slopes, i, 1e-12)) continue;
    kept.push_back(i);
    out.quantity_columns.push_back(static_cast<int>(i));
    out.values.push_back(values[i]);
    out.quantities.push_back(names.columns[static_cast<size_t>(i)]);
  }
  out.c = numbers_of(slopes.value(kept, Eigen::all));
  out.c_error = numbers_of(slopes.error(kept, Eigen::all));
  return out;
}

DiscretePair Linearisation::sampled(double h) const {
  const Eigen::Index n = a.rows, m = b.columns;
  Matrix whole = Matrix::Zero(n + m, n + m);
  whole.topLeftCorner(n, n) = h * matrix_of(a);
  whole.topRightCorner(n, m) = h * matrix_of(b);
  const Matrix flow = exponential(whole);
  return {numbers_of(flow.topLeftCorner(n, n)), numbers_of(flow.topRightCorner(n, m))};
}

std::vector<double> Linearisation::state(std::span<const double> coordinates,
                                         std::span<const double> velocity) const {
  const Matrix slopes = matrix_of(c);
  const Eigen::Index rank = dense::rank(slopes);
  if (rank < slopes.cols()) {
    throw ConfigError({fmt::format("linearisation: its {} quantities determine {} of {} states",
                                   c.rows, rank, c.columns)});
  }
  Vector apart(c.rows);
  for (size_t i = 0; i < values.size(); ++i) {
    const auto column = static_cast<size_t>(quantity_columns[i]);
    const double now =
        column < coordinates.size() ? coordinates[column] : velocity[column - coordinates.size()];
    apart[static_cast<Eigen::Index>(i)] = now - values[i];
  }
  const Vector x = dense::solve_pivoted(slopes, apart);
  return {x.begin(), x.end()};
}

}  // namespace hamel
