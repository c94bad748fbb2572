#include <hamel/framework/io/errors.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

extern "C" const int HAMEL_CONTAINERS_ARE = 1;

namespace hamel {
namespace {

// Levenshtein distance: insertions, deletions, substitutions.
size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row.back();
}

// x1_2 of x1, steer.angle of angle: two letters or more that begin the name, or are its last word.
bool is_part(const std::string& given, const std::string& name) {
  if (given.size() < 2 || given.size() >= name.size()) return false;
  const size_t before = name.size() - given.size();
  return name.starts_with(given) ||
         (name.ends_with(given) && std::string("._ ").find(name[before - 1]) != std::string::npos);
}

// Edits to a name, or to its last word and one more: left_torque of torqe.
size_t edits_to(const std::string& given, const std::string& name) {
  const size_t whole = edit_distance(given, name);
  const size_t word = name.find_last_of("._ ") + 1;  // 0 where there is one word
  const size_t last = name.size() - word;
  if (word == 0 || last < 4) return whole;
  const size_t edits = edit_distance(given, name.substr(word));
  return edits <= last / 3 ? std::min(whole, edits + 1) : whole;
}

// How far a name is from what was given: the shortest that has it as a part is the nearest.
std::pair<size_t, size_t> remoteness(const std::string& given, const std::string& name) {
  if (is_part(given, name)) return {0, name.size()};
  return {edits_to(given, name), 0};
}

}  // namespace

ConfigError::ConfigError(std::vector<std::string> mistakes)
    : std::invalid_argument(fmt::format("{}", fmt::join(mistakes, "\n"))),
      mistakes_(std::move(mistakes)) {}

std::string shortened(const std::string& text) {
  constexpr size_t kMost = 80;
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

std::string unknown_name(const std::string& kind, const std::string& given,
                         const std::vector<std::string>& known) {
  const std::string value = shortened(given);
  if (known.empty()) return fmt::format("unknown {} '{}': there are none", kind, value);
  std::string text = fmt::format("unknown {} '{}': expected one of {}", kind, value, join(known));
  const auto nearest = std::min_element(known.begin(), known.end(), [&](auto& a, auto& b) {
    return remoteness(value, a) < remoteness(value, b);
  });
  const size_t edits = remoteness(value, *nearest).first;
  const size_t longest = std::max(value.size(), nearest->size());
  if (edits < longest && edits <= std::max<size_t>(2, nearest->size() / 2))
    text += fmt::format("; did you mean '{}'?", *nearest);
  return text;
}

std::string join(std::span<const double> values) {
  return fmt::format("{}", fmt::join(values, ","));
}
std::string join(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace hamel
