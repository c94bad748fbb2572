// The command line of `hamel run`: its options, and the run that they specify.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <hamel/framework/run/names/config_file.hpp>

#include "commands.hpp"
#include "lines/number_option.hpp"
#include "lines/robot_line.hpp"

namespace hamel::tools {

/// The flag of an option of a run: --step-max.
std::string flag_of(const Option& option);

/// Puts the options of a run below titles in the help.
void group_run_options(CLI::App& app);

/// name=value[,value...], each as --set has it, into parameters. Throws ConfigError with all that
/// do not fit.
void read_sets(const std::vector<std::string>& sets, Parameters& parameters);

/// The options of `hamel run` as given; the file first, then the command line.
struct RunLine {
  std::string system, config_file, record_file;
  RobotLine robot;
  std::vector<std::string> sets, inputs;
  std::vector<std::function<void(Config&)>> overrides;  // of what is given, in its order
  RunOptions options;
  CommandOptions own;  // what --config may have beside a run's options, and what it has of them

  /// An option of the command's own as the file has it, unless the line gives it.
  template <class Value>
  void take(const CLI::App& app, const std::string& name, Value& to) const {
    const auto entry = own.find(name);
    std::string flag = "--" + name;
    std::ranges::replace(flag, '_', '-');
    if (entry == own.end() || app.count(flag) > 0) return;
    const auto& [values, place] = entry->second;
    if (values.empty()) return;
    const std::string option = fmt::format("{}: {}", place, name);
    if constexpr (std::is_same_v<Value, std::vector<std::string>>) to = values;
    else if (values.size() == 1) read_text(option, values.front(), to);
    else throw ConfigError({fmt::format("{}: got a list, expected one value", option)});
  }

  // The flag of an option, and what it does to a run when it is given.
  template <class Value>
  void option(CLI::App& app, const Option& option, const Value& usual,
              const std::function<Value&(Config&)>& member) {
    const std::string flag = flag_of(option);
    std::string help = option.meaning;
    if (const std::string text = text_of(usual); !text.empty())
      help += fmt::format(" [{}{}]", text, std::string(option.unit) == "s" ? " s" : "");
    const auto give = [this, member](const Value& value) {
      overrides.emplace_back([member, value](Config& config) { member(config) = value; });
    };
    if constexpr (std::is_same_v<Value, bool>) {
      app.add_flag_callback(
          flag, [give] { give(true); }, option.meaning);
    } else if constexpr (std::is_same_v<Value, std::string>) {
      app.add_option_function<Value>(flag, give, help);
    } else if constexpr (std::is_same_v<Value, std::vector<double>> ||
                         std::is_same_v<Value, std::vector<std::string>>) {
      const auto read = [this, flag, member](const std::vector<std::string>& texts) {
        const std::string text = fmt::format("{}", fmt::join(texts, ","));  // of all that repeat it
        overrides.emplace_back([=](Config& config) { read_text(flag, text, member(config)); });
      };
      app.add_option_function<std::vector<std::string>>(flag, read, help)
          ->type_name("A,B,...")
          ->allow_extra_args(false);
    } else {
      number_option<Value>(app, flag, give, help);
    }
  }

  void define(CLI::App& app);
  /// The system, its parameters and start, and every option of a run but these.
  void define_run(CLI::App& app, const std::set<std::string>& without);
  /// Parameters, inputs, the start, and every option of a run but these.
  void define_options(CLI::App& app, const std::set<std::string>& without);
  RunOptions resolve(const CLI::App& app);
  /// The start and the options of a run that the line gives, as their texts.
  static std::map<std::string, std::string> given(const CLI::App& app);

 private:
  // After the run of a record; or, of a file whose run is unfinished, with that run.
  void go_on(Config& config);
};

}  // namespace hamel::tools
