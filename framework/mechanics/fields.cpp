#include <hamel/framework/mechanics/fields.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/lie/decompositions.hpp>

namespace hamel {
namespace {

template <class Test>
bool all_of(const std::vector<double>& values, Test test) {
  return std::all_of(values.begin(), values.end(), test);
}

// The principal moments of a rigid body, ascending; empty where the values are none.
std::vector<double> principal_moments(const Field& field) {
  const std::vector<double>& v = field.value;
  std::vector<double> out;
  if (field.range.transverse != 0) {
    out = {v[0], field.range.transverse, field.range.transverse};
  } else if (v.size() == 3) {
    out = v;
  } else if (v.size() == 6 || v.size() == 9) {
    const std::array<size_t, 9> upper = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    Mat<3, 3> matrix;
    for (size_t i = 0; i < 9; ++i)
      matrix(static_cast<int>(i / 3), static_cast<int>(i % 3)) = v[v.size() == 6 ? upper[i] : i];
    const Vec<3> values = dense::symmetric_eigenvalues(matrix);
    out.assign(values.begin(), values.end());
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

bool Range::allows(double x) const {
  if (!std::isfinite(x)) return false;
  return open ? x > least && x < most : x >= least && x <= most;
}

std::string Range::words() const {
  if (most < std::numeric_limits<double>::infinity())
    return fmt::format("in {}{}, {}{}", open ? "(" : "[", least, most, open ? ")" : "]");
  if (!std::isfinite(least)) return "";
  if (least == 0 && open) return "positive";
  return fmt::format("{} {}", open ? "above" : "at least", least);
}

std::vector<std::string> out_of_range(const std::string& system, const std::vector<Field>& fields) {
  std::vector<std::string> out;
  for (const Field& field : fields) {
    // The entries of a matrix may be of any sign; its definiteness is checked with the system's.
    const bool matrix = field.range.moments && field.value.size() > 3;
    const Range range = matrix ? any_number : field.range;
    if (!all_of(field.value, [&](double x) { return range.allows(x); }))
      out.push_back(fmt::format("parameter '{}' of {}: got {}, expected {}", field.name, system,
                                join(field.value),
                                range.words().empty() ? "finite numbers" : range.words()));
  }
  return out;
}

std::vector<std::string> no_rigid_body(const std::string& system,
                                       const std::vector<Field>& fields) {
  std::vector<std::string> out;
  for (const Field& field : fields) {
    if (!field.range.moments) continue;
    const std::vector<double> m = principal_moments(field);
    if (m.size() != 3 || m[2] <= (m[0] + m[1]) * (1 + 1e-9)) continue;
    out.push_back(
        fmt::format("parameter '{}' of {}: no rigid body has the principal moments {}, since {} > "
                    "{} + {}",
                    field.name, system, join(m), m[2], m[0], m[1]));
  }
  return out;
}

namespace detail {

void check_parameters(const std::string& system, const std::vector<Field>& fields,
                      const Parameters& given) {
  std::vector<std::string> mistakes, names;
  for (const Field& field : fields) names.push_back(field.name);
  for (const auto& [name, value] : given) {
    const auto field = std::find_if(fields.begin(), fields.end(),
                                    [&wanted = name](const Field& f) { return f.name == wanted; });
    if (field == fields.end()) {
      mistakes.push_back(unknown_name("parameter of " + system, name, names));
      continue;
    }
    const size_t expected = field->optional ? 1 : field->value.size();
    const bool left_out = field->optional && value.empty();
    const bool fits = field->any_length ? !value.empty() : left_out || value.size() == expected;
    if (!fits) {
      mistakes.push_back(
          fmt::format("parameter '{}' of {}: got {} value{}, expected {}", name, system,
                      value.size(), value.size() == 1 ? "" : "s",
                      field->any_length ? std::string("at least 1") : std::to_string(expected)));
    }
    if (!all_of(value, [](double x) { return std::isfinite(x); }))
      mistakes.push_back(
          fmt::format("parameter '{}' of {}: {} is not finite", name, system, join(value)));
  }
  if (!mistakes.empty()) throw ConfigError(mistakes);
}

}  // namespace detail
}  // namespace hamel
