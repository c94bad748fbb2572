// A system of a user's own whose contact slides, sticks and strikes: a block on an incline, thrown
// up the slope. It slides to rest after t = v/(g (sin a + mu cos a)), and stays where mu > tan a.
#include <hamel/hamel.hpp>

#include <cmath>
#include <iostream>

// [system]
struct Block {
  using Group = hamel::Rn<2>;  // along the slope, and above it
  double mass = 1, slope = 0.3, friction = 0.4, restitution = 0.2;
  static std::string name() { return "block"; }
  hamel::Mat<2, 2> inertia() const { return mass * hamel::Mat<2, 2>::Identity(); }
  // The rows of the block at rest on the slope, as of any system ...
  static hamel::Mat<1, 2> constraints(const hamel::Vec<2>&) { return {1, 0}; }
  static auto holonomic(const auto& g) {
    using T = std::decay_t<decltype(g[1])>;
    return hamel::VecT<T, 1>(g[1]);
  }
  auto potential(const auto& g) const {
    return 9.81 * mass * (std::sin(slope) * g[0] + std::cos(slope) * g[1]);
  }
  // ... and which of them are a contact's: row 0 its slip, row 1 its gap.
  void contacts(auto& add) const {
    add({.name = "base",
         .tangential = {0},
         .normal = 1,
         .friction = friction,
         .restitution = restitution});
  }
};
// [/system]

int main() {
  const Block block;
  const auto result = hamel::simulate(block)
                          .start({.configuration = {0, 0}, .velocity = {2, 0}})
                          .slip()
                          .tolerance({.relative = 1e-10})
                          .until(2)
                          .run();
  std::cout << result.report();
  const double grip = 9.81 * (std::sin(block.slope) + block.friction * std::cos(block.slope));
  const bool stops = result.events.size() == 1 && result.events[0].name == "base.rolls" &&
                     std::abs(result.events[0].time - 2 / grip) < 1e-9;
  return result && stops && std::abs(result.last.coordinates[0] - 2 / grip) < 1e-9 ? 0 : 1;
}
