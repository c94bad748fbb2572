// Parameters of a system as data: names, values, units and ranges. Standard-library types only.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include <hamel/framework/io/export.hpp>

namespace hamel {

/// The numbers that make physical sense.
struct HAMEL_API Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool open = false;  // least and most themselves are left out
  // The moments of inertia of a rigid body: a note where one exceeds the sum of the other two. As 6
  // or 9 numbers the upper triangle or the rows of the matrix, whose eigenvalues are looked at.
  bool moments = false;
  double transverse = 0;  // of one moment: that about both other axes

  bool allows(double x) const;
  /// "positive", "at least 0", "in [1, 60]"; "" for all finite numbers.
  std::string words() const;
};
inline constexpr Range any_number{};
inline constexpr Range positive{.least = 0, .open = true};
inline constexpr Range non_negative{.least = 0};
inline constexpr Range moments_of_inertia{.least = 0, .open = true, .moments = true};
constexpr Range between(double least, double most) { return {.least = least, .most = most}; }
/// The moment about the axis of a body with equal moments about the two others.
constexpr Range axial_moment(double transverse) {
  return {.least = 0, .open = true, .moments = true, .transverse = transverse};
}

using Parameters = std::map<std::string, std::vector<double>>;

/// One parameter of a system, as its fields() states it.
struct Field {
  std::string name;
  std::vector<double> value;
  std::string unit;
  std::string meaning;
  Range range;
  bool any_length = false;  // a list whose length the system itself checks
  bool optional = false;    // may be left out: value is empty then
};

/// The values out of their range, one mistake each.
std::vector<std::string> out_of_range(const std::string& system, const std::vector<Field>& fields);
/// Values that no rigid body can have: moments of inertia against the triangle inequality.
std::vector<std::string> no_rigid_body(const std::string& system, const std::vector<Field>& fields);

}  // namespace hamel
