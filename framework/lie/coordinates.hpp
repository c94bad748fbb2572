// An element as the numbers of a trajectory file, and the checks common to every from_coordinates.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace hamel {

/// The coordinates of an element. Their number is fixed, so that a step that reads them allocates
/// nothing.
template <class T, std::size_t N>
struct Coordinates : std::array<T, N> {
  static constexpr std::size_t count = N;
  operator std::vector<T>() const { return {this->begin(), this->end()}; }
};

/// A component of the body velocity. The rate of a coordinate ends in ': "pitch'".
struct Component {
  std::string name;        // "omega"
  std::string unit;        // "rad/s"
  std::string other = "";  // a further name that is read
};

/// The names of each factor one after another, with the number of the factor in front of a name
/// that another factor has too: theta x y and theta -> 1_theta x y 2_theta.
std::vector<std::string> number_repeated(const std::vector<std::vector<std::string>>& factors);

/// How many coordinates an element of G has.
template <class G>
inline constexpr std::size_t coordinate_count =
    decltype(G::coordinates(G::template identity<double>()))::count;

/// A number as text, all digits ("0.10000000000000001").
inline std::string to_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// Throws std::invalid_argument: "so3: 8 values, expected 9 (R11, R12, ...)" or
/// "so3: R12 = nan, expected a finite number".
template <class G>
void check_coordinates(std::span<const double> values) {
  const auto bad =
      std::find_if(values.begin(), values.end(), [](double x) { return !std::isfinite(x); });
  if (values.size() == coordinate_count<G> && bad == values.end()) return;
  const std::vector<std::string> columns = G::columns();
  if (values.size() != columns.size()) {
    std::string list;
    for (const auto& column : columns) list += (list.empty() ? "" : ", ") + column;
    throw std::invalid_argument(G::name() + ": " + std::to_string(values.size()) +
                                " values, expected " + std::to_string(columns.size()) + " (" +
                                list + ")");
  }
  throw std::invalid_argument(G::name() + ": " +
                              columns[static_cast<std::size_t>(bad - values.begin())] + " = " +
                              to_text(*bad) + ", expected a finite number");
}

/// The element nearest to finite values that are not one, as after a Runge-Kutta stage. A group
/// whose from_coordinates refuses such values defines nearest(values).
template <class G>
typename G::template Element<double> nearest_element(std::span<const double> values) {
  if constexpr (requires { G::nearest(values); }) return G::nearest(values);
  else return G::from_coordinates(values);
}

}  // namespace hamel
