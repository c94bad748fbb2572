// Formulas of a mechanical system at a place, recorded: what equations of a step are recorded of.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <hamel/framework/graph/number.hpp>

namespace hamel::graph {

/// L = 1/2 xi^T I xi - V, force f, rows A xi = b that are no differentials, holonomic rows phi.
struct SystemFormulas {
  std::vector<Number> inertia;    // I, n x n, row by row
  std::vector<Number> rows;       // A, row by row
  std::vector<Number> drift;      // b
  std::vector<Number> holonomic;  // phi
  std::vector<Number> force;      // f, n
  Number potential;               // V
};

/// A system that has its equations as formulas of its variables: the coordinates, t, the inputs,
/// the velocities xi.
class HasSystemFormulas {
 public:
  virtual ~HasSystemFormulas() = default;
  /// Records them; nothing where they are no formulas of these variables.
  virtual std::optional<SystemFormulas> system_formulas(
      std::span<const Number> variables) const = 0;
};

}  // namespace hamel::graph
