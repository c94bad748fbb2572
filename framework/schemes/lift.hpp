// lift: the paper's definition D^{D*} = (iota* x iota*) o D^{T*} o T pi*, read literally. It is the
// discrete Lagrange-d'Alembert scheme of L_d(g0, g1) = h L(g, xi/h).
//
// Unknown v = xi/h. At the base point g of the step, g1 its end (cotangent_lift.hpp),
//   p = I(g) v,   nu = h F(t + s h, g, v)
// give the momenta mu0 and mu1 at its ends. The step solves
//   E(g0)^T (mu0 - I(g0) xi_0) = 0,    A(g) v = b(t + s h, g),   phi(g1) = 0 in place of its rows,
// as F(r, c) of metric/metric.hpp at g0, and xi_1 is the admissible velocity of mu1 at g1.
//
// Forces at the nodes, (M43): nu = h d(v^T I(g) v)/2 only, and f - dV is taken at both ends with
// half of h,
//   E(g0)^T (mu0 - I(g0) xi_0 - h/2 F0) = 0,   mu1 + h/2 F1 in place of mu1,
//   F_i = (f - dV)(t_i, g_i, v).
// With a constant inertia nu = 0 then.
//
// On a left-invariant problem v = E y, nu = 0 and m unknowns remain: E^T mu0 = mu_bar_k,
// mu_bar_{k+1} = E^T mu1. At s = 0, at s = 1 for a symmetric tau, and at every s for a
// one-parameter tau (exp), mu0 = (dR_xi)^-T I xi/h. Source: Vivek, Martin de Diego, Banavar; Cortes
// and Martinez 2001; Fedorov and Zenkov 2005; Kobilarov 2010.
#pragma once

#include <hamel/framework/metric/held_rows.hpp>
#include <hamel/framework/schemes/cotangent_lift.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

struct Lift : SchemeDefaults {
  static std::string name() { return "lift"; }
  static std::string formula() {
    return "E'(dR_xi)^-T I xi/h = mu_k,  mu_{k+1} = E'(dL_xi)^-T I xi/h  (s = 0)";
  }
  static std::string source() { return "Vivek, Martin de Diego, Banavar: D^{D*}, read literally"; }
  static constexpr std::optional<double> fixed_s = std::nullopt;
  static constexpr StepChoice step_choice = StepChoice::symmetric;
  static constexpr bool reduced = true;
  /// Left-invariant: a symmetric tau gives order 2 for every s. The step is reversible at s = 1/2,
  /// and at s = 0 and 1 when tau is symmetric; between them only when tau(a xi) and tau(b xi)
  /// commute too (exp, Cayley, polar): tau_s(xi)^-1 = tau((1-s) xi)^-1 tau(-s xi) is tau_s(-xi)
  /// only then.
  static ClaimedOrder claim(double s, TauTraits tau, bool left_invariant) {
    const bool half = s == 0.5;
    if (!left_invariant) return {half ? 2 : 1, half};
    return {half || tau.symmetric ? 2 : 1,
            half || (tau.symmetric && (s == 0 || s == 1 || tau.commuting))};
  }

  template <class P>
  class General;
  template <class P>
  class Reduced;
  template <class P>
  using Step = std::conditional_t<P::left_invariant, Reduced<P>, General<P>>;
};

/// v in R^n.
template <class P>
class Lift::General {
 public:
  using Problem = P;
  using Unknown = typename P::State;
  using Jacobian = typename P::StateMatrix;
  using Node = hamel::Node<P>;
  using Vector = typename P::Vector;

  General(const P& problem, double s, ForceAt force_at = ForceAt::nodes)
      : problem_(problem),
        s_(s),
        nodal_(force_at == ForceAt::nodes),
        lift_(problem, s, /*impulse=*/!nodal_ || !problem.constant_inertia()) {}

