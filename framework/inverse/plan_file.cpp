// Plan files: TOML with the options of `hamel run`, a start, an end, costs and bounds.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <hamel/framework/inverse/motion_plan.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/framework/run/names/toml_config.hpp>

namespace hamel {
namespace {

// Options of a run that a plan has in another form, or none of.
constexpr const char* kOfRuns[] = {"configuration", "velocity", "momentum",    "set",
                                   "speed",         "every",    "output_step", "output_times",
                                   "events",        "stop_at",  "check",       "step",
                                   "rtol",          "atol",     "step_max",    "steps_max"};

class PlanReader {
 public:
  explicit PlanReader(const std::string& origin) : read_(origin) { out_.origin = origin; }

  PlanRequest file(const std::string& text) {
    const toml::table table = read_.parse(text);
    for (const auto& [name, node] : table) {
      const std::string key(name.str());
      out_.where[key] = read_.place(node);
      if (own(key, node)) continue;
      const bool of_runs = std::ranges::find(kOfRuns, key) != std::end(kOfRuns);
      if (of_runs || !read_config_key(read_, key, node, out_.run))
        read_.unknown_key(node, key, keys());
    }
    for (const char* key : {"system", "until", "steps", "inputs"})
      if (!table.contains(key)) read_.mistakes.push_back(out_.origin + ": a plan has " + key);
    if (!read_.mistakes.empty()) throw ConfigError(read_.mistakes);
    return std::move(out_);
  }

 private:
  static std::vector<std::string> keys() {
    std::vector<std::string> out = {"parameters", "until", "steps",  "inputs",      "from",
                                    "to",         "cost",  "bounds", "constraints", "guess"};
    for (std::string& key : config_keys())
      if (std::ranges::find(kOfRuns, key) == std::end(kOfRuns) &&
          std::ranges::find(out, key) == out.end())
        out.push_back(std::move(key));
    return out;
  }

  bool own(const std::string& key, const toml::node& node) {
    if (key == "parameters") read_.lists(node, key, out_.run.parameters);
    else if (key == "until") until(node);
    else if (key == "steps") read_.value(node, key, out_.steps);
    else if (key == "inputs") read_.value(node, key, out_.inputs);
    else if (key == "from")
      each(node, key, [&](auto& k, auto& x) { return from(k, x); }, {"configuration", "velocity"});
    else if (key == "to")
      each(node, key, [&](auto& k, auto& x) { return to(k, x); }, {"configuration", "velocity"});
    else if (key == "cost")
      each(node, key, [&](auto& k, auto& x) { return cost(k, x); },
           {"inputs", "running", "terminal", "time"});
    else if (key == "bounds") bounds(node);
    else if (key == "constraints") read_.value(node, key, out_.constraints);
    else if (key == "guess")
      each(node, key, [&](auto& k, auto& x) { return guess(k, x); }, {"file", "seed"});
    else return false;
    return true;
  }

  // The keys of a table, take(key, node) false where it is unknown.
  template <class Take>
  void each(const toml::node& node, const std::string& key, const Take& take,
            const std::vector<std::string>& known) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return read_.wrong_value(node, key, "a table: " + join(known));
    for (const auto& [name, entry] : *table) {
      const std::string one(name.str());
      out_.where[key + "." + one] = read_.place(entry);
      if (!take(one, entry)) read_.unknown_key(entry, one, known);
    }
  }

  void until(const toml::node& node) {
    if (!node.is_table()) return read_.value(node, "until", out_.run.until);
    FreeTime time;
    bool free = false;
    each(node, "until",
         [&](const std::string& key, const toml::node& entry) {
           if (key == "free") read_.value(entry, "until.free", free);
           else if (key == "least") read_.value(entry, "until.least", time.least);
           else if (key == "most") read_.value(entry, "until.most", time.most);
           else return false;
           return true;
         },
         {"free", "least", "most"});
    if (!free) return read_.wrong_value(node, "until", "a number or { free = true, least, most }");
    out_.free_time = time;
  }

  bool from(const std::string& key, const toml::node& node) {
    const auto numbers = [&](std::vector<double>& out) {
      if (const toml::array* array = node.as_array())
        for (const toml::node& entry : *array)
          if (entry.is_string())
            return read_.wrong_value(entry, "from." + key,
                                     "a number: the start of a plan is given");
      read_.value(node, "from." + key, out);
    };
    if (key == "configuration") numbers(out_.run.start.configuration);
    else if (key == "velocity") numbers(out_.run.start.velocity);
    else return false;
    return true;
  }

  bool to(const std::string& key, const toml::node& node) {
    if (key != "configuration" && key != "velocity") return false;
    auto& out = key == "velocity" ? out_.to_velocity : out_.to_configuration;
    const toml::array* array = node.as_array();
    if (array == nullptr) {
      read_.wrong_value(node, "to." + key, "a list of numbers and \"free\"");
      return true;
    }
    for (const toml::node& entry : *array) {
      const auto number = entry.value<double>();
      const auto text = entry.value<std::string>();
      if (number && std::isfinite(*number)) out.emplace_back(*number);
      else if (text && *text == "free") out.emplace_back();
      else read_.wrong_value(entry, "to." + key, "a number or \"free\"");
    }
    return true;
  }

  bool cost(const std::string& key, const toml::node& node) {
    if (key == "inputs") weights(node);
    else if (key == "running") read_.value(node, "cost.running", out_.running);
    else if (key == "terminal") read_.value(node, "cost.terminal", out_.terminal);
    else if (key == "time") read_.value(node, "cost.time", out_.time_weight);
    else return false;
    return true;
  }

  void weights(const toml::node& node) {
    if (const toml::table* table = node.as_table()) {
      for (const auto& [name, entry] : *table) {
        const std::string input(name.str());
        read_.value(entry, "cost.inputs." + input, out_.input_weights[input]);
      }
    } else {
      read_.wrong_value(node, "cost.inputs", "a table: force = 1.0, torque = 2.0");
    }
  }

  void bounds(const toml::node& node, const std::string& in_front = "") {
    const toml::table* table = node.as_table();
    if (table == nullptr) return read_.wrong_value(node, "bounds", "a table: name = [low, high]");
    for (const auto& [name, entry] : *table) {
      const std::string one = in_front + std::string(name.str());
      if (entry.is_table()) {  // steer.angle = [...]
        bounds(entry, one + ".");
        continue;
      }
      out_.where["bounds." + one] = read_.place(entry);
      std::vector<double> range;
      read_.value(entry, "bounds." + one, range);
      if (range.size() == 2) out_.bounds[one] = {range[0], range[1]};
      else read_.wrong(entry, "bounds." + one, "[low, high]");
    }
  }

  bool guess(const std::string& key, const toml::node& node) {
    if (key == "file") read_.value(node, "guess.file", out_.guess_file);
    else if (key == "seed") read_.value(node, "guess.seed", out_.seed);
    else return false;
    return true;
  }

  TomlReader read_;
  PlanRequest out_;
};

}  // namespace

PlanRequest parse_plan(const std::string& text, const std::string& origin) {
  return PlanReader(origin).file(text);
}

PlanRequest read_plan(const std::string& path) {
  PlanRequest out = parse_plan(read_text_file("plan", path), path);
  const auto beside = [&](std::string& file) {
    file = (std::filesystem::path(path).parent_path() / file).string();
  };
  // Registered names have no dots.
  if (out.run.system.find('.') != std::string::npos) beside(out.run.system);
  if (!out.guess_file.empty()) beside(out.guess_file);
  return out;
}

}  // namespace hamel
