// balance: the paper's printed inverse map with barred momenta, both equations balanced on d at the
// base point.
//
// The nodal momenta are embedded, mu_i = I(g_i) xi_i. Unknowns v = xi/h and w = xi_1. With z0 = -s
// xi, z1 = (1-s) xi, f_i = tau(z_i), base point g = g0 f0^-1, g1 = g f1, m_i = Ad*_{f_i^-1} mu_i,
// nu = h force(t + s h, g, v), both equations of the cotangent lift are balanced on d at g:
//   E(g)^T ( I(g) v - s dR_{z0}^T m0 - (1-s) dR_{z1}^T m1 ) = 0,   A(g) v = b(t + s h, g),
//   E(g)^T ( m1 - m0 - nu ) = 0,                                   A(g1) w = b(t + h, g1),
// with phi(g1) = 0 in place of its rows of A(g) v = b. Each line is one F(r, c) of
// metric/metric.hpp at g. On a left-invariant problem v = E y and w = E y1: 2 m unknowns, no rows.
// Derivatives: (c) and (d) of lie/trivialised.hpp.
#pragma once

#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/lie/trivialised.hpp>
#include <hamel/framework/metric/held_rows.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

/// ends_only: (1) in full, the velocity of the step is admissible at the ends only
/// (reversible.hpp).
template <class P, bool ends_only>
class BalanceStep {
  using Vector = typename P::Vector;
  using Element = typename P::Element;
  static_assert(!(ends_only && P::left_invariant), "v is not in d: take the erased problem");

 public:
  using Problem = P;
  using Unknown = typename P::TwoStates;
  using Jacobian = typename P::TwoStatesMatrix;
  using Node = hamel::Node<P>;

  BalanceStep(const P& problem, double s) : problem_(problem), s_(s) {}

  int size() const { return 2 * problem_.state_size(); }
  void begin(const Node& node, double h) {
    from_ = &node;
    h_ = h;
    x_.setConstant(std::numeric_limits<double>::quiet_NaN());  // nothing is evaluated so far
    place_.set(problem_, node.t, node.g);
    inertia_ = place_.inertia;
    problem_.momentum(inertia_, node.x, mu0_);
    double size = 2 * place_.size(node.x, mu0_);
    if constexpr (P::left_invariant) {
      scale_squared_ = size * size;
    } else {
      problem_.force(node.t, node.g, node.x, nu_);
      size += std::abs(h) * place_.size(nu_);
      scale_squared_ = size > 0 ? size * size : problem_.dim();
    }
  }
  void guess(Unknown& x) const {
    x.resize(size());
    x.head(half()) = from_->x;
    x.tail(half()) = from_->x;
  }
  double scale_squared() const { return scale_squared_; }
  /// dF/d(v, w) = [1, -(1-s) (1 - Y (Y^T Y)^-1 Y^T); 0, 1] + O(h) in the coordinates of
  /// metric/metric.hpp, solved for (v, w). Rows phi(g1): h times as much.
  void expand(Unknown& z) const requires(!P::left_invariant) {
    f_ = r_ = z.tail(half());
    if constexpr (!ends_only) place_.drop_reaction(r_);
    place_.expand(f_);
    z.tail(half()) = f_;
    f_ = z.head(half()) + (1 - s_) * r_;
    place_.expand(f_, h_, ends_only ? 0 : problem_.holonomic_rows());
    z.head(half()) = f_;
  }

  /// F but for what the round-off of a configuration does to its rows.
  void residual_of_places(const Unknown& x, Unknown& f) const
      requires(P::HolonomicValues::SizeAtCompileTime != 0) {
    evaluate(x);
    drop_round_off(place_.a, phi_, rows_);
    assemble(f);
  }

  void residual(const Unknown& x, Unknown& f) const {
    evaluate(x);
    assemble(f);
  }

  /// F and its derivative in (y, y1).
  [[gnu::noinline, gnu::cold]] void linearise(const Unknown& x, Unknown& f,
                                              Jacobian& j) const requires HasJacobians<P> {
    using Tau = typename P::Tau;
    using G = typename P::Group;
    using Matrix = typename P::Matrix;
    residual(x, f);
    constexpr int m = P::m;
    const At<Tau> z0(z0_), z1(z1_);
    const Matrix push1 = G::Ad(G::inverse(z1.f)).transpose();
    j.template topLeftCorner<m, m>() =
        h_ * problem_.reduce_both(s_ * s_ * z0.left_transpose_derivative(m0_) -
                                  (1 - s_) * (1 - s_) * z1.left_transpose_derivative(m1_));
    j.template topLeftCorner<m, m>().diagonal().array() += 1;
    j.template topRightCorner<m, m>() =
        (s_ - 1) * problem_.reduce_momentum(z1.right.transpose() * push1);
    j.template bottomLeftCorner<m, m>() =
        h_ *
        problem_.reduce_both((1 - s_) * z1.push_derivative(m1_) + s_ * z0.push_derivative(m0_));
    j.template bottomRightCorner<m, m>() = problem_.reduce_momentum(push1);
  }

