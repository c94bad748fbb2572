// Ensemble files: TOML with the options of `hamel run`, what is varied and what is kept.
#include <algorithm>

#include <fmt/format.h>

#include <hamel/framework/ensemble/ensemble_plan.hpp>
#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/framework/io/whole_number.hpp>
#include <hamel/framework/run/names/toml_config.hpp>

namespace hamel {
namespace {

using Law = Variation::Law;

constexpr std::pair<const char*, Law> kLaws[] = {
    {"values", Law::values},           {"uniform", Law::uniform},       {"normal", Law::normal},
    {"log_uniform", Law::log_uniform}, {"tau_normal", Law::tau_normal}, {"energy", Law::energy},
};

class EnsembleReader {
 public:
  explicit EnsembleReader(const std::string& origin) : read_(origin) { config_.origin = origin; }

  EnsembleConfig file(const std::string& text) {
    const toml::table table = read_.parse(text);
    refuse_other_kinds(table);
    config_.text = text;
    for (const auto& [name, node] : table) {
      const std::string key(name.str());
      at(key, node);
      if (!own(key, node) && !read_config_key(read_, key, node, config_.run))
        read_.unknown_key(node, key, keys());
    }
    std::ranges::stable_sort(varied_, [](const Varied& a, const Varied& b) {
      return std::pair(a.at.line, a.at.column) < std::pair(b.at.line, b.at.column);
    });
    for (Varied& v : varied_) config_.vary.push_back(std::move(v.variation));
    return std::move(config_);
  }
  std::vector<std::string>& mistakes() { return read_.mistakes; }

 private:
  struct Varied {
    Variation variation;
    toml::source_position at;
  };

  static std::vector<std::string> keys() {
    std::vector<std::string> out = {"members",     "seed",      "grid",          "vary",
                                    "keep",        "class",     "statistics_at", "statistics_of",
                                    "histograms",  "quantiles", "covariance",    "feedback",
                                    "trajectories"};
    for (std::string& key : config_keys()) out.push_back(std::move(key));
    return out;
  }
  void at(const std::string& key, const toml::node& node) {
    config_.where[key] = read_.place(node);
  }

  void refuse_other_kinds(const toml::table& table) const {
    const toml::node* system = table.get("system");
    const std::vector<std::string> runs = config_keys(), all = keys();
    const bool any_own = std::ranges::any_of(all, [&](const std::string& key) {
      return std::ranges::find(runs, key) == runs.end() && table.contains(key);
    });
    if (system != nullptr && !any_own)
      throw ConfigError({fmt::format(
          "{}: this file is {}, no ensemble: it has neither [vary] nor keep", config_.origin,
          system->is_array() ? "a study (hamel study)" : "the configuration of a run")});
    if (system == nullptr)
      throw ConfigError({fmt::format("{}: an ensemble has system = \"...\"", config_.origin)});
  }

  // A key that a run has not.
  bool own(const std::string& key, const toml::node& node) {
    if (key == "members") read_.value(node, key, config_.members);
    else if (key == "seed") seed(node);
    else if (key == "grid") read_.value(node, key, config_.grid);
    else if (key == "vary") vary(node);
    else if (key == "feedback") feedback(node);
    else if (key == "keep") keep(node);
    else if (key == "class") classes(node);
    else if (key == "statistics_at") read_.value(node, key, config_.statistics_at);
    else if (key == "statistics_of") read_.value(node, key, config_.statistics_of);
    else if (key == "histograms") histograms(node);
    else if (key == "quantiles") quantiles(node);
    else if (key == "trajectories") trajectories(node);
    else if (key == "covariance") read_.value(node, key, config_.covariance);
    else if (key == "events" && node.is_table()) events(*node.as_table());
    else return false;
    return true;
  }

  void seed(const toml::node& node) {
    long value = 0;
    read_.value(node, "seed", value);
    if (value < 0) read_.wrong_value(node, "seed", "a whole number of at least 0");
    config_.seed = static_cast<uint64_t>(value);
  }

  void trajectories(const toml::node& node) {
    std::vector<double> given;
    read_.value(node, "trajectories", given);
    for (const double member : given) {
      if (const auto whole = whole_number(member)) config_.trajectories.push_back(*whole);
      else read_.wrong(node, "trajectories", "the numbers of members, from 0");
    }
  }

  void vary(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return read_.wrong(node, "vary", "a table, name = { uniform = [a, b] }");
    names(*table, "");
  }
  // start.omega = { ... } is a table within a table.
  void names(const toml::table& table, const std::string& prefix) {
    for (const auto& [word, node] : table) {
      const std::string name = prefix + std::string(word.str());
      const toml::table* inner = node.as_table();
      at("vary." + name, node);
      const auto is_law = [&](const auto& entry) {
        const std::string key(entry.first.str());
        return key == "range" ||
               std::ranges::any_of(kLaws, [&](auto& l) { return key == l.first; });
      };
      if (inner == nullptr) laws(node, name);
      else if (inner->size() == 1 && is_law(*inner->begin())) variation(*inner, name);
      else if (!inner->empty() && std::all_of(inner->begin(), inner->end(), [](const auto& entry) {
                 return entry.second.is_table();
               }))
        names(*inner, name + ".");
      else laws(node, name);
    }
  }
  void laws(const toml::node& node, const std::string& name) {
    read_.wrong(node, "vary." + name,
                "one of { values = [...] }, { range = [from, to, count] }, { uniform = [a, b] }, "
                "{ normal = [mean, sigma] }, { log_uniform = [a, b] }");
  }
  void variation(const toml::table& table, const std::string& name) {
    const std::string key(table.begin()->first.str());
    const toml::node& node = table.begin()->second;
    Variation out{name, Law::values, {}};
    const std::string where = "vary." + name + "." + key;
    if (node.value<std::string>() == "so3" && key == "uniform") out.law = Law::haar;
    else if (key == "range") range(node, where, out.numbers);
    else read_.value(node, where, out.numbers);
    for (const auto& [law, value] : kLaws)
      if (key == law && out.law != Law::haar) out.law = value;
    varied_.push_back({std::move(out), table.source().begin});
  }
  void range(const toml::node& node, const std::string& key, std::vector<double>& out) {
    std::vector<double> given;
    const size_t before = read_.mistakes.size();
    read_.value(node, key, given);
    if (read_.mistakes.size() > before) return;
    constexpr long most = 10'000'000;
    const auto count = given.size() == 3 ? whole_number(given[2]).value_or(0) : 0;
    if (count < 1 || count > most)
      return read_.wrong(node, key,
                         "[from, to, count], a count of at least 1: no range is without "
                         "members");
    for (long i = 0; i < count; ++i)
      out.push_back(i + 1 == count && count > 1
                        ? given[1]
                        : given[0] + (given[1] - given[0]) * static_cast<double>(i) /
                                         static_cast<double>(std::max(count - 1, 1L)));
  }

