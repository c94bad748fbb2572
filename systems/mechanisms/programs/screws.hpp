// Vectors, poses and inertias of recorded numbers.
#pragma once

#include <hamel/framework/graph/number.hpp>
#include <hamel/framework/lie/types.hpp>
#include <hamel/systems/mechanisms/screw.hpp>

namespace hamel::mechanisms {

using graph::Number;
using NumberVec3 = VecT<Number, 3>;
using NumberMat3 = MatT<Number, 3, 3>;

inline NumberVec3 numbers(const Vec3& v) { return v.cast<Number>(); }
inline NumberMat3 numbers(const Mat<3, 3>& m) { return m.cast<Number>(); }
inline NumberVec3 cross(const NumberVec3& a, const NumberVec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Number dot(const NumberVec3& a, const NumberVec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// x -> rotation x + position (screw.hpp).
struct Pose {
  NumberMat3 rotation = numbers(Mat<3, 3>(Mat<3, 3>::Identity()));
  NumberVec3 position = numbers(Vec3(Vec3::Zero()));

  NumberVec3 turn(const NumberVec3& u) const { return rotation.lazyProduct(u); }
  NumberVec3 turn_back(const NumberVec3& u) const { return rotation.transpose().lazyProduct(u); }
  NumberVec3 apply(const NumberVec3& x) const { return turn(x) + position; }
};
inline Pose operator*(const Pose& x, const Pose& y) {
  return {x.rotation.lazyProduct(y.rotation), x.apply(y.position)};
}
inline Pose numbers(const Rigid& x) { return {numbers(x.rotation), numbers(x.position)}; }

/// R S R^T of a symmetric S, symmetric to the last bit.
inline NumberMat3 turned_symmetric(const NumberMat3& rotation, const NumberMat3& s) {
  const NumberMat3 half = rotation.lazyProduct(s);
  NumberMat3 out;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      out(i, j) =
          half(i, 0) * rotation(j, 0) + half(i, 1) * rotation(j, 1) + half(i, 2) * rotation(j, 2);
      out(j, i) = out(i, j);
    }
  }
  return out;
}

}  // namespace hamel::mechanisms
