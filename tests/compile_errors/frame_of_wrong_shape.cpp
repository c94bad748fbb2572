// expect: static assertion failed: frame of this system cannot be used: expected a template frame
#include <hamel/hamel.hpp>

// The last velocity by the first two: 1 x 2.
struct Sleigh {
  using Group = hamel::SE2;
  hamel::Mat<3, 3> inertia() const { return hamel::Mat<3, 3>::Identity(); }
  hamel::Mat<1, 3> constraints() const { return {0, 0, 1}; }
  double potential(const auto& g) const { return g.translation[0]; }
#ifdef MISTAKE
  hamel::Mat<1, 2> frame(const Group::Element<double>& /*g*/) const { return {0, 0}; }
#else
  auto frame(const auto& g) const {
    using T = std::decay_t<decltype(g.translation[0])>;
    return hamel::MatT<T, 1, 2>(T(0.0), T(0.0));
  }
#endif
  hamel::Vec<3> potential_differential(const Group::Element<double>& /*g*/) const {
    return {0, 1, 0};
  }
};

auto use() { return hamel::simulate(Sleigh{}); }
