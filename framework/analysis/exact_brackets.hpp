// Brackets of fields that are known as formulas, by exact derivatives at one place. For growth.cpp
// only, not installed.
//
// With nilpotent units e_i (graph/nilpotent.hpp) the flow of U by e is x + e U(x), and the field
// X_b carried back along the flows of U_1, ..., U_d,
//   V_b = sum over S of e_S ad_{U_i1} ... ad_{U_ij} X_b,   S = {i1 < ... < ij}:
// each coefficient is a bracket of j + 1 fields. It is found by carrying x_d + delta X_b(x_d), x_i
// = x_{i-1} + e_i U_i(x_{i-1}), back by y - e_i U_i(y); U_i are random combinations of the fields,
// which span the brackets of all. Round-off is what two evaluations with noise differ by.
#pragma once

#include <vector>

#include <hamel/framework/analysis/carried_fields.hpp>
#include <hamel/framework/graph/nilpotent.hpp>
#include <hamel/framework/graph/vector_fields.hpp>

namespace hamel::carried {

class ExactBrackets {
 public:
  /// fields: lives longer. At an element, in units of the n components: the fields are combined so
  /// that they are orthonormal there.
  ExactBrackets(const graph::VectorFields& fields, const Vector& g, const Vector& units);

  /// Are all operations of the formulas known, and their values finite?
  bool possible() const { return possible_; }
  /// At an element, entry j the brackets of j + 1 fields.
  std::vector<Generation> generations(const Vector& g, int depth);

 private:
  using Numbers = std::vector<double>;
  Matrix evaluate(graph::NilpotentEvaluation& evaluation, const Vector& g, Eigen::Index rows) const;
  void flow(const Vector& controls, int units, int unit, double sign, double noise, Numbers& x);
  std::vector<Matrix> brackets(const Vector& g, const std::vector<Vector>& controls, double noise);

  Eigen::Index n_, m_;
  graph::NilpotentEvaluation velocities_, moves_, rates_;
  Vector units_;
  Matrix combination_;  // of the columns of E
  bool possible_;
};

}  // namespace hamel::carried
