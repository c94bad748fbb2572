// The constraint rows of a mechanism: contacts with the ground, closed chains, prescribed rates.
//
// With q the point of contact, gamma the vertical, seen from the root, and u a horizontal direction:
//   u . (v + omega x q) = u . v_ground(q),    and where the height z(q) may change, z(q) = 0, whose differential is
//   gamma . (v + omega x q): q may move in the body, but only along the ground.
//   wheel   q = c - r (gamma - (gamma.n) n)/|...|: below the centre c, in the plane across the axle n;
//           u along n x gamma (rolling), then gamma x (n x gamma) (sideways)
//   roller  the same q; u = cos(a) rolling + sin(a) sideways, a the angle of its rollers (0: omniwheel, 45 deg:
//           mecanum wheel)
//   blade   q a point of the body; u = gamma x d, d the direction of the blade
//   ball    q = c - r gamma; u along the world's x and y
//   loop    a hinge or ball joint between links a, b: e_i . (x_b - x_a) = 0, for a hinge with axis n also
//           e_1 . n_b = e_2 . n_b = 0; e_i and n fixed in a
//   prescribed  one velocity of a joint, xi_i = rate(t)
// Source: Neimark and Fufaev, Dynamics of Nonholonomic Systems (1972); Campion, Bastin, d'Andrea-Novel, IEEE Trans.
// Robotics and Automation 12 (1996).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/tree.hpp>

namespace hamel::mechanisms {

enum class ContactKind { wheel, roller, blade, ball };

struct Contact {
  std::string name;
  ContactKind kind = ContactKind::wheel;
  int link = 0;
  Vec3 at = Vec3::Zero();        // centre, or point of the blade, as drawn
  Vec3 axis = Vec3::UnitY();     // axle, or direction of the blade, of length 1
  double radius = 0, angle = 0;  // m, rad
};

struct Loop {
  std::string name;
  int a = kGround, b = kGround;
  Vec3 at = Vec3::Zero(), axis = Vec3::Zero();  // axis 0: a ball joint
};

struct Prescribed {
  std::string name;
  int dof = 0;
  std::function<double(double t)> rate;
};

/// The ground moves with this velocity, and turns about the world's origin.
struct Ground {
  double rate = 0;               // rad/s
  Vec3 velocity = Vec3::Zero();  // m/s
  bool moves() const { return rate != 0 || !velocity.isZero(0); }
};

/// One row: a wrench on a link, and for loops the opposite one on another, or a unit row; b and phi.
struct Row {
  int link = kGround, other = kGround;
  Wrench wrench = Wrench::Zero(), other_wrench = Wrench::Zero();
  int dof = -1;
  double drift = 0, phi = 0;
};

struct RowWords {
  std::string part, name;  // "rear", "rear.reaction1"
  std::string meaning;     // "rolls without slipping"
  bool holonomic = false;
  bool height = false;  // its multiplier is a normal reaction
};

struct Rows {
  std::vector<Contact> contacts;
  std::vector<Loop> loops;
  std::vector<Prescribed> prescribed;
  Ground ground;

  /// What there is, in the order of each().
  std::vector<RowWords> words() const;
  /// f(row) for all rows at a tree that was placed.
  template <class F>
  void each(const Tree& tree, double t, F&& f) const {
    Row rows[5];
    for (const Contact& contact : contacts) {
      const int count = look(contact, tree, rows);
      for (int i = 0; i < count; ++i) f(rows[i]);
    }
    for (const Loop& loop : loops) {
      const int count = look(loop, tree, rows);
      for (int i = 0; i < count; ++i) f(rows[i]);
    }
    for (const Prescribed& p : prescribed) {
      Row row;
      row.dof = p.dof;
      row.drift = p.rate(t);
      f(row);
    }
  }
  /// Where a contact touches the ground, in the world; its height above it.
  Vec3 touches(const Contact& contact, const Tree& tree) const;
  double height(const Contact& contact, const Tree& tree) const {
    return touches(contact, tree)[2];
  }

 private:
  int look(const Contact& contact, const Tree& tree, Row* rows) const;
  static int look(const Loop& loop, const Tree& tree, Row* rows);
};

}  // namespace hamel::mechanisms
