// A scheme of your own for every system: rows and inertia that depend on the configuration,
// potentials, forces, drifts. It is held to what it claims on all registered systems.
#include <iostream>

#include <hamel/framework/check/scheme_laws.hpp>
#include <hamel/hamel.hpp>

// The explicit midpoint rule. With a(t, g, xi) the rate of xi along the motion,
//   xi_m = xi_0 + h/2 a(t_0, g_0, xi_0),   g_m = g_0 tau(h/2 xi_0),
//   xi_1 = xi_0 + h a(t_0 + h/2, g_m, xi_m),   g_1 = g_0 tau(h xi_m),
// then xi_1 onto A xi = b, orthogonally in the metric I.
struct ExplicitMidpoint : hamel::ExplicitDefaults {
  static std::string name() { return "explicit_midpoint"; }
  static std::string formula() {
    return "xi_1 = xi_0 + h a(t + h/2, g_m, xi_m), g_1 = g_0 tau(h xi_m)";
  }
  static std::string source() { return "Hairer, Norsett, Wanner, II.1"; }
  static hamel::ClaimedOrder claim(double /*s*/, hamel::TauTraits tau, bool /*left_invariant*/) {
    return {tau.symmetric ? 2 : 1, false};
  }

  template <class P>
  class Step {
   public:
    using Problem = P;
    using Node = hamel::Node<P>;
    Step(const P& problem, double /*s*/) : problem_(problem) {}
    static int evaluations() { return 2; }
    void begin(const Node& node, double h) {
      from_ = &node;
      h_ = h;
    }
    bool finish(Node& next) const {
      return advance(*from_, h_ / 2, middle_) && advance(middle_, h_, next) && settle(next);
    }

   private:
    // From the node where the step begins, by h times the velocity and its rate at `at`.
    bool advance(const Node& at, double h, Node& to) const {
      motion_(at.t, at.g, at.x, rate_);
      problem_.velocity(at.x, xi_);
      xi_ *= h;
      if (!problem_.in_domain(xi_)) return false;
      problem_.tau(xi_, to.g);
      problem_.compose(from_->g, to.g, to.g);
      to.x = from_->x + h * rate_;
      to.t = from_->t + h;
      return true;
    }
    bool settle(Node& node) const {
      if constexpr (!P::left_invariant) {  // else the velocity is carried by coordinates of ker A
        motion_.set(node.t, node.g);
        motion_.project(node.x);
      }
      return true;
    }

    P problem_;
    mutable hamel::EquationsOfMotion<P> motion_{problem_};
    mutable Node middle_{problem_};
    mutable typename P::State rate_ = middle_.x;
    mutable typename P::Vector xi_{problem_.dim()};
    const Node* from_ = nullptr;
    double h_ = 0;
  };
};

int main() {
  hamel::add_scheme<ExplicitMidpoint>(hamel::registry());
  std::cout
      << hamel::simulate("falling_disk").scheme("explicit_midpoint").step(1e-3).run().report();
  int failed = 0, held = 0, orders = 0;
  for (const hamel::LawResult& law : hamel::check_scheme(hamel::registry(), "explicit_midpoint")) {
    if (!law.passed()) std::cerr << law << "\n";
    ++(law.passed() ? held : failed);
    if (law.seen.starts_with("order ")) ++orders;  // "order 2, expected at least 2"
  }
  std::cout << held << " laws hold, " << failed << " fail; " << orders << " orders were measured\n";
  return failed == 0 && held > 100 && orders > 0 ? 0 : 1;
}
