// boxed: the paper's boxed formulas with their slips repaired; left-invariant systems only.
//
// s = 0 and nu = 0 in the cotangent lift, the known momentum barred, mu_k = I xi_k; the unknown is
// v = xi/h:
//   E^T ( (dR_{hv})^T mu_k - I v ) = 0,   A v = 0,
//   xi_{k+1} the admissible velocity of Ad_{tau(hv)}^T mu_k,   g_{k+1} = g_k tau(hv).
// The part that Ad^T carries out of d* is dropped, and with it order 2: the scheme has order 1.
#pragma once

#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/lie/trivialised.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

/// literal: boxed_literal.hpp, where h cancels.
template <class P, bool literal>
class BoxedStep {
  using Vector = typename P::Vector;

 public:
  using Problem = P;
  using Unknown = typename P::State;
  using Jacobian = typename P::StateMatrix;
  using Node = hamel::Node<P>;

  BoxedStep(const P& problem, double /*s*/) : problem_(problem) {
    if constexpr (literal) embed();
  }

  int size() const { return problem_.state_size(); }
  void begin(const Node& node, double h) {
    from_ = &node;
    h_ = h;
    place_.set(problem_, node.t, node.g);
    problem_.momentum(place_.inertia, node.x, mu_);
    if constexpr (literal) full_mu_ = embedding_.lazyProduct(mu_);
    else full_mu_ = mu_;
    if constexpr (!P::left_invariant) problem_.constraints(node.t, node.g, a_, b_);
    const double size = 2 * place_.size(node.x, mu_);
    scale_squared_ = size * size;
  }
  void guess(Unknown& x) const { x = from_->x; }
  double scale_squared() const { return scale_squared_; }
  void expand(Unknown& z) const requires(!P::left_invariant) { place_.expand(z); }

  void residual(const Unknown& x, Unknown& f) const {
    set_step(x);
    problem_.dtau_right_transpose(z_, full_mu_, r_);
    problem_.momentum(place_.inertia, x, mu_);
    r_ -= mu_;
    if constexpr (!P::left_invariant) multiply(a_, v_, rows_);
    place_.assemble(r_, rows_, f);
  }

  /// F and dF/dy.
  [[gnu::noinline, gnu::cold]] void linearise(const Unknown& y, Unknown& f,
                                              Jacobian& j) const requires HasJacobians<P> {
    residual(y, f);
    j = length() *
        problem_.reduce_both(At<typename P::Tau>(z_).right_transpose_derivative(full_mu_));
    j.diagonal().array() -= 1;
  }

  bool finish(const Unknown& x, Node& next) const {
    set_step(x);
    if (!problem_.in_domain(z_)) return false;
    problem_.tau(z_, f_);
    next.t = from_->t + h_;
    problem_.compose(from_->g, f_, next.g);
    if constexpr (literal) problem_.inverse(f_, f_);  // the sign of the inverse
    problem_.Ad_transpose(f_, full_mu_, r_);
    place_.admissible(r_, next.x);
    return true;
  }

 private:
  double length() const { return literal ? 1.0 : h_; }
  void set_step(const Unknown& x) const {
    problem_.velocity(x, v_);
    z_ = length() * v_;
  }
  // 1 - A^T (A A^T)^-1 A: the covector without a part along the Euclidean complement of d.
  void embed() {
    const Node start(problem_);
    problem_.constraints(0, start.g, a_, b_);
    const Eigen::MatrixXd a = a_;
    const Eigen::MatrixXd gram = a * a.transpose();
    embedding_.setIdentity();
    if (a.rows() > 0) embedding_ -= a.transpose() * gram.inverse() * a;
  }

  P problem_;
  double h_ = 0, scale_squared_ = 0;
  const Node* from_ = nullptr;
  Vector full_mu_ = P::Vector::Zero(problem_.dim());
  typename P::Matrix embedding_{problem_.dim(), problem_.dim()};
  mutable typename P::Metric place_{problem_};
  mutable Vector v_ = full_mu_, z_ = v_, r_ = v_, mu_ = v_;
  typename P::ConstraintMatrix a_{problem_.constraint_count(), problem_.dim()};
  typename P::Multipliers b_{problem_.constraint_count()};
  mutable typename P::Multipliers rows_ = b_;
  mutable typename P::Element f_ = problem_.element();
};

struct Boxed : SchemeDefaults {
  static std::string name() { return "boxed"; }
  static std::string formula() {
    return "E'(dR_xi)' mu_k = E' I xi/h,  mu_{k+1} = E' Ad_{tau(xi)}' mu_k";
  }
  static std::string source() {
    return "Vivek, Martin de Diego, Banavar: the boxes, slips repaired (schemes/README.md)";
  }
  static constexpr bool left_invariant_only = true;
  static constexpr bool reduced = true;
  static ClaimedOrder claim(double /*s*/, TauTraits /*tau*/, bool /*left_invariant*/) {
    return {1, false};
  }
  template <class P>
  using Step = BoxedStep<P, false>;
};

}  // namespace hamel
