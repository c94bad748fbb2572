#include <hamel/systems/mechanisms/programs/lift_formulas.hpp>

#include <algorithm>

#include <hamel/systems/mechanisms/programs/force_formulas.hpp>
#include <hamel/systems/mechanisms/programs/step_motion.hpp>

namespace hamel::mechanisms {
namespace {

using Numbers = std::vector<Number>;

// E^T I E of a frame, and the columns of E.
struct Reduced {
  std::vector<Numbers> columns, matrix;

  Reduced(const Frame& frame, const BodyFormulas::Matrix& inertia) {
    const size_t m = frame.independent.size(), n = inertia.size();
    columns.assign(m, Numbers(n));
    matrix.assign(m, Numbers(m));
    std::vector<Numbers> momenta = columns;
    for (size_t j = 0; j < m; ++j) {
      for (size_t i = 0; i < n; ++i) columns[j][i] = frame.e[i][j];
      for (size_t i = 0; i < n; ++i) momenta[j][i] = sum_of_products(inertia[i], columns[j]);
    }
    for (size_t i = 0; i < m; ++i)
      for (size_t j = i; j < m; ++j)
        matrix[i][j] = matrix[j][i] = sum_of_products(columns[i], momenta[j]);
  }
};

}  // namespace

Number sum_of_products(const Numbers& a, const Numbers& b) {
  Number out = 0;
  for (size_t i = 0; i < a.size(); ++i) out += a[i] * b[i];
  return out;
}

std::vector<bool> inputs_of(const Numbers& numbers) {
  const graph::Recording& recording = graph::Recording::current();
  const std::vector<graph::Node>& nodes = recording.nodes();
  std::vector<bool> out(recording.inputs().size()), reached(nodes.size());
  for (const Number& x : numbers)
    if (!x.constant()) reached[static_cast<size_t>(x.node())] = true;
  for (size_t i = nodes.size(); i-- > 0;) {
    if (!reached[i]) continue;
    const graph::Node& node = nodes[i];
    if (node.op == graph::Op::input) {
      out[static_cast<size_t>(node.a)] = true;
    } else if (node.op != graph::Op::constant) {
      for (const int k : {node.a, node.b, node.c})
        if (k >= 0) reached[static_cast<size_t>(k)] = true;
    }
  }
  return out;
}

BodyFormulas LiftFormulas::bodies(const Numbers& element, const Numbers& xi) const {
  return {parts_.tree, tree_element(layout_, parts_.tree, element), xi, parts_.forces.gravity};
}

LiftFormulas::Rows LiftFormulas::rows(const BodyFormulas& bodies, const Numbers& element,
                                      const Numbers& any, const Numbers& rates,
                                      const Numbers& held) const {
  const Numbers g = tree_element(layout_, parts_.tree, element);
  const auto coordinate = [&](int link) { return coordinate_of(part(link), element); };
  Numbers coupled, closures, gaps;
  for (const int link : parts_.rows.coupled_links) coupled.push_back(coordinate(link));
  for (const Coupling& coupling : parts_.rows.couplings) {
    Numbers variables;
    for (const int link : coupling.links) variables.push_back(coordinate(link));
    closures.push_back(coupling.of_rates() ? Number(0) : coupling.formula.record(variables));
  }
  size_t next = 0;
  for (const Prescribed& p : parts_.rows.prescribed)
    gaps.push_back(p.held < 0 || held.empty() ? Number(0) : coordinate(p.held) - held[next++]);
  Rows all = record_rows(parts_.rows, bodies, {g, any, {}, coupled, closures, rates, gaps});
  Rows out;
  for (const int i : parts_.kept) out.push_back(std::move(all[static_cast<size_t>(i)]));
  return out;
}

Numbers LiftFormulas::signals(const Numbers& element, const Numbers& motors) const {
  Numbers out;
  for (const Spring& spring : parts_.forces.springs)
    out.push_back(spring.joint < 0 ? Number(0) : coordinate_of(part(spring.joint), element));
  out.insert(out.end(), motors.begin(), motors.end());
  return out;
}

Numbers LiftFormulas::still_force(const BodyFormulas& bodies, const Numbers& element,
                                  const Numbers& motors) const {
  const Numbers given = signals(element, motors);
  Numbers out = bodies.weight();
  add_springs(parts_.forces, bodies, given, out);
  add_given(parts_.forces, bodies, Numbers(out.size()), given, out);
  return out;
}

Numbers LiftFormulas::damping(const Numbers& element, const Numbers& v) const {
  Numbers out(v.size());
  if (parts_.forces.damped())
    add_given(parts_.forces, bodies(element, v), v,
              signals(element, Numbers(parts_.forces.motors.size())), out);
  return out;
}

LiftFormulas::Carried LiftFormulas::carry(const BodyFormulas& bodies, const Frame& frame,
                                          const Numbers& mu, const Numbers& force,
                                          const Numbers* xi) const {
  const BodyFormulas::Matrix inertia = bodies.inertia();
  const Reduced reduced(frame, inertia);
  const size_t n = inertia.size();
  Carried out;
  for (const Numbers& column : reduced.columns) {
    out.momentum.push_back(sum_of_products(column, mu));
    out.force.push_back(sum_of_products(column, force));
  }
  for (size_t i = 0; i < reduced.matrix.size(); ++i) out.diagonal.push_back(reduced.matrix[i][i]);
  for (size_t i = 0; i < n; ++i)
    if (!inertia[i][i].is(0)) out.force_size += force[i] * force[i] * (1 / inertia[i][i]);
  if (xi != nullptr) {
    out.xi = *xi;
    out.energy = sum_of_products(*xi, mu);
    return out;
  }
  // E^T I (E y + particular) = E^T mu
  Numbers y = out.momentum, beside(n);
  for (size_t i = 0; i < n; ++i) beside[i] = sum_of_products(inertia[i], frame.particular);
  for (size_t j = 0; j < y.size(); ++j) y[j] -= sum_of_products(reduced.columns[j], beside);
  const Numbers rest = y;
  solve_symmetric(reduced.matrix, y);
  for (size_t i = 0; i < n; ++i)
    out.xi.push_back(frame.particular[i] + sum_of_products(frame.e[i], y));
  out.energy = sum_of_products(rest, y) + 2 * sum_of_products(beside, out.xi) -
               sum_of_products(beside, frame.particular);
  return out;
}

}  // namespace hamel::mechanisms
