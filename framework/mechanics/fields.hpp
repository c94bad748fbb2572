// The parameters of a system: what its member fields(f) states of each of them, and their checks.
//
//   f("radius", radius, "m", "radius of the disk", positive);   name, member, unit, meaning, range
//
// Meaning and range may be left out. A range holds for each entry; finite they must be in any case.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include <hamel/framework/lie/types.hpp>

namespace hamel {

/// The numbers that make physical sense.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool open = false;  // least and most themselves are left out
  // The moments of inertia of a rigid body: a note where one exceeds the sum of the other two. As 6 or 9
  // numbers the upper triangle or the rows of the matrix, whose eigenvalues are looked at.
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
};

/// The values out of their range, one mistake each.
std::vector<std::string> out_of_range(const std::string& system, const std::vector<Field>& fields);
/// What no rigid body can have among them: moments of inertia against the triangle inequality.
std::vector<std::string> no_rigid_body(const std::string& system, const std::vector<Field>& fields);

namespace detail {

// The visitors that a system's fields() meets.
struct FieldReader {
  std::vector<Field> fields;
  void operator()(const char* name, double& value, const char* unit, const char* meaning = "",
                  const Range& range = {}) {
    fields.push_back({name, {value}, unit, meaning, range});
  }
  void operator()(const char* name, std::vector<double>& value, const char* unit,
                  const char* meaning = "", const Range& range = {}) {
    fields.push_back({name, value, unit, meaning, range, true});
  }
  template <int N>
  void operator()(const char* name, Vec<N>& value, const char* unit, const char* meaning = "",
                  const Range& range = {}) {
    fields.push_back({name, std::vector<double>(value.begin(), value.end()), unit, meaning, range});
  }
};

struct FieldWriter {
  const Parameters& given;
  void operator()(const char* name, double& value, const char*, const char* = "",
                  const Range& = {}) {
    if (auto it = given.find(name); it != given.end()) value = it->second.front();
  }
  void operator()(const char* name, std::vector<double>& value, const char*, const char* = "",
                  const Range& = {}) {
    if (auto it = given.find(name); it != given.end()) value = it->second;
  }
  template <int N>
  void operator()(const char* name, Vec<N>& value, const char*, const char* = "",
                  const Range& = {}) {
    if (auto it = given.find(name); it != given.end())
      value = Eigen::Map<const Vec<N>>(it->second.data());
  }
};

/// Names, lengths and finiteness of given parameters against the fields; throws ConfigError.
void check_parameters(const std::string& system, const std::vector<Field>& fields,
                      const Parameters& given);

}  // namespace detail
}  // namespace hamel
