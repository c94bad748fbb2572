// Formulas of a mechanical system at a place, recorded: what equations of a step are recorded of.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/graph/number.hpp>

namespace hamel::graph {

/// L = 1/2 xi^T I xi - V, force f, rows A xi = b that are no differentials, holonomic rows phi.
struct SystemFormulas {
  using Numbers = std::vector<Number>;
  std::vector<Numbers> inertia, rows;  // I and A by rows
  Numbers drift;                       // b; empty: 0
  Numbers holonomic;                   // phi
  Number potential;                    // V
  Numbers force;                       // f; empty: 0
};

/// A system that has its equations as formulas of its variables: the coordinates, t, the inputs,
/// the velocities xi.
class HasSystemFormulas {
 public:
  virtual ~HasSystemFormulas() = default;
  /// Recorded in the current recording.
  virtual SystemFormulas system_formulas(std::span<const Number> variables) const = 0;
};

/// Place of a system that is a type in C++: the element as its group lays it out, 0 for turns of a
/// circle.
struct FormulaPlace {
  std::vector<Number> element;
  Number t;
  std::vector<Number> inputs;
};
/// Formulas of a system that is a type in C++, at its parameters.
using FormulasOfParameters = std::function<SystemFormulas(
    const std::map<std::string, std::vector<double>>& parameters, const FormulaPlace& at)>;
/// Adds them under a key of the type. Not thread-safe.
void add_system_formulas(const std::string& key, FormulasOfParameters formulas);
/// Null where there are none.
const FormulasOfParameters* find_system_formulas(const std::string& key);

}  // namespace hamel::graph
