// Assembly: numbers that no part can have. Those of a file are finite; a user's program may state
// any.
#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include <hamel/framework/run/names/registry.hpp>
#include <hamel/systems/mechanisms/assembly.hpp>

namespace hamel {
namespace {

bool finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
}

}  // namespace

void Assembly::check_numbers() {
  const auto numbers = [&](const Part& part, const std::string& kind, const char* what,
                           std::span<const double> values) {
    if (!finite(values))
      wrong(part, kind, fmt::format("{}: got {}, expected finite numbers", what, join(values)));
  };
  const auto number = [&](const Part& part, const std::string& kind, const char* what,
                          const double& value) {
    numbers(part, kind, what, {&value, 1});
  };
  for (const auto& part : parts_.bodies_) {
    numbers(part, "body", "at", part.at);
    numbers(part, "body", "inertia", part.inertia);
  }
  const auto springs = [&](const auto& part, const std::string& kind, double rest) {
    number(part, kind, "stiffness", part.stiffness);
    number(part, kind, "rest", rest);
    number(part, kind, "damping", part.damping);
  };
  for (const auto& part : parts_.joints_) {
    numbers(part, "joint", "at", part.at);
    springs(part, "joint", part.rest);
  }
  for (const auto& part : parts_.springs_) {
    numbers(part, "spring", "from", part.from);
    numbers(part, "spring", "to", part.to);
    springs(part, "spring", part.rest.value_or(0));
  }
  for (const auto& part : parts_.contacts_) {
    numbers(part, part.kind, "at", part.at);
    number(part, part.kind, "angle", part.angle);
  }
  for (const auto& part : parts_.loops_) {
    numbers(part, "loop", "at", part.at);
    numbers(part, "loop", "axis", part.axis);
  }
  for (const auto& part : parts_.forces_) numbers(part, "force", "at", part.at);
  for (const auto& part : parts_.start_) number(part, "start", "value", part.value);
  const auto of_all = [&](const char* what, std::span<const double> values) {
    if (!finite(values))
      mistakes_.push_back(
          fmt::format("{}: {}: got {}, expected finite numbers", parts_.name_, what, join(values)));
  };
  of_all("gravity", parts_.gravity_);
  of_all("ground's rate", {&parts_.ground_rate_, 1});
  of_all("ground's velocity", parts_.ground_velocity_);
  const auto range = [&](const Part& part, const std::string& kind, const Range& given) {
    if (!(given.least <= given.most))
      wrong(part, kind, fmt::format("least {} is more than most {}", given.least, given.most));
  };
  for (const auto& part : parts_.motors_) range(part, "motor", part.range);
  for (const auto& part : parts_.rates_) range(part, "prescribed", part.range);
  for (const auto& part : parts_.inputs_) range(part, "input", part.field.range);
}

void Assembly::check_dimension() {
  int n = 0;
  for (const mechanisms::Link& link : links_) n += mechanisms::type_of(link.kind).group.dim;
  if (n > kMaxDimension)
    mistakes_.push_back(
        fmt::format("{}: dimension {}, expected at most {}", parts_.name_, n, kMaxDimension));
  stop_at_mistakes();
}

}  // namespace hamel
