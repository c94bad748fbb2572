// expect: static assertion failed: this type does not satisfy hamel::Retraction: it has no static
// dtau_right_inverse\(xi\) that is an n x n matrix
// one error
#include <hamel/hamel.hpp>

using V = hamel::Vec<3>;
using M = hamel::Mat<3, 3>;

struct MyMap : hamel::RetractionDefaults<MyMap, hamel::SO3> {
  static constexpr bool symmetric = true;
  static std::string name() { return "my_map"; }
  static M tau(const V& xi) { return hamel::Cayley<hamel::SO3>::tau(xi); }
  static V tau_inverse(const M& g) { return hamel::Cayley<hamel::SO3>::tau_inverse(g); }
#ifndef MISTAKE  // called by all that RetractionDefaults adds
  static M dtau_right_inverse(const V& xi) {
    return hamel::Cayley<hamel::SO3>::dtau_right_inverse(xi);
  }
#endif
  static M dtau_right_inverse_transpose_derivative(const V& xi, const V& p) {
    return hamel::Cayley<hamel::SO3>::dtau_right_inverse_transpose_derivative(xi, p);
  }
};
template <class>
using Mine = MyMap;

struct Body {
  using Group = hamel::SO3;
  M inertia() const { return M::Identity(); }
  hamel::Mat<1, 3> constraints() const { return {0, 0, 1}; }
};

auto use() { return hamel::simulate<hamel::Lift, Mine>(Body{}); }
