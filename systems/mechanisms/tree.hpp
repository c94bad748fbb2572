// A tree of bodies: its links, and where they are.
//
// A link is a rigid body with the joint that carries it; its parent is another link or the ground.
// All is drawn in one pose of the whole mechanism, in which the frame of every link is that of the
// world. With P and C the frame of the joint as drawn, on the parent and on the child, iota(g_j)
// the motion of the joint (joint.hpp):
//   M_j = M_parent J_j,   J_j = P iota(g_j) C^-1,   V_j = Ad_{J_j}^-1 V_parent + Ad_C S xi_j.
// A root link carries all others: seen from it, X_j is the place of link j, W that of the root in
// the world, and the columns s of Ad_C S are Ad_{X_j} Ad_C S; a wrench F on a link does s^T F on
// xi of each link on the way to the root. What a step evaluates are programs of the same tree
// (programs/body_formulas.hpp).
//
// A rotor carries nothing, and its inertia is not changed by its own turning (a wheel): it is its
// parent's, but for the moment of its spin.
// Source: Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 4.
#pragma once

#include <memory>
#include <vector>

#include <hamel/systems/mechanisms/joint.hpp>

namespace hamel::mechanisms {

/// No link: what rests in the world.
inline constexpr int kGround = -1;

struct Link {
  int parent = kGround;  // an earlier link
  std::shared_ptr<const Joint> joint = {};
  Rigid on_parent = {}, on_child = {};  // P and C
  Inertia inertia = {};                 // of the body, in the drawn pose's axes about its origin
  bool is_state = false;                // a scalar (Mechanism::state), which carries no body
  bool is_time = false;                 // the state that is t
};

class Tree {
 public:
  explicit Tree(const std::vector<Link>& links);

  int dim() const { return dim_; }    // n
  int size() const { return size_; }  // doubles in an element
  int links() const { return static_cast<int>(nodes_.size()); }
  /// Index of the first velocity of a link's joint, and how many there are.
  int first(int link) const { return at(link).dof; }
  int count(int link) const { return at(link).link.joint->dim(); }
  int element(int link) const { return at(link).element; }
  const Link& link(int link) const { return at(link).link; }
  const Joint& joint(int link) const { return *at(link).link.joint; }
  int parent(int link) const { return at(link).link.parent; }
  bool rotor(int link) const { return at(link).rotor; }
  /// The inertia of a link as drawn, with that of the rotors on it.
  const Inertia& drawn_inertia(int link) const { return at(link).inertia; }
  /// The moment of a rotor about its axis.
  double moment(int link) const { return at(link).moment; }
  /// The twist of a joint with one velocity at unit rate, as drawn.
  Twist axis(int link) const { return at(link).axis; }
  /// The element of the drawn pose.
  const std::vector<double>& drawn() const { return drawn_; }

  /// Places all links; must come before what follows.
  void place(const double* g);
  /// The elements where it was placed; that of a joint.
  const double* placed() const { return placed_.data(); }
  const double* placed(int link) const { return placed_.data() + element(link); }
  /// Link seen from its root (the ground: from the world), and its root in the world.
  const Rigid& from_root(int link) const { return link == kGround ? rest_ : at(link).place; }
  const Rigid& root_in_world(int link) const {
    return link == kGround ? rest_ : at(at(link).root).world;
  }
  Rigid in_world(int link) const { return root_in_world(link) * from_root(link); }
  /// f(i, what a wrench on a link does on xi_i), once for an i; seen from its root. On the ground
  /// nothing.
  template <class F>
  void each_effect(int link, const Wrench& wrench, F&& f) const {
    for (int j = link; j != kGround; j = parent(j)) {
      const Node& node = at(j);
      for (int i = 0; i < node.columns.cols(); ++i)
        f(node.dof + i, node.columns.col(i).dot(wrench));
    }
  }

 private:
  struct Node {
    Link link;
    int root = 0, dof = 0, element = 0;
    bool rotor = false;
    Twist axis = Twist::Zero();  // P S
    Rigid after;                 // C^-1
    Inertia inertia;             // with that of the rotors
    double moment = 0;           // of a rotor
    // Seen from the root, at the last place:
    Joint::Directions columns;
    Rigid place, world;  // X; W of a root
  };
  const Node& at(int link) const { return nodes_[static_cast<size_t>(link)]; }
  Node& at(int link) { return nodes_[static_cast<size_t>(link)]; }
  void find_rotors();

  std::vector<Node> nodes_;
  std::vector<double> drawn_, placed_;
  Rigid rest_;
  int dim_ = 0, size_ = 0;
};

}  // namespace hamel::mechanisms
