// expect: static assertion failed: inputs\(u\) goes with force\(t, g, xi, u\) or drift\(t, g, u\)
#include <hamel/hamel.hpp>

struct Cart {
  using Group = hamel::SE2;
  hamel::Mat<3, 3> inertia() const { return hamel::Mat<3, 3>::Identity(); }
  void inputs(auto& u) const { u("push", "N", "along e1"); }
#ifdef MISTAKE  // without u it is no input's: the push would do nothing
  hamel::Vec<3> force(double /*t*/, const auto& /*g*/, const hamel::Vec<3>& xi) const {
    return -xi;
  }
#else
  hamel::Vec<3> force(double /*t*/, const auto& /*g*/, const hamel::Vec<3>& /*xi*/,
                      const hamel::InputValues& u) const {
    return {0, u[0], 0};
  }
#endif
};

auto use() { return hamel::simulate(Cart{}); }
