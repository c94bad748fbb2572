// expect: static assertion failed: this type does not satisfy hamel::System
#include <hamel/hamel.hpp>

#ifdef MISTAKE  // 3 x 3 on se2
using Inertia = hamel::Mat<2, 2>;
#else
using Inertia = hamel::Mat<3, 3>;
#endif

struct Sleigh {
  using Group = hamel::SE2;
  auto inertia() const { return Inertia(Inertia::Identity()); }
  auto constraints() const { return hamel::Mat<1, 3>{0, 0, 1}; }
};

auto use() { return hamel::simulate(Sleigh{}); }
