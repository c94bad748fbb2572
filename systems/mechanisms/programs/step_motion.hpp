// The motion of a tree in a step of lift with s = 1/2 and Cayley's map, recorded: places, and the
// momenta at the ends (cotangent_lift.hpp, part by part). On axes tau is addition.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <hamel/systems/mechanisms/programs/lift_layout.hpp>
#include <hamel/systems/mechanisms/programs/screws.hpp>

namespace hamel::mechanisms {

class StepMotion {
 public:
  using Numbers = std::vector<Number>;

  /// From an element, in the numbers of the layout, with the velocity v over the time h.
  StepMotion(const LiftLayout& layout, std::span<const Number> from, std::span<const Number> v,
             const Number& h);

  const Numbers& middle() const { return middle_; }
  Numbers& end() { return end_; }
  /// mu0 and mu1 of p = I(g) v and nu = h F(g, v) at the middle.
  std::pair<Numbers, Numbers> momenta(const Numbers& p, const Numbers& nu) const;

 private:
  void move(const LiftLayout::Part& part, std::span<const Number> from);
  const LiftLayout& layout_;
  Numbers v_;
  Number h_;
  Numbers middle_, end_;
};

/// The element as the tree lays it out; the coordinate of a link with one velocity.
std::vector<Number> tree_element(const LiftLayout& layout, const Tree& tree,
                                 std::span<const Number> numbers);
Number coordinate_of(const LiftLayout::Part& part, std::span<const Number> numbers);

}  // namespace hamel::mechanisms