  bool finish(const Unknown& x, Node& next) const {
    if ((x_.array() != x.head(half()).array()).any() ||
        (w_.array() != x.tail(half()).array()).any()) {
      evaluate(x);
    }
    r_ = h_ * v_;
    if (!problem_.in_domain(r_)) return false;
    next.t = from_->t + h_;
    if constexpr (P::left_invariant) compose_ends();
    next.g = g1_;
    next.x = w_;
    return true;
  }

 private:
  // States, of a size known at compile time where it is.
  auto half() const {
    constexpr int size = P::State::RowsAtCompileTime;
    if constexpr (size == Eigen::Dynamic) return problem_.state_size();
    else return Eigen::fix<size>;
  }
  // The base point and g1; f0 and f1 hold the inverses.
  void compose_ends() const {
    problem_.compose(from_->g, f0_, base_);
    problem_.inverse(f1_, g1_);
    problem_.compose(base_, g1_, g1_);
  }
  // F at the last x.
  void assemble(Unknown& f) const {
    // (1) on the base point.
    problem_.momentum(place_.inertia, x_, r_);
    problem_.dtau_right_transpose(z0_, m0_, mu_);
    r_ -= s_ * mu_;
    problem_.dtau_right_transpose(z1_, m1_, mu_);
    r_ -= (1 - s_) * mu_;
    if constexpr (ends_only) {
      place_.weigh(r_);
      f.head(half()) = r_;
    } else {
      place_.assemble(r_, rows_, f_);
      f.head(half()) = f_;
    }
    // (2).
    r_ = m1_ - m0_;
    if constexpr (!P::left_invariant) r_ -= h_ * nu_;
    place_.assemble(r_, end_rows_, f_);
    f.tail(half()) = f_;
  }
  // m0, m1, nu and the rows at x.
  void evaluate(const Unknown& x) const {
    x_ = x.head(half());
    w_ = x.tail(half());
    problem_.velocity(x_, v_);
    z0_ = (-s_ * h_) * v_;
    z1_ = ((1 - s_) * h_) * v_;
    problem_.tau(z0_, f0_);
    problem_.tau(z1_, f1_);
    problem_.inverse(f0_, f0_);
    problem_.inverse(f1_, f1_);
    if constexpr (!P::left_invariant) {
      compose_ends();
      place_.set(problem_, from_->t + s_ * h_, base_, true);
      if (problem_.constant_inertia()) inertia_ = place_.inertia;
      else problem_.inertia(g1_, inertia_);
    }
    problem_.momentum(inertia_, w_, mu_);
    problem_.Ad_transpose(f1_, mu_, m1_);
    problem_.Ad_transpose(f0_, mu0_, m0_);
    if constexpr (!P::left_invariant) {
      problem_.force(from_->t + s_ * h_, base_, v_, nu_);
      if (rows_.size() == 0) return;
      multiply(place_.a, v_, rows_);
      rows_ -= place_.b;
      if (phi_.size() > 0) {
        problem_.holonomic(g1_, phi_);
        rows_.tail(phi_.size()) = phi_;
      }
      problem_.constraints(from_->t + h_, g1_, a_, b_);
      multiply(a_, w_, end_rows_);
      end_rows_ -= b_;
    }
  }

  P problem_;
  double s_, h_ = 0, scale_squared_ = 0;
  const Node* from_ = nullptr;
  Vector mu0_ = P::Vector::Zero(problem_.dim());
  // Work: the place at the base point, and what the last x determined. Allocated once.
  mutable typename P::Metric place_{problem_};
  mutable Element f0_ = problem_.element(), f1_ = f0_, base_ = f0_, g1_ = f0_;
  mutable Vector v_ = mu0_, z0_ = v_, z1_ = v_, nu_ = v_, m0_ = v_, m1_ = v_, mu_ = v_, r_ = v_;
  mutable typename P::State x_ = P::State::Zero(problem_.state_size()), w_ = x_, f_ = x_;
  mutable typename P::Matrix inertia_{problem_.dim(), problem_.dim()};
  mutable typename P::ConstraintMatrix a_{problem_.constraint_count(), problem_.dim()};
  mutable typename P::Multipliers b_{problem_.constraint_count()}, rows_ = b_, end_rows_ = b_;
  mutable typename P::HolonomicValues phi_{problem_.holonomic_rows()};
};

struct Balance : SchemeDefaults {
  static std::string name() { return "balance"; }
  static std::string formula() {
    return "E'(s dL_{-s xi}' mu_k + (1-s) dL_{(1-s)xi}' mu_{k+1} - I xi/h) = 0,  "
           "E'(Ad*_{f1^-1} mu_{k+1} - Ad*_{f0^-1} mu_k) = 0";
  }
  static std::string source() {
    return "Vivek, Martin de Diego, Banavar: the printed inverse map, both equations on d";
  }
  static constexpr std::optional<double> fixed_s = std::nullopt;
  static constexpr StepChoice step_choice = StepChoice::symmetric;
  static constexpr bool reduced = true;
  static ClaimedOrder claim(double s, TauTraits /*tau*/, bool /*left_invariant*/) {
    return {s == 0.5 ? 2 : 1, s == 0.5};
  }
  template <class P>
  using Step = BalanceStep<P, false>;
};

}  // namespace hamel
