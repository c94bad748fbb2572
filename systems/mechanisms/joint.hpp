// A joint of a mechanism: a group, its embedding in the motions of space, the names of its numbers.
//
// xi of a joint is its left-trivialised velocity, so that the child moves against the parent with
// the twist S xi in the joint's frame on the child, S constant. The frame's third axis is that of
// the joint. Each kind is one class of the folder joints/, listed in joint_kinds.cpp:
//   struct Hinge {                                   // may have members, stated in fields(f)
//     using Group = SO2;                             // r1, so2, so3, se2, se3
//     static std::string name();                     // in files: kind = "hinge"
//     static std::vector<std::string> columns(), rates();   // names of coordinates and velocities
//     Mat<6, 1> directions() const;                  // S: the twist of the child per unit velocity
//     Rigid motion(const SO2Element<double>& g) const;
//   };
// with, where it is not as usual,
//   static constexpr bool has_axis = false;          // its frame has the axes of the drawn pose
//   static Rigid on_parent(const Rigid& on_child);   // its frame on the parent as drawn
//   static std::vector<double> coordinates(const Rigid& motion);   // that it has as drawn
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/lie/group_info.hpp>
#include <hamel/systems/mechanisms/kind.hpp>
#include <hamel/systems/mechanisms/screw.hpp>

namespace hamel::mechanisms {

class Joint {
 public:
  using Directions = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  virtual ~Joint();  // no other object may need the vtable (tools/cmake/localise)
  const GroupInfo& group() const { return group_; }
  /// With exp: to move about when a mechanism is put together.
  const std::shared_ptr<const Geometry>& geometry() const { return geometry_; }
  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<std::string>& rates() const { return rates_; }
  /// S, 6 x dim.
  const Directions& directions() const { return directions_; }
  int dim() const { return static_cast<int>(directions_.cols()); }

  /// The motion that an element, as Packing lays it out, represents.
  virtual Rigid motion(const double* element) const = 0;
  /// Does its axis matter?
  virtual bool has_axis() const = 0;
  /// Its frame on the parent as drawn, from that on the child; usually the same.
  virtual Rigid on_parent(const Rigid& on_child) const = 0;
  /// The element with this motion, that of the drawn pose.
  std::vector<double> element_of(const Rigid& motion) const;

  /// The coordinate of a joint that has one.
  double coordinate(const double* element) const {
    double out = 0;
    geometry_->coordinates(element, &out);
    return out;
  }
  /// The velocities that turn the child.
  std::vector<int> turning() const;
  /// Has one velocity, which turns about the axis: full turns change nothing.
  bool only_turns() const { return dim() == 1 && directions_.bottomRows(3).isZero(0); }
  /// Has one velocity, which slides: its effort is a force.
  bool only_slides() const { return dim() == 1 && turning().empty(); }
  /// Some velocities turn and others slide: the root of a vehicle.
  bool turns_and_slides() const {
    const auto count = static_cast<int>(turning().size());
    return count > 0 && count < dim();
  }

 protected:
  Joint(GroupInfo group, std::shared_ptr<const Geometry> geometry, std::vector<std::string> columns,
        std::vector<std::string> rates, Directions directions)
      : group_(std::move(group)),
        geometry_(std::move(geometry)),
        columns_(std::move(columns)),
        rates_(std::move(rates)),
        directions_(std::move(directions)) {}
  virtual std::vector<double> coordinates(const Rigid& motion) const = 0;

 private:
  GroupInfo group_;
  std::shared_ptr<const Geometry> geometry_;
  std::vector<std::string> columns_, rates_;
  Directions directions_;
};

/// A kind by its name in files: one joint, or several one behind the other with massless links
/// between them, the first of them about `axis`, the second about `axis2`.
struct JointKind {
  std::string name;
  std::vector<Field> fields;
  std::vector<std::shared_ptr<const Joint>> (*make)(const Parameters& values);
  int joints = 1;
  bool has_coordinate = false;  // one velocity: springs, motors and prescribed motions
};
const std::vector<JointKind>& joint_kinds();
/// Null where there is none.
const JointKind* find_joint_kind(const std::string& name);
/// "hinge or slider": the kinds with one velocity.
std::string kinds_with_coordinate();

/// Turning about the third axis.
inline Mat<3, 3> turn(double c, double s) { return Mat<3, 3>{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}; }

/// A rotation that takes e3 to this axis, of length 1.
Mat<3, 3> frame_along(const Vec3& axis);

}  // namespace hamel::mechanisms
