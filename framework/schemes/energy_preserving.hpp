// energy_preserving: a discrete-gradient step for left-invariant systems.
//
//   I (xi_1 - xi_0) = h ad*_W I W + A^T lambda,   W = (xi_0 + xi_1)/2,
//   A xi_1 = 0,   g_1 = g_0 tau(h W).
// Paired with W: <ad*_W I W, W> = 0 and A W = 0, so that 1/2 xi^T I xi is kept to round-off.
// Order 2. Weakness: the energy is all that is kept; the trajectory has the error of any method of
// order 2. Source: Celledoni, Farre Puiggali, Hoiseth, Martin de Diego, Energy-preserving
// integrators applied to nonholonomic systems, J. Nonlinear Sci. 29 (2019).
#pragma once

#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

struct EnergyPreserving : SchemeDefaults {
  static std::string name() { return "energy_preserving"; }
  static std::string formula() {
    return "I (xi_1 - xi_0) = h ad*_W I W + A' lambda,  W = (xi_0 + xi_1)/2,  g_1 = g_0 tau(h W)";
  }
  static std::string source() { return "Celledoni, Farre Puiggali, Hoiseth, Martin de Diego 2019"; }
  static constexpr bool left_invariant_only = true;
  static constexpr bool reduced = true;
  static ClaimedOrder claim(double /*s*/, TauTraits tau, bool /*left_invariant*/) {
    return {tau.symmetric ? 2 : 1, tau.symmetric};
  }

  template <class P>
  class Step;
};

template <class P>
class EnergyPreserving::Step {
  using Vector = typename P::Vector;

 public:
  using Problem = P;
  using Unknown = typename P::State;
  using Jacobian = typename P::StateMatrix;
  using Node = hamel::Node<P>;

  Step(const P& problem, double /*s*/) : problem_(problem) {}

  int size() const { return problem_.state_size(); }
  void begin(const Node& node, double h) {
    from_ = &node;
    h_ = h;
    place_.set(problem_, node.t, node.g);
    if constexpr (!P::left_invariant) problem_.constraints(node.t, node.g, a_, b_);
    problem_.momentum(place_.inertia, node.x, mu_);
    const double size = 2 * place_.size(node.x, mu_);
    scale_squared_ = size * size;
  }
  void guess(Unknown& x) const { x = from_->x; }
  double scale_squared() const { return scale_squared_; }
  void expand(Unknown& z) const requires(!P::left_invariant) { place_.expand(z); }

  void residual(const Unknown& x, Unknown& f) const {
    mean_ = 0.5 * (from_->x + x);
    problem_.velocity(mean_, w_);
    problem_.momentum(place_.inertia, mean_, mu_);
    problem_.ad_transpose(w_, mu_, r_);
    r_ *= -h_;
    mean_ = x - from_->x;
    problem_.momentum(place_.inertia, mean_, mu_);
    r_ += mu_;
    if constexpr (!P::left_invariant) multiply(a_, x, rows_);
    place_.assemble(r_, rows_, f);
  }
  bool finish(const Unknown& x, Node& next) const {
    mean_ = (0.5 * h_) * (from_->x + x);
    problem_.velocity(mean_, w_);
    if (!problem_.in_domain(w_)) return false;
    problem_.tau(w_, f_);
    next.t = from_->t + h_;
    problem_.compose(from_->g, f_, next.g);
    next.x = x;
    return true;
  }

 private:
  P problem_;
  double h_ = 0, scale_squared_ = 0;
  const Node* from_ = nullptr;
  mutable typename P::Metric place_{problem_};
  mutable Unknown mean_ = P::State::Zero(problem_.state_size());
  mutable Vector w_ = P::Vector::Zero(problem_.dim()), mu_ = w_, r_ = w_;
  typename P::ConstraintMatrix a_{problem_.constraint_count(), problem_.dim()};
  typename P::Multipliers b_{problem_.constraint_count()};
  mutable typename P::Multipliers rows_ = b_;
  mutable typename P::Element f_ = problem_.element();
};

}  // namespace hamel
