// From the record of a run (record.cpp) back: the run that resumes where it ended, and what was
// measured.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/record/run_file.hpp>

namespace hamel {
namespace {

using Json = nlohmann::ordered_json;

// A value of a record with its place, for what it is not.
class Entry {
 public:
  Entry(const Json& json, std::string origin, std::string place = "")
      : json_(&json), origin_(std::move(origin)), place_(std::move(place)) {}

  bool null() const { return json_->is_null(); }
  bool has(const std::string& key) const { return json_->is_object() && json_->contains(key); }
  Entry operator[](const std::string& key) const {
    if (!json_->is_object()) wrong("an object");
    if (!json_->contains(key)) refuse(place_of(key) + " is missing");
    return {(*json_)[key], origin_, place_of(key)};
  }
  // f(name, entry) for each member.
  template <class F>
  void members(F&& f) const {
    if (!json_->is_object()) wrong("an object");
    for (const auto& [key, value] : json_->items()) f(key, Entry(value, origin_, place_of(key)));
  }
  std::vector<Entry> entries() const {
    if (!json_->is_array()) wrong("a list");
    std::vector<Entry> out;
    for (const Json& value : *json_)
      out.emplace_back(value, origin_, fmt::format("{}[{}]", place_, out.size()));
    return out;
  }

  void get(double& out) const {
    if (!json_->is_number()) wrong("a number");
    out = json_->get<double>();
  }
  void get(long& out) const {
    const auto most = static_cast<std::uint64_t>(std::numeric_limits<long>::max());
    if (!json_->is_number_integer() ||
        (json_->is_number_unsigned() && json_->get<std::uint64_t>() > most))
      wrong("a whole number");
    out = json_->get<long>();
  }
  void get(int& out) const {
    const auto whole = as<long>();
    if (!std::in_range<int>(whole)) wrong("a smaller number");
    out = static_cast<int>(whole);
  }
  void get(bool& out) const {
    if (!json_->is_boolean()) wrong("true or false");
    out = json_->get<bool>();
  }
  void get(std::string& out) const {
    if (!json_->is_string()) wrong("a text");
    out = json_->get<std::string>();
  }
  template <class Value>
  void get(std::vector<Value>& out) const {
    out.clear();
    for (const Entry& entry : entries()) out.push_back(entry.as<Value>());
  }
  template <class Value>
  Value as() const {
    Value out{};
    get(out);
    return out;
  }
  // A measured number; kNone where nothing was measured or the value was not finite.
  double measured() const { return null() ? Measurements::kNone : as<double>(); }

  // The text of an option, as on a command line.
  std::string text() const {
    if (!json_->is_array()) return json_->is_string() ? as<std::string>() : shown();
    std::vector<std::string> texts;
    for (const Entry& entry : entries()) texts.push_back(entry.text());
    return text_of(texts);
  }
  std::vector<double> numbers() const {
    return json_->is_array() ? as<std::vector<double>>() : std::vector<double>{as<double>()};
  }
  InputSignal signal() const {
    if (json_->is_number()) return as<double>();
    if (json_->is_string()) return input_signal(as<std::string>());
    return InputTable{(*this)["t"].as<std::vector<double>>(),
                      (*this)["value"].as<std::vector<double>>(), (*this)["hold"].as<bool>()};
  }

 private:
  std::string place_of(const std::string& key) const {
    return place_.empty() ? key : place_ + "." + key;
  }
  std::string shown() const { return json_->dump(-1, ' ', false, Json::error_handler_t::replace); }
  [[noreturn]] void wrong(const char* expected) const {
    refuse(fmt::format("{}expected {}, got {}", place_.empty() ? "" : place_ + ": ", expected,
                       shortened(shown())));
  }
  [[noreturn]] void refuse(const std::string& why) const {
    throw ConfigError(
        {fmt::format("{}: not the record of a run (hamel run … -o x.json): {}", origin_, why)});
  }

