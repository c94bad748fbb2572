#include <hamel/systems/mechanisms/joint.hpp>

#include <cmath>

#include <Eigen/Geometry>

#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/geometries.hpp>

namespace hamel::mechanisms {
namespace {

template <class G>
JointType make(std::vector<std::string> columns, std::vector<std::string> rates) {
  WithExp erased = with_exp<G>();
  return {std::move(erased.group), std::move(erased.geometry), std::move(columns),
          std::move(rates)};
}

}  // namespace

const JointType& type_of(JointKind kind) {
  static const JointType free = make<SE3>(SE3::columns(), {"w1", "w2", "w3", "v1", "v2", "v3"}),
                         planar = make<SE2>(SE2::columns(), {"omega", "v1", "v2"}),
                         hinge = make<SO2>({"angle"}, {"rate"}),
                         slider = make<Rn<1>>({"position"}, {"rate"}),
                         ball = make<SO3>(SO3::columns(), {"w1", "w2", "w3"});
  switch (kind) {
    case JointKind::free: return free;
    case JointKind::planar: return planar;
    case JointKind::hinge: return hinge;
    case JointKind::slider: return slider;
    case JointKind::ball: break;
  }
  return ball;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> directions(JointKind kind) {
  const auto axes = [](std::initializer_list<int> rows) {
    Eigen::Matrix<double, 6, Eigen::Dynamic> s =
        Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, static_cast<Eigen::Index>(rows.size()));
    Eigen::Index column = 0;
    for (const int row : rows) s(row, column++) = 1;
    return s;
  };
  switch (kind) {
    case JointKind::free: return axes({0, 1, 2, 3, 4, 5});
    case JointKind::planar: return axes({2, 3, 4});
    case JointKind::hinge: return axes({2});
    case JointKind::slider: return axes({5});
    case JointKind::ball: break;
  }
  return axes({0, 1, 2});
}

Rigid motion(JointKind kind, const double* element) {
  const auto turn = [](double c, double s) { return Mat<3, 3>{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}; };
  switch (kind) {
    case JointKind::free: {
      const auto g = Packing<SE3>::load(element);
      return {g.rotation, g.translation};
    }
    case JointKind::planar: {
      const auto g = Packing<SE2>::load(element);
      return {turn(g.rotation.c, g.rotation.s), Vec3(g.translation[0], g.translation[1], 0)};
    }
    case JointKind::hinge: {
      const auto g = Packing<SO2>::load(element);
      return {turn(g.c, g.s), Vec3::Zero()};
    }
    case JointKind::slider: return {Mat<3, 3>::Identity(), Vec3(0, 0, element[0])};
    case JointKind::ball: break;
  }
  return {Packing<SO3>::load(element), Vec3::Zero()};
}

Mat<3, 3> frame_along(const Vec3& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis).toRotationMatrix();
}

}  // namespace hamel::mechanisms
