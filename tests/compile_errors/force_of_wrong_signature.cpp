// expect: static assertion failed: force of this system cannot be called: expected a const member
// force\(g, xi\)
#include <hamel/hamel.hpp>

struct Body {
  using Group = hamel::SO3;
  double drift = 0.1;  // data may have any name
  hamel::Mat<3, 3> inertia() const { return hamel::Mat<3, 3>::Identity(); }
#ifdef MISTAKE  // not const: it would be left out, and the body would be free
  hamel::Vec<3> force(double /*t*/, const auto& /*g*/, const hamel::Vec<3>& xi) {
    return -drift * xi;
  }
#else
  hamel::Vec<3> force(const auto& /*g*/, const hamel::Vec<3>& xi) const { return -drift * xi; }
#endif
};

auto use() { return hamel::simulate(Body{}); }
