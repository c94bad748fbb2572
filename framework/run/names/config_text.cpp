// Values of options as texts, and back.
#include <algorithm>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/names/config.hpp>

namespace hamel {
namespace {

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) out.push_back(word);
  return out;
}

// "", or what a text is instead of a number.
const char* no_number(const std::string& text, double& out) {
  size_t used = 0;
  try {
    out = std::stod(text, &used);
  } catch (const std::out_of_range&) {
    return "is too large or too small for a number (2.3e-308 to 1.7e308)";
  } catch (const std::exception&) {
    return "is not a number";
  }
  return used == text.size() ? "" : "is not a number";
}

}  // namespace

std::string text_of(double value) { return fmt::format("{}", value); }
std::string text_of(std::optional<double> value) { return value ? text_of(*value) : ""; }
std::string text_of(long value) { return fmt::format("{}", value); }
std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(const std::string& value) { return value; }
std::string text_of(const std::vector<double>& value) { return join(value); }
std::string text_of(const std::vector<std::string>& value) {
  return fmt::format("{}", fmt::join(value, ","));
}

void read_text(const std::string& option, const std::string& text, double& out) {
  if (const std::string_view why = no_number(text, out); !why.empty())
    throw ConfigError({fmt::format("{}: '{}' {}", option, text, why)});
}
void read_text(const std::string& option, const std::string& text, std::optional<double>& out) {
  out.reset();
  if (!text.empty()) read_text(option, text, out.emplace());
}
void read_text(const std::string& option, const std::string& text, long& out) {
  size_t used = 0;
  try {
    out = std::stol(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size())
    throw ConfigError({fmt::format("{}: '{}' is not a whole number", option, text)});
}
void read_text(const std::string& option, const std::string& text, bool& out) {
  if (text != "true" && text != "false")
    throw ConfigError({fmt::format("{}: got '{}', expected true or false", option, text)});
  out = text == "true";
}
void read_text(const std::string&, const std::string& text, std::string& out) { out = text; }
// Names and formulas: a comma within brackets separates arguments.
void read_text(const std::string&, const std::string& text, std::vector<std::string>& out) {
  out.clear();
  int open = 0;
  for (const std::string& word : split(text)) {
    if (open > 0) out.back() += "," + word;
    else out.push_back(word);
    open += static_cast<int>(std::count(word.begin(), word.end(), '(') -
                             std::count(word.begin(), word.end(), ')'));
  }
}
void read_text(const std::string& option, const std::string& text, std::vector<double>& out) {
  if (text.empty() || text.back() == ',') {
    throw ConfigError(
        {fmt::format("{}: got '{}', expected numbers separated by commas", option, text)});
  }
  out.clear();
  for (const std::string& word : split(text)) {
    if (const std::string_view why = no_number(word, out.emplace_back()); !why.empty())
      throw ConfigError({fmt::format("{}: '{}' in '{}' {}", option, word, text, why)});
  }
}

}  // namespace hamel
