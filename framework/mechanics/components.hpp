// Units of the components of the body velocity and momentum, and of the coordinates; the
// coordinates that some components are the rates of.
//
// Each group states its own (GroupFactor, lie/group_info.hpp). Names: quantity_names.hpp.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/lie/group_info.hpp>

namespace hamel {

/// Of the momentum dual to it: a moment of momentum or a momentum; "" where it has no unit.
std::string unit_of_momentum(const Component& component);

/// Units of the element's columns; "" for the entries of a rotation matrix and where a factor
/// states none.
std::vector<std::string> units_of_element(const GroupInfo& group);

/// Coordinate `column` of the element is the integral of component `component`.
struct ShapeCoordinate {
  int column, component;
  std::string name, unit;
};

/// The coordinates of the factors that are shape: joint angles, and places that are no part of a
/// rigid motion.
std::vector<ShapeCoordinate> shape_of(const GroupInfo& group);

}  // namespace hamel
