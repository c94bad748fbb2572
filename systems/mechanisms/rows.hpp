// The constraint rows of a mechanism: contacts with the ground (contact.hpp), closed chains
// (closed_loop.hpp), couplings of joints (coupling.hpp), agreements of contacts (agreement.hpp),
// prescribed rates.
//
//   prescribed  one velocity of a joint, xi_i = rate(t); of one that is held at an angle also that,
//               coordinate = angle
// Source: Neimark and Fufaev, Dynamics of Nonholonomic Systems (1972); Campion, Bastin,
// d'Andrea-Novel, IEEE Trans. Robotics and Automation 12 (1996).
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/agreement.hpp>
#include <hamel/systems/mechanisms/closed_loop.hpp>
#include <hamel/systems/mechanisms/contact.hpp>
#include <hamel/systems/mechanisms/coupling.hpp>

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
  bool length = true;   // is its phi in m, not of a formula?
  bool slips = false;   // of a part that may slide or open: it does not always hold
};

struct ConstraintRows {
  std::vector<Contact> contacts;
  std::vector<Loop> loops;
  std::vector<Coupling> couplings;
  std::vector<Agreement> agreements = {};
  std::vector<Prescribed> prescribed;
  Ground ground;
  std::vector<int> coupled_links = {};  // on whose coordinates the couplings depend, each once

  bool has_states() const {
    return std::ranges::any_of(couplings, [](const Coupling& c) { return c.affine; });
  }
  /// Names and meanings, in the order of each().
  std::vector<RowInfo> info() const;
  /// Finds the links in whose place the contacts are, and those that are coupled; before the rest.
  void find_links(const Tree& tree);
  /// f(i, row) of all rows but agreements, which are recorded only, at a tree that was placed.
  template <class F>
  void each(const Tree& tree, double t, F&& f) const {
    size_t i = 0;
    for (const Contact& contact : contacts) {
      Row rows[Contact::most_rows];
      contact.model->rows(contact, tree, ground, rows);
      for (size_t k = 0; k < contact.row_count(); ++k) f(i++, rows[k]);
    }
    for (const Loop& loop : loops) {
      Row rows[Loop::most_rows];
      loop.rows(tree, rows);
      for (size_t k = 0; k < loop.row_count(); ++k) f(i++, rows[k]);
    }
    for (const Coupling& coupling : couplings) {
      Row row;
      coupling.row(tree, tree.placed(), row);
      f(i++, row);
    }
    i += agreements.size();
    for (const Prescribed& p : prescribed) {
      Row given;
      given.dof = p.dof;
      given.drift = p.rate(t);
      if (p.held >= 0) given.phi = beyond(p, tree.joint(p.held), tree.placed(p.held));
      f(i++, given);
    }
  }
  /// The point of contact with the ground, in the world.
  Vec3 touch(const Contact& contact, const Tree& tree) const {
    return contact.model->touch(contact, tree, ground);
  }
  /// Numbers of feet (ground_contact.hpp): two for each contact with a ground that has a height.
  size_t foot_count() const { return ground.height ? 2 * contacts.size() : 0; }
  /// The coordinate of a joint that is held, from where it is held.
  static double beyond(const Prescribed& p, const Joint& joint, const double* element);
  /// Derivative of a prescribed rate, at t.
  static double slope(const Prescribed& p, double t);
};

}  // namespace hamel::mechanisms
