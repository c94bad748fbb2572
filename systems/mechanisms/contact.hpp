// A contact of a body with the ground: where it touches, the directions in which it does not slip.
//
// With q the point of contact, gamma the vertical, seen from the root, and u a horizontal direction
// in which the contact does not slip, its rows are
//   u . (v + omega x q) = u . v_ground(q),    and where the height z(q) may change, z(q) = 0, whose
//   differential is gamma . (v + omega x q): q may move in the body, but only along the ground.
// Each kind is one class of the folder contacts/, listed in contact_kinds.cpp, with one formula for
// q and u, of which the rows at one place (T = double) and their programs (T = graph::Number,
// programs/row_formulas.hpp) follow:
//   struct Blade {                                   // may have members, stated in fields(f)
//     static std::string name(), summary();          // in files: [[blade]]; for the schema
//     static std::vector<std::string> meanings();    // of the directions: "does not slip across"
//     template <class T>
//     ContactPoint<T, 1> touch(const ContactView<T>& view) const;
//     std::vector<BodyShape> shapes(const Point& at) const;   // for the page
//   };
// and, where its directions are those of the world instead of following the body,
//   static constexpr bool of_world = true;
// or where its formula depends on directions of the body that are no members,
//   std::vector<Vec3> axes() const;
// and, where its values may not fit together, a message for that,
//   std::string flaw() const;
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/mechanics/drawing.hpp>
#include <hamel/systems/mechanisms/kind.hpp>
#include <hamel/systems/mechanisms/tree.hpp>

namespace hamel::graph {
class Number;
}

namespace hamel::mechanisms {

struct RecordedContact;  // programs/contact_view.hpp
template <class T>
class ContactView;

/// The ground moves with this velocity, and turns about the world's origin; or is a surface at
/// rest, z = height(x, y) (ground_contact.hpp).
struct Ground {
  double rate = 0;               // rad/s
  Vec3 velocity = Vec3::Zero();  // m/s
  std::optional<Expression> height = {};
  bool moves() const { return rate != 0 || !velocity.isZero(0); }
};

/// Row: a wrench on a link, and for loops the opposite one on another; or a unit row; or, of a
/// coupling, coefficients of velocities; b and phi.
struct Row {
  int link = kGround, other = kGround;
  Wrench wrench = Wrench::Zero(), other_wrench;  // this one where there is another link
  int dof = -1;
  std::vector<std::pair<int, double>> coefficients = {};
  double drift = 0, phi = 0;
};

class ContactModel;

struct Contact {
  static constexpr size_t most_rows = 3;

  std::string name;
  std::shared_ptr<const ContactModel> model;
  int link = 0;
  Vec3 at = Vec3::Zero();  // as drawn
  // The link, or its parent where the link's own turning changes nothing: a wheel. Found by
  // ConstraintRows::find_links.
  int carrier = 0;
  bool slips = false;  // may it slide, and open?

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
  /// Its values, each within its range, that do not fit together; "" for none.
  virtual std::string flaw() const = 0;

  /// At a tree that was placed.
  virtual void rows(const Contact& contact, const Tree& tree, const Ground& ground,
                    Row* out) const = 0;
  /// The point of contact with the ground, in the world.
  virtual Vec3 touch(const Contact& contact, const Tree& tree, const Ground& ground) const = 0;
  /// x and y of the point of a ground with a height that is next to it; NaN where there is none.
  virtual Vec<2> foot(const Contact& contact, const Tree& tree, const Ground& ground) const = 0;
  virtual RecordedContact record(const ContactView<graph::Number>& view,
                                 const Ground& ground) const = 0;

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

/// Inputs of the formula of a contact, seen from the root.
template <>
class ContactView<double> {
 public:
  using Vector = Vec3;

  ContactView(const Contact& contact, const Tree& tree)
      : at(tree.from_root(contact.carrier).apply(contact.at)),
        body_(tree.from_root(contact.carrier)),
        root_(tree.root_in_world(contact.link)) {
    vertical = world_axis(2);
  }

  Vector at;             // the contact's point of the body
  Vector vertical;       // upwards, across the ground
  bool sloping = false;  // is that another direction than the world's z?

  /// A direction of the body, as drawn.
  Vector turned(const Vec3& direction) const { return body_.rotation.lazyProduct(direction); }
  /// The world's x, y or z.
  Vector world_axis(int i) const { return root_.rotation.row(i).transpose(); }
  Vector point_in_world(const Vector& q) const { return root_.apply(q); }
  Vector direction_in_world(const Vector& u) const { return root_.rotation.lazyProduct(u); }

 private:
  const Rigid &body_, &root_;  // the carrier; the root in the world
};

/// The world's x, or on sloping ground the direction along it that is next to it.
template <class T>
VecT<T, 3> level_axis(const ContactView<T>& view) {
  const VecT<T, 3> x = view.world_axis(0);
  if (!view.sloping) return x;
  const VecT<T, 3> along = x - x.dot(view.vertical) * view.vertical;
  using std::sqrt;
  return (T(1.0) / sqrt(along.squaredNorm())) * along;
}

/// The point of contact, and the horizontal directions in which it does not slip.
template <class T, size_t n>
struct ContactPoint {
  static_assert(n < Contact::most_rows);
  static constexpr size_t count = n;
  VecT<T, 3> point;
  std::array<VecT<T, 3>, n> directions;
};

}  // namespace hamel::mechanisms
