#include <hamel/framework/io/errors.hpp>

#include <algorithm>
#include <numeric>

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
    return edit_distance(value, a) < edit_distance(value, b);
  });
  if (nearest != known.end() &&
      edit_distance(value, *nearest) <= std::max<size_t>(2, nearest->size() / 2)) {
    text += fmt::format("; did you mean '{}'?", *nearest);
  }
  return text;
}

std::string join(std::span<const double> values) {
  return fmt::format("{}", fmt::join(values, ","));
}
std::string join(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace hamel
