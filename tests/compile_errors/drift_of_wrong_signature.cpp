// expect: static assertion failed: drift of this system cannot be called: expected a const member
// drift\(\)
#include <hamel/hamel.hpp>

struct Skate {
  using Group = hamel::SE2;
  auto inertia() const { return hamel::Mat<3, 3>(hamel::Mat<3, 3>::Identity()); }
  auto constraints() const { return hamel::Mat<1, 3>{0, 0, 1}; }
#ifdef MISTAKE  // time alone: it would be left out, and the row would be A xi = 0
  hamel::Vec<1> drift(double /*t*/) const { return hamel::Vec<1>(0.5); }
#else
  hamel::Vec<1> drift(double /*t*/, const auto& /*g*/) const { return hamel::Vec<1>(0.5); }
#endif
};

auto use() { return hamel::simulate(Skate{}); }