  int size() const { return problem_.dim(); }
  /// Is the element at the end to be normalised? It is before the place there is found.
  void normalise_when(bool due) { normalises_ = due; }
  /// The forces may have changed.
  void clear_history() { place_time_ = kNothing; }
  void begin(const Node& node, double h) {
    from_ = &node;
    h_ = h;
    v_.setConstant(kNothing);
    if (!(place_time_ == node.t &&
          problem_.same(place_g_, node.g))) {  // else the last step ended there
      place_.set(problem_, node.t, node.g);
      place_time_ = node.t;
      place_g_ = node.g;
      apply(node.t, node.g, node.x);
    }
    place_.momentum(node.x, target_);
    // |mu0| + |I xi/h| + |h force| as square roots of an energy; at rest without force those of
    // unit velocities.
    const double size = 2 * place_.size(target_) + std::abs(h) * place_.size(force_);
    scale_squared_ = size > 0 ? size * size : problem_.dim();
    if (nodal_) {
      nu_.setZero();
      if (!problem_.force_depends_on_velocity()) target_ += (h / 2) * force_;
    }
  }
  void guess(Unknown& x) const { x = from_->x; }
  double scale_squared() const { return scale_squared_; }
  /// A row phi(g1) moves by h times a velocity.
  void expand(Unknown& z) const { place_.expand(z, h_, problem_.holonomic_rows()); }

  HAMEL_FLATTEN void residual(const Unknown& x, Unknown& f) const {
    evaluate(x);
    place_.assemble(mu_, rows_, f);
  }

  /// F but for what the round-off of a configuration does to its rows.
  void residual_of_places(const Unknown& x, Unknown& f) const
      requires(P::HolonomicValues::SizeAtCompileTime != 0) {
    evaluate(x);
    drop_round_off(place_.a, phi_, rows_);
    place_.assemble(mu_, rows_, f);
  }

  bool finish(const Unknown& x, Node& next) const {
    if ((v_.array() != x.array()).any()) evaluate_again(x);
    if (!problem_.in_domain(step_)) return false;
    lift_.find_end(problem_, nu_, mu_);
    next.t = from_->t + h_;
    if (normalises_) problem_.normalise(lift_.end());
    next.g = lift_.end();
    apply(next.t, next.g, v_);
    if (nodal_) mu_ += (h_ / 2) * force_;
    place_.set(problem_, next.t, next.g);
    place_time_ = next.t;
    place_g_ = next.g;
    place_.admissible(mu_, next.x);
    return true;
  }

 private:
  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();  // evaluated so far

  // Out of line: finish stays half as long.
  [[gnu::noinline, gnu::cold]] void evaluate_again(const Unknown& x) const { evaluate(x); }
  // mu0 - I(g0) xi_0, nu and the rows at v = x.
  void evaluate(const Unknown& x) const {
    v_ = x;
    step_ = h_ * v_;
    lift_.place(problem_, from_->g, step_);
    const double t = from_->t + s_ * h_;
    if (problem_.constant_inertia()) place_.momentum(v_, p_);
    else problem_.momentum_at(lift_.base(), v_, p_, nu_);  // nu_: d(v^T I(g) v)/2
    if (!nodal_) problem_.force(t, lift_.base(), v_, nu_);
    if (!nodal_ || !problem_.constant_inertia()) nu_ *= h_;
    lift_.find_start(problem_, step_, p_, nu_, mu_);
    mu_ -= target_;
    if (rows_.size() > 0) {
      problem_.constraint_values(t, lift_.base(), v_, rows_);
      if (phi_.size() > 0) {  // in metres: a velocity error would show as h times itself
        problem_.holonomic(lift_.end(), phi_);
        rows_.tail(phi_.size()) = phi_;
      }
    }
    if (nodal_ && problem_.force_depends_on_velocity()) {
      apply(from_->t, from_->g, v_);
      mu_ -= (h_ / 2) * force_;
    }
  }
  // force_: f - dV with the velocity v; at the base point the whole F serves as its size.
  void apply(double t, const typename P::Element& g, const Vector& v) const {
    if (nodal_) problem_.applied_force(t, g, v, force_);
    else problem_.force(t, g, v, force_);
  }

  P problem_;
  double s_;
  bool nodal_, normalises_ = false;
  const Node* from_ = nullptr;
  double h_ = 0, scale_squared_ = 0;
  Vector target_ = P::Vector::Zero(problem_.dim());
  // Work: the place at place_g_ (g0, and g1 once finished), and what the last x determined.
  // Allocated once.
  mutable CotangentLift<P> lift_;
  mutable typename P::Metric place_{problem_};
  mutable typename P::Element place_g_ = problem_.element();
  mutable double place_time_ = kNothing;
  mutable Vector v_ = target_, step_ = v_, p_ = v_, nu_ = v_, mu_ = v_, force_ = v_;
  mutable typename P::Multipliers rows_ = P::Multipliers::Zero(problem_.constraint_count());
  mutable typename P::HolonomicValues phi_{problem_.holonomic_rows()};
};

}  // namespace hamel

#include <hamel/framework/schemes/lift_reduced.hpp>
