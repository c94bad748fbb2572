// A tree of bodies: placements, twists, inertia and its differential, by recursion from the roots.
//
// A link is a rigid body with the joint that carries it; its parent is another link or the ground.
// All is drawn in one pose of the whole mechanism, in which the frame of every link is that of the
// world. With P and C the frame of the joint as drawn, on the parent and on the child, iota(g_j)
// the motion of the joint (joint.hpp):
//   M_j = M_parent J_j,   J_j = P iota(g_j) C^-1,   V_j = Ad_{J_j}^-1 V_parent + Ad_C S xi_j.
// A root link carries all others: quantities of a tree are seen from its root, X_j the place of
// link j there, W that of the root in the world. So seen the columns s of Ad_C S are Ad_{X_j} Ad_C
// S, twists and wrenches add, and with I_j the inertia and P_j the momentum of link j with all that
// it carries:
//   I(g)_ab = s_a^T I_b s_b for a on the way from the root to b,     (composite bodies)
//   (I(g) xi)_a = s_a^T P_a,
//   1/2 d(xi^T I xi)_a = s_a^T ad_{V_parent}^T P_a.        (from d V_j = -ad_{s_a} Ad^-1 V_parent)
// Along the motion, xi held, with U_j = V_j - V_root the twist of link j against its root and D_j =
// dV_j/dt:
//   D_j = D_parent + ad_{U_parent} (V_j - V_parent),   D_root = 0,   (ds_a/dt = ad_{U_parent} s_a)
//   (dI/dt xi)_a = s_a^T (ad_{U_parent}^T P_a + dP_a/dt),
//   d(I_j V_j)/dt = I_j (D_j - ad_{U_j} V_j) - ad_{U_j}^T I_j V_j.
// So all that turns and moves, ad*_xi I xi + 1/2 d(xi^T I xi) - (dI/dt) xi, is s_a^T F_a, F_a the
// sum over what link a carries of
//   ad_{V_j}^T I_j V_j - I_j (D_j - ad_{U_j} V_j),
// as V_root = V_parent - U_parent in the last two terms, and ad*_xi is that of the joint alone.
// The axis of a joint with one velocity is fixed in its parent: s = Ad_{X_parent} Ad_P S, constant
// on a root. Less is left to do for
//   links         that turn about one axis of their root in space: turned_numbers.hpp;
//   planar links  that turn about the vertical of a root which does no more: plane.hpp;
//   rotors        that carry nothing and whose inertia their own turning does not change (wheels):
//                 it is their parent's, but for the momentum of their spin, and they need no place.
// Cost: O(links * depth) for I(g), O(links) for all else.
// Source: Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 6; Park, Bobrow, Ploen, A Lie
// group formulation of robot dynamics, Int. J. Robotics Research 14 (1995).
#pragma once

#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include <hamel/systems/mechanisms/joint.hpp>
#include <hamel/systems/mechanisms/plane.hpp>
#include <hamel/systems/mechanisms/turned_numbers.hpp>

namespace hamel::mechanisms {

/// No link: what rests in the world.
inline constexpr int kGround = -1;

struct Link {
  int parent = kGround;  // an earlier link
  std::shared_ptr<const Joint> joint = {};
  Rigid on_parent = {}, on_child = {};  // P and C
  Inertia inertia = {};                 // of the body, in the drawn pose's axes about its origin
};

/// P iota C^-1 where it is affine in up to 4 numbers of the element (cos and sin of an angle, a
/// position): constant + sum of numbers times terms, of which those that only shift are the last.
struct MotionTerms {
  static constexpr int most = 4;  // with more the product of three motions costs less

  Rigid constant;
  std::array<Rigid, most> terms;
  std::array<int, most> numbers = {};  // of the element
  int turning = 0, count = 0;          // terms that turn; all; 0: not affine

  MotionTerms() = default;
  explicit MotionTerms(const Link& link);
  Rigid sum(const double* g) const;
  PlaneMotion sum_in_plane(const double* g) const;
};

class Tree {
 public:
  explicit Tree(const std::vector<Link>& links);

