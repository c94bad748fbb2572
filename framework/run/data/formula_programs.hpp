// Values and derivatives of the formulas of a system by data, as programs over its variables. Not
// installed.
#pragma once

#include <array>
#include <cstddef>
#include <mutex>
#include <optional>

#include <hamel/framework/graph/code.hpp>
#include <hamel/framework/run/data/formula_matrix.hpp>

namespace hamel {

/// Outputs of a program, in this order. Slopes are derivatives by the coordinates.
enum class Evaluation {
  inertia,         ///< its entries
  constraints,     ///< entries of the rows, of the drift; of each state's rate its slopes by the
                   ///< velocities, then its value without one; slopes of each holonomic row
  holonomic,       ///< its entries
  potential,       ///< its value, where it is a formula
  applied_force,   ///< entries of the force
  force,           ///< the same; slopes of 1/2 xi^T I xi - V, unless both are constant
  inertial_force,  ///< slopes of 1/2 xi^T I xi
  rates,  ///< of b - A xi for each row, of I xi, where the variables change at the rates behind
          ///< them
};

/// Programs of a system, each recorded when it is first evaluated. Threads share it.
class FormulaPrograms {
 public:
  /// Variables of the formulas: coordinates, t, inputs, `dim` velocities.
  FormulaPrograms(DataFormulas formulas, size_t coordinates, size_t dim);
  const DataFormulas& formulas() const { return formulas_; }
  size_t variables() const { return coordinates_ + 1 + formulas_.inputs + dim_; }
  /// Code whose arguments are the variables, and of `rates` their rates too.
  const graph::Code& code(Evaluation e) const;

 private:
  struct Entry {
    std::once_flag once;
    std::optional<graph::Code> code;
  };
  graph::Code record(Evaluation e) const;

  DataFormulas formulas_;
  size_t coordinates_, dim_;
  mutable std::array<Entry, 8> codes_;
};

}  // namespace hamel
