// The constraint rows of a mechanism: contacts with the ground (contact.hpp), closed chains
// (closed_loop.hpp), prescribed rates.
//
//   prescribed  one velocity of a joint, xi_i = rate(t); of one that is held at an angle also that,
//               coordinate = angle
// Source: Neimark and Fufaev, Dynamics of Nonholonomic Systems (1972); Campion, Bastin,
// d'Andrea-Novel, IEEE Trans. Robotics and Automation 12 (1996).
#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include <hamel/systems/mechanisms/closed_loop.hpp>
#include <hamel/systems/mechanisms/contact.hpp>

namespace hamel::mechanisms {

struct Prescribed {
  std::string name;
  int dof = 0;
  std::function<double(double t)> rate;
  std::function<double(double t)> angle;  // where a run starts; empty: anywhere
  bool time_dependent = false;            // does the rate change?
  std::function<double(double t)> slope;  // of the rate; empty: by differences
  int held = -1;                          // the link that stays at this angle; else -1
  bool driven = false;                    // the rate is an input
};

struct RowInfo {
  std::string part, name;  // "rear", "rear.reaction1"
  std::string meaning;     // "rolls without slipping"
  bool holonomic = false;
  bool height = false;  // its multiplier is a normal reaction
};

struct ConstraintRows {
  std::vector<Contact> contacts;
  std::vector<Loop> loops;
  std::vector<Prescribed> prescribed;
  Ground ground;

  /// Names and meanings, in the order of each().
  std::vector<RowInfo> info() const;
  /// Finds the contacts whose rows do not change; before the rest.
  void find_fixed(const Tree& tree);
  /// f(i, row) for the rows i selected by a predicate at a tree that was placed; with rates one
  /// that moved and accelerated.
  template <bool with_rates = false, class Wants, class F>
  void each(const Tree& tree, double t, Wants&& wants, F&& f) const {
    size_t i = 0;
    for (const Contact& contact : contacts) {
      if (contact.fixed) each_fixed<with_rates>(contact, tree, i, wants, f);
      else each_evaluated<with_rates>(contact, tree, i, wants, f);
      i += contact.row_count();
    }
    each_of_joints<with_rates>(tree, t, i, wants, f);
  }
  /// f(i, A xi - b) for the rows i selected by a predicate, at a tree that moved with xi.
  template <class Wants, class F>
  void each_velocity(const Tree& tree, double t, const double* xi, Wants&& wants, F&& f) const {
    const auto value = [&](size_t i, const Row& row) {
      f(i, (row.dof >= 0 ? xi[row.dof] : row.power(tree)) - row.drift);
    };
    size_t i = 0;
    for (const Contact& contact : contacts) {
      const size_t count = contact.row_count();
      if (contact.fixed) {
        each_fixed<false>(contact, tree, i, wants, value);
      } else if (any(i, count, wants)) {
        std::array<double, Contact::most_rows> values;
        contact.model->velocities(contact, tree, ground, values.data());
        for (size_t k = 0; k < count; ++k)
          if (wants(i + k)) f(i + k, values[k]);
      }
      i += count;
    }
    each_of_joints<false>(tree, t, i, wants, value);
  }
  /// f(i, phi) for the holonomic rows i selected by a predicate.
  template <class Wants, class F>
  void each_holonomic(const Tree& tree, Wants&& wants, F&& f) const {
    size_t i = 0;
    for (const Contact& contact : contacts) {
      i += contact.row_count();
      if (wants(i - 1))
        f(i - 1, contact.fixed ? contact.height : contact.model->height(contact, tree));
    }
    for (const Loop& loop : loops) {
      Row rows[Loop::most_rows];
      evaluate(loop, tree, false, rows);
      for (size_t k = 0; k < loop.row_count(); ++k, ++i)
        if (wants(i)) f(i, rows[k].phi);
    }
    for (const Prescribed& p : prescribed) {
      if (p.held >= 0 && wants(i)) f(i, beyond(p, tree));
      ++i;
    }
  }
  /// All of them.
  template <class F>
  void each(const Tree& tree, double t, F&& f) const {
    each(
        tree, t, [](size_t) { return true; }, f);
  }
  /// The point of contact with the ground, in the world.
  static Vec3 touch(const Contact& contact, const Tree& tree) {
    return contact.model->touch(contact, tree);
  }

 private:
  // Is one of `count` rows wanted, the first of which is row `first`?
  template <class Wants>
  static bool any(size_t first, size_t count, Wants& wants) {
    for (size_t i = first; i < first + count; ++i)
      if (wants(i)) return true;
    return false;
  }
  // Rows of a contact or loop, of which the first is row `first`.
  template <bool with_rates, class Part, class Wants, class F>
  void each_evaluated(const Part& part, const Tree& tree, size_t first, Wants& wants, F& f) const {
    if (!any(first, part.row_count(), wants)) return;
    Row rows[Part::most_rows];
    evaluate(part, tree, with_rates, rows);
    for (size_t k = 0; k < part.row_count(); ++k)
      if (wants(first + k)) f(first + k, rows[k]);
  }
  // Rows of loops and prescribed joints, of which the first is row i.
  template <bool with_rates, class Wants, class F>
  void each_of_joints(const Tree& tree, double t, size_t i, Wants& wants, F& f) const {
    for (const Loop& loop : loops) {
      each_evaluated<with_rates>(loop, tree, i, wants, f);
      i += loop.row_count();
    }
    for (const Prescribed& p : prescribed) {
      if (wants(i)) {
        Row given;
        given.dof = p.dof;
        given.drift = p.rate(t);
        if constexpr (with_rates) given.rate = slope(p, t);
        if (p.held >= 0) given.phi = beyond(p, tree);
        f(i, given);
      }
      ++i;
    }
  }
  // Rows of a fixed contact, of which the first is row `first`.
  template <bool with_rates, class Wants, class F>
  static void each_fixed(const Contact& contact, const Tree& tree, size_t first, Wants& wants,
                         F& f) {
    Twist change;
    if constexpr (with_rates) change = change_of(contact, tree);
    Row row;
    for (size_t k = 0; k < contact.row_count(); ++k) {
      if (!wants(first + k)) continue;
      take(contact, k, tree, row);
      if constexpr (with_rates) row.rate = -row.wrench.dot(change);
      f(first + k, row);
    }
  }
  // Row k of a fixed contact.
  static void take(const Contact& contact, size_t k, const Tree& tree, Row& row) {
    const Wrench& wrench = contact.wrenches[k];
    row.link = contact.link;
    row.phi = k + 1 == contact.row_count() ? contact.height : 0;
    if (tree.parent(contact.carrier) == kGround) row.wrench = wrench;
    else row.wrench = tree.in_plane_of_root(contact.carrier).move_wrench(wrench);
  }
  // A wrench fixed in a link that moves with U against its root: its power changes by F . (D - ad_U
  // V).
  static Twist change_of(const Contact& contact, const Tree& tree) {
    return tree.acceleration(contact.link) -
           ad(tree.against_root(contact.carrier), tree.twist(contact.link));
  }
  void evaluate(const Contact& contact, const Tree& tree, bool with_rates, Row* rows) const {
    contact.model->rows(contact, tree, ground, with_rates, rows);
  }
  static void evaluate(const Loop& loop, const Tree& tree, bool with_rates, Row* rows) {
    loop.rows(tree, with_rates, rows);
  }
  // The coordinate of a joint that is held, from where it is held.
  static double beyond(const Prescribed& p, const Tree& tree);
  // Derivative of its rate, at t.
  static double slope(const Prescribed& p, double t);
};

}  // namespace hamel::mechanisms
