// Kinds of joints and contacts state their data as systems do (framework/mechanics/fields.hpp):
//   void fields(auto& f) { f("radius", radius, "m", "of the disk", positive); }
// A member of type Vec3 is a direction, of length 1 in the kind; three numbers with a unit are a
// list.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/mechanics/fields.hpp>

namespace hamel::mechanisms {

/// The names of kinds, or of fields.
template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> out;
  for (const Named& one : all) out.push_back(one.name);
  return out;
}

inline bool is_direction(const Field& field) {
  return field.value.size() == 3 && field.unit.empty();
}

template <class Kind>
std::vector<Field> fields_of(Kind kind = {}) {
  detail::FieldReader reader;
  if constexpr (requires { kind.fields(reader); }) kind.fields(reader);
  return std::move(reader.fields);
}

/// Fields without a value keep their defaults.
template <class Kind>
Kind with_parameters(const Parameters& given) {
  Kind out;
  detail::FieldWriter writer{given};
  if constexpr (requires { out.fields(writer); }) out.fields(writer);
  const auto normalise = [](const char*, auto& member, auto&&...) {
    if constexpr (requires { member.normalize(); }) member.normalize();
  };
  if constexpr (requires { out.fields(normalise); }) out.fields(normalise);
  return out;
}

}  // namespace hamel::mechanisms
