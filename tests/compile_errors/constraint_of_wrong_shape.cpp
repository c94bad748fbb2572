// expect: static assertion failed: this type does not satisfy hamel::System
#include <hamel/hamel.hpp>

#ifdef MISTAKE  // 3 columns on se2
using Row = hamel::Mat<1, 2>;
#else
using Row = hamel::Mat<1, 3>;
#endif

struct Sleigh {
  using Group = hamel::SE2;
  auto inertia() const { return hamel::Mat<3, 3>(hamel::Mat<3, 3>::Identity()); }
  auto constraints() const { return Row(Row::Zero()); }
};

auto use() { return hamel::simulate(Sleigh{}); }
