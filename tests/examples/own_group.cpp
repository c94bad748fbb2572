// A group of your own with its retraction, held to the laws, and a system that lives on it.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/framework/check/retraction_laws.hpp>
#include <hamel/framework/lie/group_defaults.hpp>
#include <hamel/hamel.hpp>

using V = hamel::Vec<3>;
using M = hamel::Mat<3, 3>;

// [the group: at most 30 lines]
struct HeisenbergExp;
struct Heisenberg : hamel::GroupDefaults<Heisenberg, 3> {  // [e1, e2] = e3, exponential coordinates
  template <class T>
  using Element = hamel::VecT<T, 3>;
  using Retractions = hamel::TypeList<HeisenbergExp>;
  static std::string name() { return "my_heisenberg"; }
  template <class T = double>
  static Element<T> identity() {
    return Element<T>::Zero();
  }
  static V compose(const V& g, const V& h) { return g + h + 0.5 * ad(g) * h; }
  static V inverse(const V& g) { return -g; }
  static M ad(const V& xi) { return M{{0, 0, 0}, {0, 0, 0}, {-xi[1], xi[0], 0}}; }
  static M Ad(const V& g) { return M::Identity() + ad(g); }
};
struct HeisenbergExp : hamel::RetractionDefaults<HeisenbergExp, Heisenberg> {
  static constexpr bool symmetric = true, one_parameter = true;
  static std::string name() { return "exp"; }
  static V tau(const V& xi) { return xi; }
  static V tau_inverse(const V& g) { return g; }
  static M dtau_right_inverse(const V& xi) { return M::Identity() - 0.5 * Heisenberg::ad(xi); }
  static M dtau_right_inverse_transpose_derivative(const V& /*xi*/, const V& p) {
    return -0.5 * Heisenberg::coad(p);
  }
};
// [end]

struct HeisenbergParticle {  // l = 1/2 |xi|^2, xi3 = z' - (x y' - y x')/2 = 0
  using Group = Heisenberg;
  M inertia() const { return M::Identity(); }
  hamel::Mat<1, 3> constraints() const { return {0, 0, 1}; }
};

int main() {
  bool good = true;
  for (const auto& laws :
       {hamel::check_group<Heisenberg>(), hamel::check_retraction<HeisenbergExp>()}) {
    for (const auto& law : laws) {
      std::cout << law << "\n";
      good = good && law.passed();
    }
  }
  hamel::add_group<Heisenberg>(hamel::registry());  // every scheme compiled for it
  const auto result = hamel::simulate(HeisenbergParticle{})
                          .start({.configuration = {1, 0, 0}, .velocity = {0.3, 0.4, 0}})
                          .retraction("exp")
                          .until(10)
                          .run();
  std::cout << result.report();

  // Straight lines over the plane. (The variational, "vakonomic" equations would give helices.)
  double off = 0;
  const auto t = result.trajectory.column("t"), x = result.trajectory.column("x1"),
             y = result.trajectory.column("x2");
  for (size_t i = 0; i < t.size(); ++i) {
    off = std::max(off, std::hypot(x[i] - 1 - 0.3 * t[i], y[i] - 0.4 * t[i]));
  }
  std::cout << "away from the straight line by " << off << "\n";
  if (!(good && result && off < 1e-11)) std::cerr << "own_group: a law fails, or off the line\n";
  return good && result && off < 1e-11 ? 0 : 1;
}
