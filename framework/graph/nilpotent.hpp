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
/// coefficients each, that of S at the sum of 2^i of its units. Every operation has its Taylor
/// series; a value is not finite where that has none.
class NilpotentEvaluation {
 public:
  /// The recording is complete, and lives longer.
  NilpotentEvaluation(const Recording& recording, std::vector<Number> outputs);

  /// Which inputs the outputs depend on.
  const std::vector<bool>& needs() const { return needs_; }
  /// inputs: those of the recording, 2^k coefficients each; those beyond are 0. noise: of that
  /// relative size, random, on the operands of each operation, which shows what round-off does
  /// (Vignes, Discrete stochastic arithmetic, Numerical Algorithms 37, 2004); 0: none. The result
  /// holds until the next call.
  const std::vector<double>& operator()(int units, std::span<const double> inputs,
                                        double noise = 0);
  /// A random number in [-1, 1).
  double random();

 private:
  void take(const Node& node, size_t slot, size_t size, std::span<const double> inputs);
  const double* shake(const double* x, double noise, std::vector<double>& out);

  const Recording* recording_;
  std::vector<Number> outputs_;
  std::vector<int> slots_;  // of the values of the nodes that the outputs need, else -1
  size_t slot_count_ = 0;
  std::vector<bool> needs_;
  std::vector<double> values_, results_;
  std::vector<bool> plain_;  // by slot: without nilpotent part
  std::uint32_t seed_ = 1;
};

/// out += a b, of 2^k coefficients each.
void add_product(int units, const double* a, const double* b, double* out);

}  // namespace hamel::graph
