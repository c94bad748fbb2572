// The equations of motion in a frame that a system states, (M6).
//
// A system whose rows determine the last k velocities from the first m, v = B(g) y, states
//   frame(g)            B, k x m, a template on the element: xi = E(g) y, E = [1; B], A E = 0
//   frame_rate(g, xi)   B' along g tau(e xi); left out: by one dual number
// With p = I(g) xi, M = E^T I E, F = f - dV + 1/2 d(xi^T I(g) xi) and ' the rate along the motion,
//   y' = M^-1 E^T (ad*_xi p + F - I' xi - I (0, B' y)).
// No multiplier and no projection: xi is admissible by construction.
#pragma once

#include <hamel/framework/mechanics/formulas.hpp>
#include <hamel/framework/mechanics/small_factors.hpp>

namespace hamel {

/// F: the Formulas of a system that states a frame. Its constant inertia is taken once.
template <class F>
class FramedEquations {
 public:
  using G = typename F::G;
  using Element = typename F::Element;
  static constexpr int n = F::n, k = F::k, m = n - k;

  explicit FramedEquations(const F& formulas) {
    if constexpr (F::constant_inertia()) formulas.inertia(G::template identity<double>(), inertia_);
    else inertia_.setOnes();
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) {
        if (inertia_(i, j) == 0) continue;
        (i < m ? dense_ : j < m ? coupled_ : dependent_) = true;
      }
    }
  }

  /// xi = E(g) y, y the first m entries of x.
  static void expand(const F& formulas, const Element& g, const Vec<n>& x, Vec<n>& xi) {
    assemble(formulas.frame(g), x, xi);
  }
  /// The same, and xi' = (y', B y' + B' y).
  HAMEL_FLATTEN [[gnu::noinline]] void operator()(const F& formulas, double t, const Element& g,
                                                  const Vec<n>& x, Vec<n>& to_xi,
                                                  Vec<n>& to_rate) const {
    const Mat<k, m> b = formulas.frame(g);
    Vec<n> xi, change, rate;
    assemble(b, x, xi);
    formulas.force(t, g, xi, change);
    const Vec<k> turn = formulas.frame_turn(g, xi);
    if constexpr (F::constant_inertia()) {
      reduce(inertia_, b, xi, turn, change, rate);
    } else {
      Mat<n, n> inertia;
      Vec<n> momentum_rate;
      formulas.inertia_rate(element_along<typename F::Dual, G>(g, xi), xi, inertia, momentum_rate);
      change -= momentum_rate;
      reduce(inertia, b, xi, turn, change, rate);
    }
    to_xi = xi;
    assemble(b, rate, to_rate);
    to_rate.template tail<k>() += turn;
  }

 private:
  // (y, B y), y the first entries of x.
  static void assemble(const Mat<k, m>& b, const Vec<n>& x, Vec<n>& xi) {
#pragma GCC unroll 4
    for (int i = 0; i < m; ++i) xi[i] = x[i];
#pragma GCC unroll 4
    for (int i = 0; i < k; ++i) {
      xi[m + i] = b(i, 0) * x[0];
#pragma GCC unroll 4
      for (int j = 1; j < m; ++j) xi[m + i] += b(i, j) * x[j];
    }
  }
  // The first of rate = M^-1 E^T (ad*_xi I xi + change - I (0, turn)).
  void reduce(const Mat<n, n>& inertia, const Mat<k, m>& b, const Vec<n>& xi, const Vec<k>& turn,
              Vec<n>& change, Vec<n>& to_rate) const {
    Mat<m, m> reduced;
    Mat<k, m> c;  // the last k rows of I E
    Vec<n> momentum, transported;
    Vec<m> rate;
#pragma GCC unroll 4
    for (int i = 0; i < k; ++i) {
      momentum[m + i] = inertia(m + i, m + i) * xi[m + i];
      change[m + i] -= inertia(m + i, m + i) * turn[i];
#pragma GCC unroll 4
      for (int j = 0; j < m; ++j) c(i, j) = inertia(m + i, m + i) * b(i, j);
    }
#pragma GCC unroll 4
    for (int j = 0; j < m; ++j) {
      momentum[j] = inertia(j, j) * xi[j];
#pragma GCC unroll 4
      for (int i = j; i < m; ++i) reduced(i, j) = i == j ? inertia(i, i) : 0;
    }
    if (dense_) couple<0, 0, m>(inertia, xi, momentum);
    if (dense_)
      reduced.template triangularView<Eigen::StrictlyLower>() =
          inertia.template topLeftCorner<m, m>();
    if (coupled_ || dependent_) add_blocks(inertia, b, xi, turn, momentum, change, c, reduced);
#pragma GCC unroll 4
    for (int j = 0; j < m; ++j) {
#pragma GCC unroll 4
      for (int i = j; i < m; ++i) {
#pragma GCC unroll 4
        for (int l = 0; l < k; ++l) reduced(i, j) += b(l, i) * c(l, j);
      }
    }
    GroupOperations<typename FirstOf<typename G::Retractions>::type>::ad_transpose(xi, momentum,
                                                                                   transported);
    change += transported;
#pragma GCC unroll 4
    for (int j = 0; j < m; ++j) {
      rate[j] = change[j];
#pragma GCC unroll 4
      for (int i = 0; i < k; ++i) rate[j] += b(i, j) * change[m + i];
    }
    factor_small(reduced);
    solve_small(reduced, rate);
    to_rate.template head<m>() = rate;
  }
  // out_i += I_ij x_j off the diagonal, of the rows from `row` on.
  template <int row, int column, int size>
  static void couple(const Mat<n, n>& inertia, const Vec<n>& x, Vec<n>& out) {
#pragma GCC unroll 4
    for (int i = 0; i < size; ++i) {
#pragma GCC unroll 4
      for (int j = 0; j < size; ++j) {
        if (i != j) out[row + i] += inertia(row + i, column + j) * x[column + j];
      }
    }
  }
  // What the blocks of I between the two kinds of velocities, and off the diagonal among the
  // dependent ones, add.
  static void add_blocks(const Mat<n, n>& inertia, const Mat<k, m>& b, const Vec<n>& xi,
                         const Vec<k>& turn, Vec<n>& momentum, Vec<n>& change, Mat<k, m>& c,
                         Mat<m, m>& reduced) {
    const auto coupling = inertia.template bottomLeftCorner<k, m>();
    Mat<k, k> dependent = inertia.template bottomRightCorner<k, k>();
    dependent.diagonal().setZero();
    const Vec<k> v = xi.template tail<k>();
    momentum.template head<m>() += coupling.transpose().lazyProduct(v);
    momentum.template tail<k>() +=
        coupling.lazyProduct(xi.template head<m>()) + dependent.lazyProduct(v);
    change.template head<m>() -= coupling.transpose().lazyProduct(turn);
    change.template tail<k>() -= dependent.lazyProduct(turn);
    reduced += coupling.transpose().lazyProduct(b);
    c += coupling + dependent.lazyProduct(b);
  }

  Mat<n, n> inertia_;
  // Off the diagonal of I: among the first m, between them and the last k, among these.
  bool dense_ = false, coupled_ = false, dependent_ = false;
};

}  // namespace hamel
