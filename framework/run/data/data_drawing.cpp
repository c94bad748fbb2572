#include <hamel/framework/run/data/data_drawing.hpp>

#include <utility>

namespace hamel {
namespace {

// The nine entries of a rotation, or one angle, or none.
Placement placement(std::span<const double> at, std::span<const double> turn) {
  Placement out = planar(at[0], at[1], turn.size() == 1 ? turn[0] : 0, at[2]);
  for (size_t i = 0; turn.size() == 9 && i < 9; ++i)
    out.rotation(static_cast<int>(i / 3), static_cast<int>(i % 3)) = turn[i];
  return out;
}

std::vector<double> values_of(const std::vector<Expression>& formulas,
                              std::span<const double> coordinates) {
  std::vector<double> out;
  for (const Expression& formula : formulas) out.push_back(formula(coordinates));
  return out;
}

}  // namespace

void DataDrawing::read(const toml::node& node, Drawing& out) {
  const toml::array* array = node.as_array();
  if (array == nullptr || !array->is_array_of_tables())
    return read_.wrong(node, "draw", "tables, each headed [[draw]]");
  for (const toml::node& entry : *array) out.bodies.push_back(body(*entry.as_table()));
}

DrawnBody DataDrawing::body(const toml::table& table) {
  DrawnBody out;
  std::vector<Expression> at, turn;
  for (const auto& [name, node] : table) {
    const std::string word(name.str()), key = "draw." + word;
    if (word == "name") {
      read_.value(node, key, out.name);
    } else if (word == "at") {
      at = formulas(node, key, 3);
    } else if (word == "rotation") {
      turn = formulas(node, key, 9);
    } else if (word == "heading") {
      if (auto angle = formulas_.expression(node, key, coordinates_))
        turn.push_back(std::move(*angle));
    } else if (word == "trail") {
      out.trail(point(node, key));
    } else if (word == "shapes") {
      const toml::array* shapes = node.as_array();
      if (shapes == nullptr) read_.wrong(node, key, "a list of shapes");
      else
        for (const toml::node& entry : *shapes) out.shapes.push_back(shape(entry));
    } else {
      read_.unknown_key(node, word, {"name", "at", "heading", "rotation", "trail", "shapes"});
    }
  }
  if (table.contains("heading") && table.contains("rotation"))
    read_.wrong(table, "draw", "heading or rotation, not both");
  if (at.size() != 3) {
    if (!table.contains("at")) read_.wrong(table, "draw.at", "three formulas of the coordinates");
    return out;
  }
  out.place = [at, turn](std::span<const double> coordinates) {
    return placement(values_of(at, coordinates), values_of(turn, coordinates));
  };
  return out;
}

BodyShape DataDrawing::shape(const toml::node& node) {
  BodyShape out;
  const toml::table* table = node.as_table();
  if (table == nullptr) {
    read_.wrong(node, "draw.shapes", "tables, { box = [...] }");
    return out;
  }
  for (const auto& [name, value] : *table) {
    const std::string word(name.str()), key = "draw.shapes." + word;
    if (word == "at" || word == "axis") {
      (word == "at" ? out.look.at : out.look.axis) = point(value, key);
      continue;
    }
    if (word == "color") {
      read_.value(value, key, out.look.color);
      continue;
    }
    if (word == "box" || word == "ellipsoid") out.sizes = formulas_.numbers(value, key, 3);
    else if (word == "cylinder" || word == "wheel") out.sizes = formulas_.numbers(value, key, 2);
    else if (word == "sphere") out.sizes = {formulas_.number(value, key)};
    else if (word == "arrow") out.points = {point(value, key)};
    else if (word == "line") {
      if (const toml::array* corners = value.as_array())
        for (const toml::node& corner : *corners) out.points.push_back(point(corner, key));
      else read_.wrong(value, key, "a list of points");
    } else {
      read_.unknown_key(value, word,
                        {"box", "ellipsoid", "cylinder", "wheel", "sphere", "arrow", "line", "at",
                         "axis", "color"});
      continue;
    }
    if (!out.kind.empty()) read_.wrong(value, key, "one shape in each table");
    out.kind = word;
  }
  if (out.kind.empty()) read_.wrong(node, "draw.shapes", "a shape, { box = [...] }");
  return out;
}

Point DataDrawing::point(const toml::node& node, const std::string& key) {
  const std::vector<double> x = formulas_.numbers(node, key, 3);
  return {x[0], x[1], x[2]};
}

std::vector<Expression> DataDrawing::formulas(const toml::node& node, const std::string& key,
                                              size_t count) {
  std::vector<Expression> out;
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != count) {
    read_.wrong(node, key, fmt::format("{} formulas of the coordinates", count));
    return out;
  }
  for (const toml::node& entry : *array) {
    if (auto formula = formulas_.expression(entry, key, coordinates_))
      out.push_back(std::move(*formula));
  }
  return out;
}

}  // namespace hamel
