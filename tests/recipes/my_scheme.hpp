// my_scheme: explicit Euler on the group, g_1 = g_0 tau(h xi_0), I xi_1 = I xi_0 + h (ad*_xi I xi +
// force) + A^T lambda.
#pragma once

#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

struct MyScheme : SchemeDefaults {
  static std::string name() { return "my_scheme"; }
  static std::string formula() { return "g_1 = g_0 tau(h xi_0)"; }
  static std::string source() { return "Euler 1768"; }
  static constexpr ConstraintKept constraint_kept = ConstraintKept::nodes;
  static ClaimedOrder claim(double, TauTraits, bool) { return {1, false}; }

  template <class P>
  class Step {
   public:
    using Problem = P;
    using Node = hamel::Node<P>;

    Step(const P& problem, double /*s*/) : problem_(problem) {}
    static int evaluations() { return 1; }
    void begin(const Node& node, double h) {
      from_ = &node;
      h_ = h;
    }
    bool finish(Node& next) const {
      place_.set(problem_, from_->t, from_->g);
      problem_.velocity(from_->x, xi_);
      problem_.momentum(place_.inertia, from_->x, mu_);
      problem_.ad_transpose(xi_, mu_, change_);
      mu_ += h_ * change_;
      problem_.force(from_->t, from_->g, xi_, change_);
      mu_ += h_ * change_;
      xi_ *= h_;
      if (!problem_.in_domain(xi_)) return false;
      problem_.tau(xi_, f_);
      next.t = from_->t + h_;
      problem_.compose(from_->g, f_, next.g);
      place_.set(problem_, next.t, next.g);
      place_.admissible(mu_, next.x);
      return true;
    }

   private:
    P problem_;
    mutable typename P::Metric place_{problem_};
    const Node* from_ = nullptr;
    double h_ = 0;
    mutable typename P::Element f_ = problem_.element();
    mutable typename P::Vector xi_{problem_.dim()}, mu_ = xi_, change_ = xi_;
  };
};

}  // namespace hamel