  const Json* json_;
  std::string origin_, place_;
};

// Json::parse takes 1e-400 for 0: sees each number as it stands in the text.
class Underflow : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(std::int64_t) override { return true; }
  bool number_unsigned(std::uint64_t) override { return true; }
  bool number_float(double value, const std::string& text) override {
    if (value != 0 || text.substr(0, text.find_first_of("eE")).find_first_of("123456789") == npos)
      return true;
    number = text;
    return false;
  }
  bool string(std::string&) override { return true; }
  bool binary(Json::binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(std::string&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t, const std::string&, const Json::exception&) override {
    return false;  // said by Json::parse
  }

  std::string number;  // the first that no double holds

 private:
  static constexpr size_t npos = std::string::npos;
};

Json parsed(const std::string& record, const std::string& origin) {
  Underflow underflow;
  if (!Json::sax_parse(record, &underflow) && !underflow.number.empty())
    throw ConfigError({fmt::format("{}: the number {} is too small", origin, underflow.number)});
  try {
    return Json::parse(record);
  } catch (const Json::exception& error) {
    throw ConfigError({fmt::format("{}: not the record of a run (hamel run … -o x.json): {}",
                                   origin, error.what())});
  }
}

// Options that a run may be without.
template <class Value>
constexpr bool MayBeNone = false;
template <class Value>
constexpr bool MayBeNone<std::optional<Value>> = true;
template <class Value>
constexpr bool MayBeNone<std::vector<Value>> = true;

// The system and the options of a record, all but the start.
Config options_of(const Entry& all, const std::string& origin) {
  Config config;
  const bool of_file = all.has("system_file") && !all["system_file"].null();
  config.system = all[of_file ? "system_file" : "system"].as<std::string>();
  Config::fields([&](const Option& option, auto member) {
    const std::string key = key_in_record(option);
    if (!all.has(key) || all[key].null() || all[key].text().empty()) return;
    try {
      read_text(option.name, all[key].text(), config.*member);
    } catch (const ConfigError& error) {
      throw ConfigError({fmt::format("{}: {}", origin, error.what())});
    }
  });
  all["parameters"].members([&](const std::string& name, const Entry& value) {
    config.parameters[name] = value.numbers();
  });
  if (all.has("inputs")) {
    all["inputs"].members([&](const std::string& name, const Entry& signal) {
      config.inputs[name] = signal.signal();
    });
  }
  return config;
}

}  // namespace

Config recorded_config(const std::string& record, const std::string& origin) {
  const Json json = parsed(record, origin);
  const Entry all(json, origin);
  Config config = options_of(all, origin);
  const Entry start = all["start"];
  start["configuration"].get(config.start.configuration);
  start["velocity"].get(config.start.velocity);
  return config;
}

Config Config::continued(const std::string& record, const std::string& origin) {
  const Json json = parsed(record, origin);
  const Entry all(json, origin);
  Config config = options_of(all, origin);
  const Entry last = all["final"];
  last["configuration"].get(config.start.configuration);
  last["velocity"].get(config.start.velocity);
  const double span = config.until - config.from, first = config.from;
  all["time"].get(config.from);
  config.until = config.from + span;
  for (double& time : config.output_times) time = config.from + (time - first);
  return config;
}

void read_record(const std::string& record, const std::string& origin, Result& out) {
  const Json json = parsed(record, origin);
  const Entry all(json, origin);
  Config::fields([&](const Option& option, auto member) {
    const std::string key = key_in_record(option);
    const bool unused = all.has(key) && all[key].null();  // an older record lacks newer options
    if (unused && !MayBeNone<std::remove_cvref_t<decltype(Config().*member)>>)
      out.unused.push_back(option.name);
  });
  all["notes"].get(out.notes);
  out.status = {all["status"].as<std::string>() == "ok", 0, 0, 0, all["reason"].as<std::string>()};
  if (const Entry failure = all["failure"]; !failure.null()) {
    failure["step"].get(out.status.step);
    failure["time"].get(out.status.time);
    out.status.residual = failure["residual"].measured();
  }
  all["steps"].get(out.steps);
  const Entry last = all["final"];
  out.last.step = out.steps;
  all["time"].get(out.last.time);
  last["configuration"].get(out.last.coordinates);
  last["velocity"].get(out.last.velocity);
  last["momentum"].get(out.last.momentum);
  out.last.energy = last["energy"].measured();
  const Entry diagnostics = all["diagnostics"];
  Measurements::fields([&](const Quantity& quantity, const char* suffix, auto member) {
    out.*member = diagnostics[std::string(quantity.name) + suffix].measured();
  });
  diagnostics["invariants"].members([&](const std::string& name, const Entry& drift) {
    out.invariants.push_back({name, drift["start"].measured(), drift["drift_max"].measured()});
  });
  for (const Entry& event : all["events"].entries()) {
    out.events.push_back({event["name"].as<std::string>(), event["time"].as<double>(),
                          event["configuration"].as<std::vector<double>>(),
                          event["velocity"].as<std::vector<double>>()});
    if (event.has("velocity_after"))
      out.events.back().velocity_after = event["velocity_after"].as<std::vector<double>>();
  }
  const Entry stats = all["solver_stats"];
  if (out.steps > 0)  // (there is no mean of no steps)
    out.stats.iterations =
        std::lround(stats["iterations_mean"].as<double>() * static_cast<double>(out.steps));
  stats["iterations_max"].get(out.stats.iterations_max);
  stats["rejected"].get(out.stats.rejected);
  stats["evaluations"].get(out.stats.evaluations);
  out.stats.residual_max = stats["residual_max"].measured();
  const Entry fallbacks = all["fallbacks"];
  fallbacks["count"].get(out.stats.fallbacks);
  for (const Entry& f : fallbacks["first"].entries()) {
    out.stats.first_fallbacks.push_back(
        {f["step"].as<long>(), f["time"].measured(), f["action"].as<std::string>()});
  }
  const Entry timing = all["timing"];
  out.seconds = timing["seconds"].measured();
  timing["recording_seconds"].get(out.recording_seconds);
  timing["comparing_seconds"].get(out.comparing_seconds);
}

}  // namespace hamel
