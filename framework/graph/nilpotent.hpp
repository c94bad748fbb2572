// Formulas at numbers with nilpotent units: exact mixed derivatives of every order.
//
// x = sum over the subsets S of k units e_1 ... e_k of x_S e_S, e_i e_i = 0: the coefficient of e_S
// of f(x + sum e_i v_i) is the derivative of f along all v_i, i in S. Products take 3^k
// multiplications, functions their Taylor series, which ends with the k-th power of the nilpotent
// part. Source: Griewank, Walther, Evaluating Derivatives (2008), ch. 13 (there: multivariate
// Taylor numbers).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <hamel/framework/graph/number.hpp>

namespace hamel::graph {

/// Values of outputs of a recording at numbers with k units, laid out number by number, 2^k
/// coefficients each, that of S at the sum of 2^i of its units.
class NilpotentEvaluation {
 public:
  /// The recording is complete.
  NilpotentEvaluation(const Recording& recording, const std::vector<Number>& outputs);

  /// Are all operations among those that it knows: + - * /, minimum, maximum, absolute value, root,
  /// rounding, selections, exp, log, sine and cosine?
  bool possible() const { return possible_; }
  /// inputs: those of the recording, 2^k coefficients each; those beyond are 0. noise: of that
  /// relative size, random, on the operands of each operation, which shows what round-off does
  /// (Vignes, Discrete stochastic arithmetic, Numerical Algorithms 37, 2004); 0: none.
  std::vector<double> operator()(int units, std::span<const double> inputs, double noise = 0);

 private:
  const Recording& recording_;
  const std::vector<Number>& outputs_;
  std::vector<int> slots_;  // of the values of the nodes that the outputs need, else -1
  size_t slot_count_ = 0;
  std::vector<double> values_;
  std::uint32_t seed_ = 1;
  bool possible_ = true;
};

/// out += a b, of 2^k coefficients each.
void add_product(int units, const double* a, const double* b, double* out);

}  // namespace hamel::graph
