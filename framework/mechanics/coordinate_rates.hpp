// From derivatives by the coordinates of an element to derivatives along the group.
//
// C(g) takes a body velocity xi to the rates of the coordinates (CSV columns). Each factor of the
// group states its own (GroupFactor, lie/group_info.hpp): of the motions of the plane theta' =
// omega, (x, y)' = R v. Where one states none, differences of order 6 replace them for the whole
// group.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/lie/group_info.hpp>

namespace hamel {

class CoordinateRates {
 public:
  CoordinateRates(const GroupInfo& group, std::shared_ptr<const Geometry> geometry);
  /// out += C(g)^T slope; coordinates are those of g.
  void add_pulled_back(const double* g, const double* coordinates, const double* slope,
                       Eigen::Ref<Eigen::VectorXd> out) const;
  /// out = C(g) xi; false, and nothing, where C is by differences only.
  bool along(const double* coordinates, const double* xi, double* out) const;

 private:
  void by_differences(const double* g, const double* slope, Eigen::Ref<Eigen::VectorXd> out) const;

  std::vector<GroupFactor> factors_;  // none: differences
  std::shared_ptr<const Geometry> geometry_;
};

}  // namespace hamel
