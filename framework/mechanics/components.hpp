// Names and units of the components of the body velocity, and of the coordinates that some of them are the rates of.
//
// They follow from the group: omega1..3 [rad/s] of so3, omega, v1, v2 of se2, omega1..3, v1..3 of se3, angle' of
// so2, x', y', z' [m/s] of rn and heisenberg, with the number of the factor behind them where a product has several alike.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/lie/group_info.hpp>

namespace hamel {

/// A factor of a product that is none itself.
struct SimpleFactor {
  std::string name;  // "se2"
  int dim = 0, columns = 0;
  bool shape = false;  // its coordinates are the integrals of its components
};

/// The factors of "se2*so2^5"; none where one of them is not so2, so3, se2, se3, heisenberg or rn.
std::vector<SimpleFactor> simple_factors(const GroupInfo& group);

struct Component {
  std::string name;  // "omega"; the rate of a coordinate ends in ': "pitch'"
  std::string unit;  // "rad/s"
};

/// The names that follow from the group, dim of them; "se2*so2^2" is read factor by factor. Other groups: xi1, xi2, …
/// without units.
std::vector<Component> components_of(const GroupInfo& group);

/// Units of the element's columns, as many, where they follow from the group; "" for the entries of a rotation matrix.
std::vector<std::string> units_of_element(const GroupInfo& group);

/// Coordinate `column` of the element is the integral of component `component`: its name without the ', its unit without
/// the "/s".
struct ShapeCoordinate {
  int column, component;
  std::string name, unit;
};

/// The coordinates of the factors so2 and rn of a group: the shape, and places that are no part of a rigid motion.
std::vector<ShapeCoordinate> shape_of(const GroupInfo& group,
                                      const std::vector<Component>& components);

}  // namespace hamel
