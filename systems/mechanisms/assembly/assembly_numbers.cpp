// Assembly: numbers that no part can have. Numbers of a file are finite; a user's program may state
// any.
#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include <hamel/framework/run/names/registry.hpp>
#include <hamel/systems/mechanisms/assembly/assembly.hpp>

namespace hamel {

using namespace mechanisms;

namespace {

bool finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
}

// "" where this may be the value of a field.
std::string mistake(const Field& field, const std::vector<double>& value) {
  if (value.size() != field.value.size())
    return fmt::format("got {} numbers, expected {}", value.size(), field.value.size());
  if (is_direction(field)) {
    const double length = Vec3(value.data()).norm();
    if (length > 0 && std::isfinite(length)) return "";
    return fmt::format("got ({}), expected a direction", join(value));
  }
  const auto wrong = std::ranges::find_if(
      value, [&](double x) { return !std::isfinite(x) || !field.range.allows(x); });
  if (wrong == value.end()) return "";
  const std::string range = field.range.words();
  return fmt::format("got {}, expected a {}", *wrong,
                     range.empty()         ? "finite number"
                     : range == "positive" ? "positive number"
                                           : "number " + range);
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
  }
  for (const auto& part : parts_.loops_) {
    numbers(part, part.kind, "at", part.at);
    numbers(part, part.kind, "axis", part.axis);
  }
  for (const auto& part : parts_.sensors_) numbers(part, "sensor", "at", part.at);
  for (const auto& part : parts_.couplings_) {
    number(part, "coupling", "ratio", part.ratio);
    number(part, "coupling", "offset", part.offset);
  }
  for (const auto& part : parts_.forces_)
    if (!part.couple) numbers(part, "force", "at", part.at);
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

bool Assembly::check_values(const Part& part, const std::string& kind,
                            const std::vector<Field>& fields, const Parameters& values) {
  const size_t before = mistakes_.size();
  for (const auto& [name, value] : values) {
    const std::vector<std::string> known = names_of(fields);
    if (std::ranges::count(known, name) == 0) unknown(part, kind, "value", name, known);
  }
  for (const Field& field : fields) {
    const auto given = values.find(field.name);
    const std::vector<double>& value = given == values.end() ? field.value : given->second;
    if (const std::string text = mistake(field, value); !text.empty())
      wrong(part, kind, fmt::format("{}: {}", field.name, text));
  }
  return mistakes_.size() == before;
}

bool Assembly::check_level(const Mechanism::ContactPart& part, const std::vector<Field>& fields) {
  const size_t before = mistakes_.size();
  for (const Field& field : fields) {
    const auto given = part.values.find(field.name);
    if (!is_direction(field) || given == part.values.end()) continue;
    const Vec3 direction = Vec3(given->second.data()).normalized();
    if (direction.head<2>().norm() < 1e-6)
      wrong(part, part.kind,
            fmt::format("{}: is vertical, expected a direction across z", field.name));
  }
  return mistakes_.size() == before;
}

void Assembly::check_dimension() {
  int n = 0;
  for (const mechanisms::Link& link : links_) n += link.joint->dim();
  if (n > kMaxDimension)
    mistakes_.push_back(
        fmt::format("{}: dimension {}, expected at most {}", parts_.name_, n, kMaxDimension));
  if (n == 0 && mistakes_.empty()) {
    std::vector<std::string> moving;
    for (const JointKind& kind : joint_kinds())
      if (kind.joints > 0) moving.push_back(kind.name);
    mistakes_.push_back(fmt::format(
        "{}: nothing moves: every body is welded to the ground, expected a joint of a kind that "
        "moves ({})",
        parts_.name_, join(moving)));
  }
  stop_at_mistakes();
}

}  // namespace hamel
