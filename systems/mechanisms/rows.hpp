// The constraint rows of a mechanism: contacts with the ground, closed chains, prescribed rates.
//
// With q the point of contact, gamma the vertical, seen from the root, and u a horizontal
// direction:
//   u . (v + omega x q) = u . v_ground(q),    and where the height z(q) may change, z(q) = 0, whose
//   differential is gamma . (v + omega x q): q may move in the body, but only along the ground.
//   wheel   q = c - r (gamma - (gamma.n) n)/|...|: below the centre c, in the plane across the axle
//   n;
//           u along n x gamma (rolling), then gamma x (n x gamma) (sideways)
//   roller  the same q; u = cos(a) rolling + sin(a) sideways, a the angle of its rollers (0:
//   omniwheel, 45 deg:
//           mecanum wheel)
//   blade   q a point of the body; u = gamma x d, d the direction of the blade
//   ball    q = c - r gamma; u along the world's x and y
//   loop    a hinge or ball joint between links a, b: e_i . (x_b - x_a) = 0, for a hinge with axis
//   n also
//           e_1 . n_b = e_2 . n_b = 0; e_i and n fixed in a
//   prescribed  one velocity of a joint, xi_i = rate(t); of one that is held at an angle also that,
//   coordinate = angle
// Source: Neimark and Fufaev, Dynamics of Nonholonomic Systems (1972); Campion, Bastin,
// d'Andrea-Novel, IEEE Trans. Robotics and Automation 12 (1996).
#pragma once

#include <array>
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
  // Found by Rows::look_at:
  int carrier =
      0;  // the link, or its parent where the link's own turning changes nothing (a wheel's)
  bool fixed = false;  // its rows are the same wrenches in the carrier at all times
  std::array<Wrench, 3> wrenches = {};
  double height = 0;

  /// How many rows, the last of them its height.
  size_t rows() const { return kind == ContactKind::wheel || kind == ContactKind::ball ? 3 : 2; }
};

struct Loop {
  std::string name;
  int a = kGround, b = kGround;
  Vec3 at = Vec3::Zero(), axis = Vec3::Zero();  // axis 0: a ball joint

  size_t rows() const { return axis.isZero(0) ? 3 : 5; }
};

struct Prescribed {
  std::string name;
  int dof = 0;
  std::function<double(double t)> rate;
  std::function<double(double t)> angle;  // where a run starts; empty: anywhere
  bool of_time = false;                   // does the rate change?
  std::function<double(double t)> slope;  // of the rate; empty: by differences
  int held = -1;                          // the link that stays at this angle; else -1
};

/// The ground moves with this velocity, and turns about the world's origin.
struct Ground {
  double rate = 0;               // rad/s
  Vec3 velocity = Vec3::Zero();  // m/s
  bool moves() const { return rate != 0 || !velocity.isZero(0); }
};

/// One row: a wrench on a link, and for loops the opposite one on another, or a unit row; b and
/// phi.
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
  /// Finds out what does not change; before the rest.
  void look_at(const Tree& tree);
  /// f(i, row) for the rows i that `wants` at a tree that was placed.
  template <class Wants, class F>
  void each(const Tree& tree, double t, Wants&& wants, F&& f) const {
    size_t i = 0;
    const auto look_all = [&](const auto& part) {
      Row rows[5];
      look(part, tree, rows);
      for (size_t k = 0; k < part.rows(); ++k)
        if (wants(i + k)) f(i + k, rows[k]);
    };
    const auto any = [&](size_t count) {
      size_t k = 0;
      while (k < count && !wants(i + k)) ++k;
      return k < count;
    };
    Row row;
    for (const Contact& contact : contacts) {
      const size_t count = contact.rows();
      if (contact.fixed) {
        for (size_t k = 0; k < count; ++k) {
          if (!wants(i + k)) continue;
          take(contact, k, tree, row);
          f(i + k, row);
        }
      } else if (any(count)) {
        look_all(contact);
      }
      i += count;
    }
    for (const Loop& loop : loops) {
      if (any(loop.rows())) look_all(loop);
      i += loop.rows();
    }
    for (const Prescribed& p : prescribed) {
      if (wants(i)) {
        Row given;
        given.dof = p.dof;
        given.drift = p.rate(t);
        if (p.held >= 0) given.phi = beyond(p, tree);
        f(i, given);
      }
      ++i;
    }
  }
  /// All of them.
  template <class F>
  void each(const Tree& tree, double t, F&& f) const {
    each(
        tree, t, [](size_t) { return true; }, f);
  }
  /// out[slots[i]] = d/dt (b - A xi) along the motion at constant xi, of the rows that vary; of a
  /// tree that moved and accelerated.
  void rates(const Tree& tree, double t, const std::vector<char>& varies,
             const std::vector<int>& slots, Eigen::Ref<Eigen::VectorXd> out) const;
  /// Where a contact touches the ground, in the world; its height above it.
  Vec3 touches(const Contact& contact, const Tree& tree) const;
  double height(const Contact& contact, const Tree& tree) const {
    return touches(contact, tree)[2];
  }

 private:
  // Row k of a fixed contact.
  static void take(const Contact& contact, size_t k, const Tree& tree, Row& row) {
    const Wrench& wrench = contact.wrenches[k];
    row.link = contact.link;
    row.phi = k + 1 == contact.rows() ? contact.height : 0;
    if (tree.parent(contact.carrier) == kGround) row.wrench = wrench;
    else row.wrench = tree.in_plane_of_root(contact.carrier).move_wrench(wrench);
  }
  void look(const Contact& contact, const Tree& tree, Row* rows) const;
  static void look(const Loop& loop, const Tree& tree, Row* rows);
  // The coordinate of a joint that is held, from where it is held.
  static double beyond(const Prescribed& p, const Tree& tree);
  void rates(const Contact& contact, const Tree& tree, double* out) const;
  static void rates(const Loop& loop, const Tree& tree, double* out);
};

}  // namespace hamel::mechanisms