  void keep(const toml::node& node) {
    const toml::array* array = node.as_array();
    if (array == nullptr) return read_.wrong(node, "keep", "a list of what is kept of a member");
    for (const toml::node& entry : *array) {
      const std::string key = fmt::format("keep[{}]", config_.keep.size());
      at(key, entry);
      Kept& out = config_.keep.emplace_back();
      if (const auto text = entry.value<std::string>()) {
        out.formula = *text;
        continue;
      }
      const toml::table* table = entry.as_table();
      if (table == nullptr || !table->contains("formula") || !table->contains("name")) {
        read_.wrong(entry, key, "a text, or { name = \"...\", formula = \"...\" }");
        continue;
      }
      for (const auto& [word, value] : *table) {
        const std::string name(word.str());
        if (name == "name") read_.value(value, key + ".name", out.name);
        else if (name == "formula") read_.value(value, key + ".formula", out.formula);
        else read_.unknown_key(value, name, {"name", "formula"});
      }
    }
  }

  void feedback(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr)
      return read_.wrong(node, "feedback", "a table, period = s and input = \"formula\"");
    for (const auto& [word, value] : *table) {
      const std::string name(word.str()), key = "feedback." + name;
      at(key, value);
      if (name == "period") read_.value(value, key, config_.feedback.period);
      else read_.value(value, key, config_.feedback.inputs[name]);
    }
  }

  void classes(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr)
      return read_.wrong(node, "class", "{ formula = \"...\", names = [\"...\"] }");
    for (const auto& [word, value] : *table) {
      const std::string name(word.str());
      if (name == "formula") read_.value(value, "class.formula", config_.classes.formula);
      else if (name == "names") read_.value(value, "class.names", config_.classes.names);
      else read_.unknown_key(value, name, {"formula", "names"});
    }
    if (config_.classes.formula.empty() || config_.classes.names.empty())
      read_.wrong(node, "class", "a formula and the names of its values 0, 1, ...");
  }

  void events(const toml::table& table) {
    for (const auto& [word, node] : table) {
      const std::string name(word.str());
      read_.value(node, "events." + name, config_.events[name]);
      at("events." + name, node);
    }
  }

  void histograms(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return read_.wrong(node, "histograms", "a table, \"end.x\" = 40");
    for (const auto& [word, entry] : *table) {
      const std::string key = "histograms." + std::string(word.str());
      HistogramRequest& out = config_.histograms[std::string(word.str())];
      at(key, entry);
      std::vector<double> ends;
      if (const toml::table* inner = entry.as_table()) {
        for (const auto& [name, value] : *inner) {
          if (name.str() == "bins") read_.value(value, key + ".bins", out.bins);
          else if (name.str() == "range") read_.value(value, key + ".range", ends);
          else read_.unknown_key(value, std::string(name.str()), {"bins", "range"});
        }
        if (inner->contains("range") && (ends.size() != 2 || !(ends[0] < ends[1])))
          read_.wrong_value(entry, key + ".range", "[from, until], from below until");
        else if (ends.size() == 2) out.from = ends[0], out.until = ends[1];
      } else {
        read_.value(entry, key, out.bins);
      }
      if (out.bins < 1 || out.bins > 100'000) read_.wrong_value(entry, key, "1 to 100000 bins");
    }
  }

  void quantiles(const toml::node& node) {
    read_.value(node, "quantiles", config_.quantiles);
    if (!std::ranges::all_of(config_.quantiles, [](double p) { return p >= 0 && p <= 1; }))
      read_.wrong_value(node, "quantiles", "numbers in [0, 1]");
  }

  TomlReader read_;
  EnsembleConfig config_;
  std::vector<Varied> varied_;
};

}  // namespace

EnsembleConfig parse_ensemble(const std::string& text, const std::string& origin,
                              const Registry& registry, const std::string& data,
                              std::function<SystemModel(const Parameters&)> model) {
  EnsembleReader reader(origin);
  EnsembleConfig config = reader.file(text);
  config.data = data;
  config.model = std::move(model);
  if (!reader.mistakes().empty()) throw ConfigError(reader.mistakes());
  ensemble::read_data(config);
  ensemble::Plan(registry, config);
  return config;
}

EnsembleConfig read_ensemble(const std::string& path, const Registry& registry) {
  return parse_ensemble(read_text_file("ensemble", path), path, registry);
}

}  // namespace hamel
