// The formulas of a tree of bodies (tree.hpp), recorded: places, inertia, and the efforts that a
// motion takes.
//
// Seen from the root of a link, R_j is its rotation and p_j the place of its joint's frame C, both
// as drawn at the root itself. A velocity q of link j is the turning a_q and the velocity l_q of
// the point p_j:
//   hinge: (axis, 0),  slider: (0, axis),  ball: three turnings;
//   root: the columns of C S, at p = that of C.
// With omega_j and a_j its angular velocity and acceleration, l_j the acceleration of p_j less that
// of gravity, r = p_j - p_parent, (omega', v') what the joint adds:
//   omega_j = omega_parent + omega',   a_j = a_parent + sum a_q xi'_q + omega_parent x omega'
//   l_j = l_parent + a_parent x r + omega_parent x (omega_parent x r) + 2 omega_parent x v'
//         + omega' x v' + sum l_q xi'_q
// and the effort on q is a_q . N + l_q . F, N and F what link j and all that it carries take about
// p_j: F = m l + a x s + omega x (omega x s), N = J a + omega x J omega + s x l, s and J its first
// and second moments about p_j. Source: Luh, Walker, Paul, On-line computational scheme for
// mechanical manipulators, J. Dyn. Sys. Meas. Control 102 (1980); Featherstone (2008), ch. 5, 6.
//
// A rotor (tree.hpp) has no place: its inertia is its parent's, but for J (u' + axis . a_parent)
// about its axis, u its rate, and J (u' axis + u omega_parent x axis) on its parent.
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <hamel/systems/mechanisms/programs/screws.hpp>
#include <hamel/systems/mechanisms/tree.hpp>

namespace hamel::mechanisms {

class BodyFormulas {
 public:
  using Numbers = std::vector<Number>;
  using Matrix = std::vector<Numbers>;  // rows

  /// g and xi as the tree lays them out.
  BodyFormulas(const Tree& tree, std::span<const Number> g, std::span<const Number> xi,
               const Vec3& gravity);

  const Tree& tree() const { return tree_; }
  int dim() const { return tree_.dim(); }
  /// Rates of the numbers of g along the motion; 0 of those of rotors, on which nothing depends.
  const Numbers& element_rates() const { return element_rates_; }
  /// I(g).
  Matrix inertia() const;
  /// I(g) xi and 1/2 d(xi^T I(g) xi): with H and L the angular momentum about p_j and the momentum
  /// of all that link j carries, omega and v its parent's angular velocity and velocity at p_j,
  ///   a_q . H + l_q . L   and   H . (omega x a_q) + L . (v x a_q + omega x l_q), 0 on a root.
  std::pair<Numbers, Numbers> momentum() const;
  /// Efforts of the weights on xi; -sum m gravity . x of all mass.
  Numbers weight() const;
  Number potential() const;
  /// The efforts that the accelerations xi' take, gravity included: I xi' less ad*_xi I xi + F -
  /// (dI/dt) xi without other forces.
  Numbers efforts(std::span<const Number> xi_rate) const;

  /// A point and a direction of a link as drawn (kGround: of the world), seen from its root.
  NumberVec3 point(int link, const Vec3& drawn) const;
  NumberVec3 direction(int link, const Vec3& drawn) const;
  /// A direction of the link.
  NumberVec3 turned(int link, const NumberVec3& u) const { return at(link).place.turn(u); }
  /// The root of a link in the world.
  const Pose& root_in_world(int link) const;
  /// f(i, u . velocity of the point q of the link per unit of xi_i), q and u seen from the root.
  void each_effect(int link, const NumberVec3& q, const NumberVec3& u,
                   const std::function<void(int, const Number&)>& f) const;
  /// f(i, u . turning of the link per unit of xi_i).
  void each_turning(int link, const NumberVec3& u,
                    const std::function<void(int, const Number&)>& f) const;
  /// The velocity of the point q of the link, and its angular velocity, seen from the root.
  NumberVec3 velocity(int link, const NumberVec3& q) const;
  NumberVec3 turning(int link) const;

 private:
  struct Moments {
    Number mass;
    NumberVec3 first;
    NumberMat3 second;
  };
  struct Node {
    Pose place;                             // R_j; p_j
    std::vector<NumberVec3> turns, slides;  // a_q, l_q
    NumberVec3 turning, sliding;            // omega', v'
    NumberVec3 omega;                       // omega_j
    NumberVec3 velocity;                    // of p_j, seen from the root
    Moments own;                            // about p_j
    Pose world;                             // of a root
  };
  const Node& at(int link) const { return nodes_[static_cast<size_t>(link)]; }
  bool is_root(int link) const { return tree_.parent(link) == kGround; }
  Pose motion(int link, std::span<const Number> g);
  void place(int link, std::span<const Number> g);
  void move(int link);
  void find_moments(int link);
  std::vector<Moments> composites() const;
  void write(int link, int column, const NumberVec3& force, const NumberVec3& moment,
             Matrix& out) const;

  const Tree& tree_;
  std::vector<Number> xi_;
  Vec3 gravity_;
  std::vector<Node> nodes_;
  Numbers element_rates_;
  Pose rest_;
};

/// I(g) as numbers.
Eigen::MatrixXd inertia_at(const Tree& tree, std::span<const double> g);

}  // namespace hamel::mechanisms