  int dim() const { return dim_; }    // n
  int size() const { return size_; }  // doubles in an element
  int links() const { return static_cast<int>(nodes_.size()); }
  /// Index of the first velocity of a link's joint, and how many there are.
  int first(int link) const { return at(link).dof; }
  int count(int link) const { return at(link).count; }
  int element(int link) const { return at(link).element; }
  const Joint& joint(int link) const { return *at(link).link.joint; }
  int parent(int link) const { return at(link).link.parent; }
  bool planar(int link) const { return at(link).planar; }
  bool rotor(int link) const { return at(link).rotor; }
  /// The twist of a joint with one velocity at unit rate, as drawn.
  Twist axis(int link) const { return at(link).directions.col(0); }
  /// The element of the drawn pose.
  const std::vector<double>& drawn() const { return drawn_; }

  /// Places all links; must come before what follows.
  void place(const double* g);
  bool placed_at(const double* g) const {
    return std::memcmp(placed_.data(), g, placed_.size() * sizeof(double)) == 0;
  }
  /// The element of a joint where it was placed.
  const double* placed(int link) const { return placed_.data() + element(link); }
  /// The inertia of each link, for momentum(); place() first.
  void turn_inertia();
  /// With all that it carries, for inertia(), composite() and add_weight(); place() first.
  void accumulate_inertia();
  /// Link seen from its root (the ground: from the world), and its root in the world.
  Rigid from_root(int link) const;
  /// from_root() where it is known already, else null.
  const Rigid* known_from_root(int link) const {
    if (link == kGround) return &rest_;
    const Node& node = at(link);
    return node.planar || node.rotor ? nullptr : &node.place;
  }
  const Rigid& root_in_world(int link) const {
    return link == kGround ? rest_ : at(at(link).root).world;
  }
  Rigid in_world(int link) const { return root_in_world(link) * from_root(link); }
  /// Pose of a planar link, seen from its root.
  const PlaneMotion& in_plane_of_root(int link) const { return at(link).flat; }

  /// Twists of all links, seen from their roots; place() first.
  void move(Eigen::Ref<const Eigen::VectorXd> xi);
  const Twist& twist(int link) const { return link == kGround ? still_ : at(link).twist; }
  const Twist& root_twist(int link) const {
    return link == kGround ? still_ : at(at(link).root).twist;
  }
  /// How they change while xi does not, D; move() first.
  void accelerate();
  const Twist& acceleration(int link) const {
    return link == kGround ? still_ : at(link).acceleration;
  }
  /// The twist of a link against its root, U; accelerate() first.
  const Twist& against_root(int link) const { return link == kGround ? still_ : at(link).against; }

  void inertia(Eigen::Ref<Eigen::MatrixXd> out) const;
  /// I xi and 1/2 d(xi^T I xi); turn_inertia() and move() first.
  void momentum(Eigen::Ref<Eigen::VectorXd> out, Eigen::Ref<Eigen::VectorXd> inertial_force);
  /// ad*_xi I xi + 1/2 d(xi^T I xi) - (dI/dt) xi and what the weights do on xi;
  /// turn_inertia() and accelerate() first.
  void bias(const Vec3& gravity, Eigen::Ref<Eigen::VectorXd> out);
  /// out += what the weights do on xi; accumulate_inertia() first.
  void add_weight(const Vec3& gravity, Eigen::Ref<Eigen::VectorXd> out) const;
  /// f(i, what a wrench on a link does on xi_i), once for an i; seen from its root. On the ground
  /// nothing.
  template <class F>
  void each_effect(int link, const Wrench& wrench, F&& f) const {
    for (int j = link; j != kGround; j = parent(j)) {
      const Node& node = at(j);
      node.each_along(wrench, [&](int i, double effect) { f(node.dof + i, effect); });
    }
  }
  template <class Out>
  void add_wrench(int link, const Wrench& wrench, Out&& out) const {
    each_effect(link, wrench, [&](int i, double effect) { out[i] += effect; });
  }
  /// Mass and first moment of all that a root carries, itself included, seen from it.
  const Inertia& composite(int root) const { return at(root).carried; }

