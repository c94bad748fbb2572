#include <hamel/framework/run/names/config.hpp>

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/visible.hpp>

namespace hamel {
namespace {

// f(member pointer) for the option of that name.
template <class F>
void with_option(const std::string& name, F&& f) {
  bool found = false;
  Config::fields([&](const Option& option, auto member) {
    if (std::string_view(option.name) != name) return;
    found = true;
    f(member);
  });
  if (found) return;
  std::vector<std::string> known;
  Config::fields([&](const Option& option, auto /*member*/) { known.emplace_back(option.name); });
  throw ConfigError({unknown_name("option", name, known)});
}

}  // namespace

std::string Config::text(const std::string& option) const {
  std::string out;
  with_option(option, [&](auto member) { out = text_of(this->*member); });
  return out;
}

void Config::set(const std::string& option, const std::string& text) {
  with_option(option, [&](auto member) { read_text(option, text, this->*member); });
}

bool Config::is_default(const std::string& option) const {
  static const Config defaults;
  bool out = false;
  with_option(option, [&](auto member) { out = this->*member == defaults.*member; });
  return out;
}

long Config::steps() const {
  return static_cast<long>(std::floor((until - from) / step_or_usual() * (1 + 1e-12) + 1e-9));
}

bool Config::leaves_method() const {
  return scheme.empty() && !step && !chooses_steps() && compose == "none";
}

Config Config::completed() const {
  Config out = *this;
  if (leaves_method()) {
    out.rtol = kUsualRtol;
    if (every == 1 && !output_step && output_times.empty()) out.output_step = kUsualStep;
  }
  if (scheme.empty()) out.scheme = out.chooses_steps() ? "dop853" : "lift";
  if (!out.chooses_steps()) out.step = step_or_usual();
  return out;
}

std::vector<double> Config::recorded_times() const {
  if (!output_times.empty() || !output_step) return output_times;
  const double count = std::floor(std::abs(until - from) / *output_step * (1 + 1e-12) + 1e-9);
  std::vector<double> out;
  for (double i = 0; i <= count; ++i)
    out.push_back(from + std::copysign(i * *output_step, until - from));
  return out;
}

namespace {

std::string refusal(const char* name, double value, const std::string& expected) {
  return fmt::format("{}: got {}, expected {}", name, value, expected);
}

// Values that their own option does not allow.
void look_at_each(const Config& config, std::vector<std::string>& out) {
  const auto look_at = [&](const Option& option, double value) {
    if (option.allows != nullptr && !option.allows(value))
      out.push_back(refusal(option.name, value, option.expected));
  };
  config.fields([&](const Option& option, auto member) {
    using Value = std::remove_cvref_t<decltype(config.*member)>;
    if constexpr (std::is_arithmetic_v<Value>) look_at(option, static_cast<double>(config.*member));
    if constexpr (std::is_same_v<Value, std::optional<double>>)
      if (config.*member) look_at(option, *(config.*member));
    if constexpr (std::is_same_v<Value, std::vector<double>>)
      for (const double x : config.*member) look_at(option, x);
  });
}

void look_at_output_times(const Config& config, std::vector<std::string>& out) {
  const auto& times = config.output_times;
  if (config.output_step && !times.empty())
    out.push_back("output_times: give them or output_step, not both");
  if ((config.output_step || !times.empty()) && config.every != 1)
    out.push_back("every: the rows are at the output times: leave it out");
  const double sign = config.until - config.from < 0 ? -1 : 1;
  for (size_t i = 0; i < times.size(); ++i) {
    const double t = times[i];
    if (sign * (t - config.from) < 0 || sign * (config.until - t) < 0)
      out.push_back(refusal("output_times", t,
                            fmt::format("times from {} to {}", config.from, config.until)));
    else if (i > 0 && sign * (t - times[i - 1]) <= 0)
      out.push_back(refusal("output_times", t,
                            fmt::format("a time beyond the one before, {}", times[i - 1])));
  }
}

void look_at_span(const Config& config, std::vector<std::string>& out) {
  const double from = config.from, until = config.until, span = until - from;
  const double step = config.step_or_usual();
  if (!std::isfinite(span) || !std::isfinite(step) || step == 0) return;
  if (span / step < 0 && from == 0) {
    out.push_back(refusal("until", until, "the sign of step"));
  } else if (span / step < 0) {
    out.push_back(
        refusal("until", until, fmt::format("a time beyond from, {}, as step has it", from)));
  } else if (config.chooses_steps()) {
    return;
  } else if (span / step > 9e15) {
    out.push_back(refusal("until", until, "fewer than 9e15 steps"));
  } else if (span != 0 && config.steps() == 0) {
    out.push_back(
        refusal("step", step, fmt::format("at most until, {}: no whole step fits", span)));
  }
}

// Records and configurations, which hold the names of files, are UTF-8.
void look_at_names_of_files(const Config& config, std::vector<std::string>& out) {
  const auto look_at = [&](const std::string& field, const std::string& path) {
    if (!is_utf8(path)) out.push_back(fmt::format("{}: the name '{}' is no UTF-8", field, path));
  };
  look_at("system", config.system);
  for (const auto& [name, signal] : config.inputs)
    if (const auto* file = std::get_if<InputFile>(&signal)) look_at("input " + name, file->path);
}

}  // namespace

std::vector<std::string> Config::mistakes() const {
  std::vector<std::string> out;
  look_at_names_of_files(*this, out);
  look_at_each(*this, out);
  look_at_output_times(*this, out);
  look_at_span(*this, out);
  return out;
}

}  // namespace hamel
