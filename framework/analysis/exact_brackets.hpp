// Brackets of the fields that rows admit, by exact derivatives of the rows at one place. For
// growth.cpp only, not installed.
//
// Fields near a place: with A N = 1 and A E = 0 there, columns of E orthonormal, in own units,
//   X_a = E_a - N (A N)^-1 A E_a,   X_0 = d/dt + N (A N)^-1 b,
// A the rows at the numbers x on which they depend, which move at T(x) xi. With nilpotent units e_i
// (graph/nilpotent.hpp) the flow of U by e is x + e T U, and a field V carried back along it is, in
// left trivialisation,
//   V + e [U, V],   [U, V] = (V along U) - (U along V) + ad_U V,
// of which the first term is that V is taken at the end of the flow. So the fields at the end of
// the flows of U_1, ..., U_d, carried back by V += e_i K_i V, K_i = ad_{U_i} - (dU_i) T at the
// start of each, are
//   V_b = sum over S of e_S ad_{U_i1} ... ad_{U_ij} X_b,   S = {i1 < ... < ij}:
// each coefficient is a bracket of j + 1 fields. K_i has the units of the flows before it only. U_i
// are random combinations of the fields, which span the brackets of all. Round-off is what two
// evaluations with noise differ by.
#pragma once

#include <optional>
#include <vector>

#include <hamel/framework/analysis/carried_fields.hpp>
#include <hamel/framework/graph/nilpotent.hpp>
#include <hamel/framework/graph/row_fields.hpp>
#include <hamel/framework/lie/geometry.hpp>

namespace hamel::carried {

class ExactBrackets {
 public:
  /// with_drift: X_0 is the first field, and time the last component. units: of the n components.
  ExactBrackets(graph::RowFields rows, const Geometry& geometry, const Vector& units,
                bool with_drift);

  /// At an element and a time, entry j the brackets of j + 1 fields; empty where the rows depend on
  /// each other or have derivatives that are not finite.
  std::vector<Generation> generations(const Vector& g, double t, int depth);
  /// The length over which the fields are smooth there, 1 at most, by the brackets found last.
  double length() const { return length_; }

 private:
  using Numbers = std::vector<double>;
  // Matrix of numbers with so many units, column by column.
  struct Block {
    Block(Eigen::Index height, Eigen::Index width, int of)
        : rows(height),
          columns(width),
          units(of),
          values(size() * static_cast<size_t>(height * width)) {}
    size_t size() const { return size_t{1} << units; }
    double* operator()(Eigen::Index i, Eigen::Index j) {
      return values.data() + static_cast<size_t>(j * rows + i) * size();
    }
    const double* operator()(Eigen::Index i, Eigen::Index j) const {
      return values.data() + static_cast<size_t>(j * rows + i) * size();
    }
    Eigen::Index rows, columns;
    int units;
    Numbers values;
  };
  // Entry of ad: (ad_x y)_to += value x_x y_y.
  struct Structure {
    Eigen::Index to, x, y;
    double value;
  };
  // Rows, drift and moves at numbers, and their derivatives by one of them.
  struct Evaluated {
    Block a, b, t;
  };

  void find_numbers();
  bool find_frame();
  Block numbers() const;
  bool is_time(Eigen::Index number) const {
    return drift_ == 1 && static_cast<int>(numbers_[static_cast<size_t>(number)]) == formulas_.time;
  }
  Evaluated evaluate(const Block& x, Eigen::Index by);
  void shake(Block& block);
  void solve(const Block& a, Block& rhs) const;
  Block fields_at(const Evaluated& at) const;
  Block transport(const Block& x, const Evaluated& at, const Block& u);
  Block flow(const Block& x, const Evaluated& at, const Block& u) const;
  void carry_back(const Block& k, Block& v) const;
  std::vector<Matrix> brackets(const std::vector<Vector>& controls, double noise);
  bool scale_by_length(std::vector<Generation>& generations, std::vector<Matrix>& noise);

  graph::RowFields formulas_;
  Vector units_;
  Eigen::Index n_, k_, drift_;
  std::vector<Structure> structure_;
  std::vector<size_t> numbers_;  // the inputs on which the rows depend, in the end
  std::optional<graph::NilpotentEvaluation> evaluation_;
  std::vector<double> at_;  // values of all inputs
  Vector sizes_;            // of the rows there
  Matrix e_, right_;        // E and N
  double noise_ = 0, length_ = 1;
};

}  // namespace hamel::carried
