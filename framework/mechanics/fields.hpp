// The parameters of a system: what its member fields(f) states of each of them, and their checks.
//
//   f("radius", radius, "m", "radius of the disk", positive);   name, member, unit, meaning, range
//
// A std::optional<double> is a parameter that may be left out. Meaning and range may be left out. A
// range holds for each entry; finite they must be in any case.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/lie/types.hpp>
#include <hamel/framework/mechanics/parameters.hpp>

namespace hamel {

namespace detail {

// The visitors passed to a system's fields().
struct FieldReader {
  std::vector<Field> fields;
  void operator()(const char* name, double& value, const char* unit, const char* meaning = "",
                  const Range& range = {}) {
    fields.push_back({name, {value}, unit, meaning, range});
  }
  void operator()(const char* name, std::optional<double>& value, const char* unit,
                  const char* meaning = "", const Range& range = {}) {
    fields.push_back({name, {}, unit, meaning, range, false, true});
    if (value) fields.back().value = {*value};
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
  void operator()(const char* name, std::optional<double>& value, const char*, const char* = "",
                  const Range& = {}) {
    if (auto it = given.find(name); it == given.end()) return;
    else if (it->second.empty()) value.reset();
    else value = it->second.front();
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