 private:
  struct Node {
    Link link;
    int root = 0, dof = 0, element = 0, count = 0;
    bool planar = false, rotor = false, on_root = false;
    bool free = false;   // a root whose velocities are its whole twist, at the position of C
    bool turns = false;  // about an axis fixed in its root, in space: what it carries by harmonics
    Mat<6, 6> directions = Mat<6, 6>::Zero();  // Ad_C S; of one velocity Ad_P S
    Rigid after;                               // C^-1
    MotionTerms terms;
    Inertia inertia;                      // with that of the rotors
    Wrench spin = Wrench::Zero();         // momentum of a rotor at unit rate, seen from its parent
    double moment = 0, rate = 0;          // of a rotor
    TurnedNumbers<12, 2> turned_inertia;  // of a link that turns: first and second moments
    TurnedNumbers<12, 1> turned_spin;     // of a rotor on one: column and spin
    // Seen from the root, at the last place:
    Mat<6, 6> columns = Mat<6, 6>::Zero();
    Rigid place, world;  // X; W of a root
    PlaneMotion flat;    // X of a planar link
    Twist twist = Twist::Zero(), against = Twist::Zero(), acceleration = Twist::Zero();  // V, U, D
    Wrench spin_here = Wrench::Zero(), momentum = Wrench::Zero(), force = Wrench::Zero();  // P, F
    Vec3 gravity = Vec3::Zero();  // seen from a root
    Inertia own, carried;         // with all that the link carries

    Rigid across(const double* g) const;  // from the parent
    /// f(i, effect) of a wrench on each of its velocities; of one on a planar link only its entries
    /// in the plane count.
    template <class F>
    void each_along(const Wrench& wrench, F&& f) const {
      const Vec3& c = link.on_child.position;
      if (planar) {
        const Vec3 effort = in_plane(wrench);
        if (free) {
          f(0, effort[0] + c[1] * effort[1] - c[0] * effort[2]);
          f(1, effort[1]);
          f(2, effort[2]);
        } else {
          for (int i = 0; i < count; ++i) f(i, in_plane(columns.col(i)).dot(effort));
        }
      } else if (free) {
        const Vec3 turning = upper(wrench) + lower(wrench).cross(c);
        for (int i = 0; i < 3; ++i) f(i, turning[i]);
        for (int i = 3; i < 6; ++i) f(i, wrench[i]);
      } else {
        for (int i = 0; i < count; ++i) f(i, columns.col(i).dot(wrench));
      }
    }
  };
  const Node& at(int link) const { return nodes_[static_cast<size_t>(link)]; }
  Node& at(int link) { return nodes_[static_cast<size_t>(link)]; }
  Wrench force_on(const Node& node) const;
  static bool is_free(const Node& node);
  static void place_link(Node& node, const Node& parent, const double* element);
  static void place_columns(Node& node, const Node& parent, const double* g);
  static void move_free(Node& node, const double* xi);
  void find_planar(Node& node, const double* drawn) const;
  void find_rotors();
  void find_turned();
  void write(const Node* from, int column, const Wrench& momentum, double* out,
             Eigen::Index stride) const;
  static void write_free(const Node& node, double* out, Eigen::Index stride);

  std::vector<Node> nodes_;
  std::vector<double> drawn_, placed_, moved_;  // xi of the last move there
  Rigid rest_;
  Twist still_ = Twist::Zero();
  int dim_ = 0, size_ = 0;
  bool chain_ = true;  // each link carries the next one: I(g) has no entries that are always 0
  bool turned_ = false, carries_ = false,
       moves_ = false;  // the inertias; they, accumulated; twists
};

}  // namespace hamel::mechanisms
