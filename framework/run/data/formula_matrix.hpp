// Matrices and vectors of a system by data, whose entries are numbers and formulas. Not installed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/io/expression.hpp>

namespace hamel {

/// A matrix of numbers and formulas.
struct FormulaMatrix {
  struct Entry {
    Eigen::Index row, column;
    Expression value;
    std::string text, where;  // "system.toml:4:9: potential"
  };
  Eigen::MatrixXd constant;  // 0 where there is a formula
  std::vector<Entry> entries;

  bool is_constant() const { return entries.empty(); }
  bool is_zero() const { return is_constant() && constant.isZero(0); }
  bool uses(size_t first, size_t last) const;  // variables first <= i < last
  /// out = the matrix with these values of its entries.
  template <class Out>
  void fill(const double* of_entries, Out&& out) const {
    for (Eigen::Index j = 0; j < constant.cols(); ++j)
      for (Eigen::Index i = 0; i < constant.rows(); ++i) out(i, j) = constant(i, j);
    for (const Entry& e : entries) out(e.row, e.column) = *of_entries++;
  }
};

/// The formulas of a system. Their variables, in this order: coordinates, t, inputs, rates.
struct DataFormulas {
  FormulaMatrix inertia, rows, drift, holonomic, potential, force;
  /// Rates of scalar states, linear in velocities: z' - f(g, z, t, u, xi) = 0 are rows behind
  /// `rows`, and the last coordinates and velocities are z and z'. They have no inertia and no
  /// force, so that the multipliers of these rows are 0.
  FormulaMatrix states;
  size_t inputs = 0;

  Eigen::Index own_rows() const { return rows.constant.rows() + states.constant.rows(); }
  bool left_invariant() const;
};

}  // namespace hamel
