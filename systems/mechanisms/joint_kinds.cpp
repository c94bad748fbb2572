// The kinds of joints by name, and what follows from their classes.
#include <hamel/systems/mechanisms/joint.hpp>

#include <hamel/groups/exp.hpp>
#include <hamel/systems/mechanisms/joints/ball_joint.hpp>
#include <hamel/systems/mechanisms/joints/chains.hpp>
#include <hamel/systems/mechanisms/joints/free_joint.hpp>
#include <hamel/systems/mechanisms/joints/hinge_joint.hpp>
#include <hamel/systems/mechanisms/joints/planar_joint.hpp>
#include <hamel/systems/mechanisms/joints/slider_joint.hpp>

namespace hamel::mechanisms {
namespace {

template <class Kind>
class JointOf final : public Joint {
 public:
  explicit JointOf(const Kind& kind)
      : Joint(group_info<typename Kind::Group>(), erased_geometry<Exp<typename Kind::Group>>(),
              Kind::columns(), Kind::rates(), kind.directions()),
        kind_(kind) {}
  Rigid motion(const double* element) const override {
    return kind_.motion(Packing<typename Kind::Group>::load(element));
  }
  bool has_axis() const override {
    if constexpr (requires { Kind::has_axis; }) return Kind::has_axis;
    else return true;
  }
  Rigid on_parent(const Rigid& on_child) const override {
    if constexpr (requires { Kind::on_parent(on_child); }) return Kind::on_parent(on_child);
    else return on_child;
  }

 private:
  std::vector<double> coordinates(const Rigid& motion) const override {
    if constexpr (requires { Kind::coordinates(motion); }) return Kind::coordinates(motion);
    else return group().identity;
  }
  Kind kind_;
};

// Joints without data share one object.
template <class Kind>
std::shared_ptr<const Joint> joint_of(const Parameters& values) {
  if constexpr (std::is_empty_v<Kind>) {
    static const auto only = std::make_shared<JointOf<Kind>>(Kind());
    return only;
  } else {
    return std::make_shared<JointOf<Kind>>(with_parameters<Kind>(values));
  }
}

template <class... Kinds>
JointKind chain(const std::string& name, TypeList<Kinds...>) {
  const auto make = [](const Parameters& values) {
    (void)values;
    return std::vector<std::shared_ptr<const Joint>>{joint_of<Kinds>(values)...};
  };
  return {name, {}, make, sizeof...(Kinds), false};
}

template <class Kind>
JointKind kind() {
  if constexpr (requires { typename Kind::Chain; }) {
    return chain(Kind::name(), typename Kind::Chain());
  } else {
    const auto make = [](const Parameters& values) {
      return std::vector<std::shared_ptr<const Joint>>{joint_of<Kind>(values)};
    };
    return {Kind::name(), fields_of<Kind>(), make, 1, Kind::Group::dim == 1};
  }
}

}  // namespace

const std::vector<JointKind>& joint_kinds() {
  static const std::vector<JointKind> all = {
      kind<BallJoint>(),    // so3
      kind<FreeJoint>(),    // se3
      kind<HingeJoint>(),   // so2
      kind<PlanarJoint>(),  // se2
      kind<SliderJoint>(),  // r1
      kind<UniversalJoint>(), kind<Weld>(),
  };
  return all;
}

const JointKind* find_joint_kind(const std::string& name) {
  for (const JointKind& kind : joint_kinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

std::string kinds_with_coordinate() {
  std::string out, last;
  for (const JointKind& kind : joint_kinds()) {
    if (!kind.has_coordinate) continue;
    if (!last.empty()) out += (out.empty() ? "" : ", ") + last;
    last = kind.name;
  }
  return out + " or " + last;
}

Joint::~Joint() = default;

std::vector<double> Joint::element_of(const Rigid& motion) const {
  std::vector<double> out(static_cast<size_t>(geometry_->size()));
  geometry_->from_coordinates(coordinates(motion), out.data());
  return out;
}

std::vector<int> Joint::turning() const {
  std::vector<int> out;
  for (int i = 0; i < dim(); ++i)
    if (!directions_.col(i).head<3>().isZero(0)) out.push_back(i);
  return out;
}

// About e3 x axis; of -e3 about e1.
Mat<3, 3> frame_along(const Vec3& axis) {
  const double x = axis[0], y = axis[1], z = axis[2], across = x * x + y * y;
  if (across == 0) return Vec3(1, z, z).asDiagonal();
  const double k = (1 - z) / across;
  return Mat<3, 3>{{1 - k * x * x, -k * x * y, x}, {-k * x * y, 1 - k * y * y, y}, {-x, -y, z}};
}

}  // namespace hamel::mechanisms
