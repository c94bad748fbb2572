// A tree of bodies: placements, twists, inertia and its differential, by recursion from the roots.
//
// A link is a rigid body with the joint that carries it; its parent is another link or the ground. All is drawn in one
// pose of the whole mechanism, in which the frame of every link is that of the world. With P and C the frame of the
// joint as drawn, on the parent and on the child, iota(g_j) the motion of the joint (joint.hpp):
//   M_j = M_parent J_j,   J_j = P iota(g_j) C^-1,   V_j = Ad_{J_j}^-1 V_parent + Ad_C S xi_j.
// A root link carries all others: quantities of a tree are seen from its root, X_j the place of link j there, W that
// of the root in the world. So seen the columns s of Ad_C S are Ad_{X_j} Ad_C S, twists and wrenches add, and with
// I_j the inertia and P_j the momentum of link j with all that it carries:
//   I(g)_ab = s_a^T I_b s_b for a on the way from the root to b,     (composite bodies)
//   1/2 d(xi^T I xi)_a = s_a^T ad_{V_parent}^T P_a.                 (from d V_j = -ad_{s_a} Ad^-1 V_parent)
// Cost: O(links * depth) for I(g), O(links) for all else.
// Source: Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 6; Park, Bobrow, Ploen, A Lie group formulation of
// robot dynamics, Int. J. Robotics Research 14 (1995).
#pragma once

#include <array>
#include <span>
#include <vector>

#include <hamel/systems/mechanisms/joint.hpp>

namespace hamel::mechanisms {

/// No link: what rests in the world.
inline constexpr int kGround = -1;

struct Link {
  int parent = kGround;  // an earlier link
  JointKind kind = JointKind::hinge;
  Rigid on_parent, on_child;  // P and C
  Inertia inertia;            // of the body, in the drawn pose's axes about its origin
};

class Tree {
 public:
  explicit Tree(const std::vector<Link>& links);

  int dim() const { return dim_; }    // n
  int size() const { return size_; }  // doubles in an element
  int links() const { return static_cast<int>(links_.size()); }
  /// Where the velocities of a link's joint start, and how many they are.
  int first(int link) const { return at(link).dof; }
  int count(int link) const { return static_cast<int>(at(link).directions.cols()); }
  int element(int link) const { return at(link).element; }
  JointKind kind(int link) const { return at(link).link.kind; }
  int parent(int link) const { return at(link).link.parent; }
  /// The link that carries this one, on the ground.
  int root(int link) const { return at(link).root; }
  /// The element of the drawn pose.
  const std::vector<double>& drawn() const { return drawn_; }

  /// Places all links; must come before what follows.
  void place(const double* g);
  /// Inertias, for inertia(), composite() and add_inertial_force(); place() first.
  void carry();
  /// Link seen from its root (the ground: from the world), and its root in the world.
  const Rigid& from_root(int link) const { return link == kGround ? rest_ : at(link).place; }
  const Rigid& root_in_world(int link) const {
    return link == kGround ? rest_ : at(at(link).root).world;
  }
  Rigid in_world(int link) const { return root_in_world(link) * from_root(link); }

  /// Twists of all links, seen from their roots; place() first.
  void move(Eigen::Ref<const Eigen::VectorXd> xi);
  Twist twist(int link) const { return link == kGround ? Twist::Zero() : at(link).twist; }

  void inertia(Eigen::Ref<Eigen::MatrixXd> out) const;
  /// out += 1/2 d(xi^T I xi); place() and move() first.
  void add_inertial_force(Eigen::Ref<Eigen::VectorXd> out) const;
  /// out += sign * what a wrench on a link does on xi; seen from its root. On the ground nothing.
  template <class Out>
  void add_wrench(int link, const Wrench& wrench, Out&& out, double sign = 1) const {
    for (int j = link; j != kGround; j = parent(j)) {
      const Node& node = at(j);
      for (int i = 0; i < count(j); ++i) {
        out[node.dof + i] += sign * node.columns.col(i).dot(wrench);
      }
    }
  }
  /// out += what it does on the velocities of the link's own joint.
  template <class Out>
  void add_to_joint(int link, const Wrench& wrench, Out&& out) const {
    const Node& node = at(link);
    for (int i = 0; i < count(link); ++i) out[node.dof + i] += node.columns.col(i).dot(wrench);
  }
  /// The first moment of a tree, seen from its root, and its mass; of the link and what it carries.
  Inertia composite(int link) const { return at(link).carried; }

 private:
  struct Node {
    Link link;
    int root = 0, dof = 0, element = 0;
    Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> directions,
        columns;  // Ad_C S; seen from the root
    Rigid after;  // C^-1
    std::array<Rigid, 3>
        turning;         // of a hinge, P Rot C^-1 = the first + cos the second + sin the third
    Rigid place, world;  // X; W of a root
    Twist twist = Twist::Zero();
    Inertia own, carried;                 // seen from the root; with all that the link carries
    Rigid across(const double* g) const;  // from the parent
  };
  const Node& at(int link) const { return nodes_[static_cast<size_t>(link)]; }
  Node& at(int link) { return nodes_[static_cast<size_t>(link)]; }

  std::vector<Node> nodes_;
  std::vector<Link> links_;
  std::vector<double> drawn_;
  mutable std::vector<Wrench> momenta_;
  Rigid rest_;
  int dim_ = 0, size_ = 0;
  bool carries_ = false;
};

}  // namespace hamel::mechanisms
