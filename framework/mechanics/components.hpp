// Names and units of the components of the body velocity, and of the coordinates that some of them
// are the rates of.
//
// Each group states its own (GroupFactor, lie/group_info.hpp): omega, v1, v2 of the motions of the
// plane. A product that has several factors alike writes the number of the factor behind them:
// angle_2'.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/lie/group_info.hpp>

namespace hamel {

/// The names of dim components, factor by factor; xi1, xi2, ... without units where a factor states
/// none.
std::vector<Component> components_of(const GroupInfo& group);

/// Of the momentum dual to it: a moment of momentum or a momentum; "" where it has no unit.
std::string unit_of_momentum(const Component& component);

/// Units of the element's columns; "" for the entries of a rotation matrix and where a factor
/// states none.
std::vector<std::string> units_of_element(const GroupInfo& group);

/// Coordinate `column` of the element is the integral of component `component`: its name without
/// the ', its unit without the "/s".
struct ShapeCoordinate {
  int column, component;
  std::string name, unit;
};

/// The coordinates of the factors that are shape: joint angles, and places that are no part of a
/// rigid motion.
std::vector<ShapeCoordinate> shape_of(const GroupInfo& group,
                                      const std::vector<Component>& components);

}  // namespace hamel
