// A hinge or ball joint between the links a and b that closes a chain:
//   e_i . (x_b - x_a) = 0, for a hinge with axis n also e_1 . n_b = e_2 . n_b = 0,
// e_i and n fixed in a; or a ball, of b, that rolls on a surface of a (rolling_pair.hpp).
#pragma once

#include <optional>
#include <string>

#include <hamel/systems/mechanisms/contact.hpp>
#include <hamel/systems/mechanisms/rolling_pair.hpp>

namespace hamel::mechanisms {

struct Loop {
  static constexpr size_t most_rows = 5;

  std::string name;
  int a = kGround, b = kGround;
  Vec3 at = Vec3::Zero(), axis = Vec3::Zero();  // axis 0: a ball joint

  std::optional<RollingSurface> surface = {};
  bool slips = false;  // may the ball slide on it, and leave it?

  bool is_hinge() const { return !axis.isZero(0); }
  size_t row_count() const { return is_hinge() ? 5 : 3; }
  /// At a tree that was placed.
  void rows(const Tree& tree, Row* out) const;
  /// How far it is from closed, m.
  double open_by(const Tree& tree) const;
  /// The point in which a ball touches its surface, in the world.
  Vec3 touch(const Tree& tree) const;
};

}  // namespace hamel::mechanisms
