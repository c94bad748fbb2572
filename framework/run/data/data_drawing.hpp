// The drawing of a system by data, its tables [[draw]]. Not installed.
//
//   [[draw]]
//   name = "skate"
//   at = ["x", "y", 0.05]     # formulas of the coordinates, m
//   heading = "theta"         # about the vertical; or rotation = [nine formulas, row after row]
//   trail = [0, 0, 0]         # the point whose path is drawn; left out: none
//   shapes = [{ box = [0.3, 0.1, 0.1], at = [0, 0, 0], axis = [0, 0, 1], color = "accent" }]
// Shapes: box = [edges], ellipsoid = [radii], cylinder = [radius, length], sphere = radius, arrow =
// [tip], line = [[point], ...].
#pragma once

#include <array>
#include <string>
#include <vector>

#include <hamel/framework/io/toml_formulas.hpp>
#include <hamel/framework/mechanics/drawing.hpp>

namespace hamel {

class DataDrawing {
 public:
  DataDrawing(TomlReader& read, TomlFormulas& formulas, const std::vector<std::string>& coordinates)
      : read_(read), formulas_(formulas), coordinates_(coordinates) {}
  void read(const toml::node& node, Drawing& out);

 private:
  DrawnBody body(const toml::table& table);
  BodyShape shape(const toml::node& node);
  Point point(const toml::node& node, const std::string& key);
  std::vector<Expression> formulas(const toml::node& node, const std::string& key, size_t count);

  TomlReader& read_;
  TomlFormulas& formulas_;
  const std::vector<std::string>& coordinates_;
};

}  // namespace hamel
