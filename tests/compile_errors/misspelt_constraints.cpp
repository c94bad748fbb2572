// expect: static assertion failed: this system has a function 'constraint', which is never called,
// and no 'constraints'
#include <hamel/hamel.hpp>

struct Sleigh {
  using Group = hamel::SE2;
  auto inertia() const { return hamel::Mat<3, 3>(hamel::Mat<3, 3>::Identity()); }
#ifdef MISTAKE  // it would never be called, and the body would be free
  auto constraint() const { return hamel::Mat<1, 3>{0, 0, 1}; }
#else
  double constraint = 0.5;                                  // data may have any name
  auto drfit() const { return hamel::Vec<1>(constraint); }  // so may functions, beside the member
  auto drift() const { return drfit(); }
  auto constraints() const { return hamel::Mat<1, 3>{0, 0, 1}; }
#endif
};

auto use() { return hamel::simulate(Sleigh{}); }
