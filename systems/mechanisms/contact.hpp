// A contact of a body with the ground: where it touches, the directions in which it does not slip.
//
// With q the point of contact, gamma the vertical, seen from the root, and u a horizontal direction
// in which the contact does not slip, its rows are
//   u . (v + omega x q) = u . v_ground(q),    and where the height z(q) may change, z(q) = 0, whose
//   differential is gamma . (v + omega x q): q may move in the body, but only along the ground.
// Each kind is one class of the folder contacts/, listed in contact_kinds.cpp, with one formula for
// q and u, of which both the rows (T = double) and their rates along the motion (T = Dual) follow:
//   struct Blade {                                   // may have members, stated in fields(f)
//     static std::string name(), summary();          // in files: [[blade]]; for the schema
//     static std::vector<std::string> meanings();    // of the directions: "does not slip across"
//     template <class T>
//     ContactPoint<T, 1> touch(const ContactView<T>& view) const;
//     std::vector<BodyShape> shapes(const Point& at) const;   // for the page
//   };
// and, where its directions are those of the world instead of following the body,
//   static constexpr bool of_world = true;
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/drawing.hpp>
#include <hamel/systems/mechanisms/dual.hpp>
#include <hamel/systems/mechanisms/kind.hpp>
#include <hamel/systems/mechanisms/tree.hpp>

namespace hamel::mechanisms {

/// The ground moves with this velocity, and turns about the world's origin.
struct Ground {
  double rate = 0;               // rad/s
  Vec3 velocity = Vec3::Zero();  // m/s
  bool moves() const { return rate != 0 || !velocity.isZero(0); }
};

/// Row: a wrench on a link, and for loops the opposite one on another, or a unit row; b and
/// phi, and d/dt (b - A xi) along the motion, xi held.
struct Row {
  int link = kGround, other = kGround;
  Wrench wrench = Wrench::Zero(), other_wrench;  // this one where there is another link
  int dof = -1;
  double drift = 0, phi = 0, rate = 0;

  /// A xi of wrenches, on a tree that moved.
  double power(const Tree& tree) const {
    double out = wrench.dot(tree.twist(link));
    if (other != kGround) out -= other_wrench.dot(tree.twist(other));
    return out;
  }
};

class ContactModel;

struct Contact {
  static constexpr size_t most_rows = 3;

  std::string name;
  std::shared_ptr<const ContactModel> model;
  int link = 0;
  Vec3 at = Vec3::Zero();  // as drawn
  // Found by ConstraintRows::find_fixed:
  int carrier = 0;  // the link, or its parent where the link's own turning changes nothing: a wheel
  bool fixed = false;  // its rows are the same wrenches in the carrier at all times
  std::array<Wrench, most_rows> wrenches = {};
  double height = 0;

  /// How many rows, the last of them its height.
  size_t row_count() const;
};

/// A kind of contact with its data.
class ContactModel {
 public:
  virtual ~ContactModel();  // no other object may need the vtable (tools/cmake/localise)
  /// Meanings of the rows but the last one.
  virtual std::vector<std::string> meanings() const = 0;
  /// Are its directions those of the world?
  virtual bool of_world() const = 0;
  /// The directions of the body that its formula depends on, as drawn.
  virtual std::vector<Vec3> axes() const = 0;
  /// 0 where it is not round.
  virtual double radius() const = 0;
  virtual std::vector<BodyShape> shapes(const Point& at) const = 0;

  /// At a tree that was placed; with rates one that moved and accelerated.
  virtual void rows(const Contact& contact, const Tree& tree, const Ground& ground, bool with_rates,
                    Row* out) const = 0;
  /// A xi - b of its rows, at a tree that moved with xi.
  virtual void velocities(const Contact& contact, const Tree& tree, const Ground& ground,
                          double* out) const = 0;
  /// phi of its last row, at a tree that was placed.
  virtual double height(const Contact& contact, const Tree& tree) const = 0;
  /// The point of contact with the ground, in the world.
  virtual Vec3 touch(const Contact& contact, const Tree& tree) const = 0;

  size_t directions() const { return directions_; }

 protected:
  explicit ContactModel(size_t directions) : directions_(directions) {}

 private:
  size_t directions_;
};
inline size_t Contact::row_count() const { return model->directions() + 1; }

/// A kind by its name, which is that of its tables in files.
struct ContactKind {
  std::string name, summary;
  std::vector<Field> fields;
  std::shared_ptr<const ContactModel> (*make)(const Parameters& values);
};
const std::vector<ContactKind>& contact_kinds();
/// Null where there is none.
const ContactKind* find_contact_kind(const std::string& name);

/// Inputs of the formula of a contact, seen from the root: as values, or with the rates along
/// the motion.
template <class T>
class ContactView {
  static constexpr bool has_rates = !std::is_same_v<T, double>;

 public:
  using Vector = VecT<T, 3>;

  ContactView(const ContactView&) = delete;
  ContactView& operator=(const ContactView&) = delete;
  ContactView(const Contact& contact, const Tree& tree)
      : body_(seen(contact.carrier, tree)), root_(tree.root_in_world(contact.link)) {
    if constexpr (has_rates) {
      against_ = tree.against_root(contact.carrier);
      root_twist_ = tree.root_twist(contact.link);
    }
    at =
        with_rate(body_.apply(contact.at), [&](const Vec3& x) { return velocity_at(against_, x); });
    vertical = world_axis(2);
  }

  Vector at;        // the contact's point of the body
  Vector vertical;  // upwards

  /// A direction of the body, as drawn.
  Vector turned(const Vec3& direction) const {
    return with_rate(body_.rotation.lazyProduct(direction),
                     [&](const Vec3& v) { return Vec3(upper(against_).cross(v)); });
  }
  /// The world's x, y or z.
  Vector world_axis(int i) const {
    return with_rate(root_.rotation.row(i).transpose(),
                     [&](const Vec3& v) { return Vec3(v.cross(upper(root_twist_))); });
  }

  Vector point_in_world(const Vector& q) const {
    if constexpr (has_rates)
      return dual(root_.apply(value(q)),
                  root_.rotation * (rate(q) + velocity_at(root_twist_, value(q))));
    else return root_.apply(q);
  }
  double height(const Vector& q) const { return root_.apply(value(q))[2]; }
  Vector direction_in_world(const Vector& u) const {
    if constexpr (has_rates)
      return dual(root_.rotation * value(u),
                  root_.rotation * (rate(u) + upper(root_twist_).cross(value(u))));
    else return root_.rotation.lazyProduct(u);
  }

 private:
  template <class Rate>
  static Vector with_rate(const Vec3& v, Rate&& rate) {
    if constexpr (has_rates) return dual(v, rate(v));
    else return v;
  }

  const Rigid& seen(int link, const Tree& tree) {
    const Rigid* const known = tree.known_from_root(link);
    return known != nullptr ? *known : found_.emplace(tree.from_root(link));
  }

  std::optional<Rigid> found_;
  const Rigid& body_;           // the carrier
  const Rigid& root_;           // in the world
  Twist against_, root_twist_;  // with rates
};

/// The point of contact, and the horizontal directions in which it does not slip.
template <class T, size_t n>
struct ContactPoint {
  static_assert(n < Contact::most_rows);
  static constexpr size_t count = n;
  VecT<T, 3> point;
  std::array<VecT<T, 3>, n> directions;
};

}  // namespace hamel::mechanisms
