// hamel: the command line. Names and formats are those of the contract (README, "Command line").
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <sstream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/run/result.hpp>

#include "commands.hpp"
#include "steady.hpp"

namespace hamel::tools {
namespace {

constexpr int kUnfinished = 1, kBadInput = 2;

std::string read_file(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw ConfigError({fmt::format("cannot read '{}'", path)});
  return text.str();
}

// name=value[,value...], each as --set has it, into parameters. Throws ConfigError with all that do not fit.
void read_sets(const std::vector<std::string>& sets, Parameters& parameters) {
  std::vector<std::string> mistakes;
  for (const std::string& set : sets) {
    const size_t equal = set.find('=');
    if (equal == std::string::npos || equal == 0) {
      mistakes.push_back(fmt::format("--set: '{}' is not name=value[,value...]", set));
      continue;
    }
    const std::string name = set.substr(0, equal);
    try {
      read_text("--set " + name, set.substr(equal + 1), parameters[name]);
    } catch (const ConfigError& error) {
      mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
    }
  }
  if (!mistakes.empty()) throw ConfigError(mistakes);
}

// name=value, name=table.csv or name=table.csv:hold, each as --input has it.
void read_inputs(const std::vector<std::string>& given, InputSignals& inputs) {
  std::vector<std::string> mistakes;
  for (const std::string& input : given) {
    const size_t equal = input.find('=');
    if (equal == std::string::npos || equal == 0 || equal + 1 == input.size())
      mistakes.push_back(fmt::format("--input: '{}' is not name=value or name=table.csv", input));
    else inputs[input.substr(0, equal)] = input_signal(input.substr(equal + 1));
  }
  if (!mistakes.empty()) throw ConfigError(mistakes);
}

// The options of `hamel run` as given; the file first, then what the command line says.
struct RunLine {
  std::string system, config_file, record_file;
  std::vector<std::string> sets, inputs;
  std::vector<std::function<void(Config&)>> overrides;  // of what is given, in its order
  RunOptions options;

  // The flag of an option, and what it does to a run when it is given.
  template <class Value>
  void option(CLI::App& app, const Option& option, const Value& usual,
              const std::function<Value&(Config&)>& member) {
    std::string flag = fmt::format("--{}", option.name), help = option.meaning;
    std::replace(flag.begin(), flag.end(), '_', '-');
    if (const std::string text = text_of(usual); !text.empty())
      help += fmt::format(" [{}{}]", text, std::string(option.unit) == "s" ? " s" : "");
    const auto give = [this, member](const Value& value) {
      overrides.emplace_back([member, value](Config& config) { member(config) = value; });
    };
    if constexpr (std::is_same_v<Value, bool>) {
      app.add_flag_callback(
          flag, [give] { give(true); }, option.meaning);
    } else if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
      app.add_option_function<Value>(flag, give, help);
    } else {
      const auto read = [this, flag, member](const std::string& text) {
        overrides.emplace_back([=](Config& config) { read_text(flag, text, member(config)); });
      };
      app.add_option_function<std::string>(flag, read, help)->type_name("A,B,...");
    }
  }

  void define(CLI::App& app) {
    app.add_option("SYSTEM", system,
                   "a registered system (hamel list systems) or a file my_system.toml");
    CLI::Option* config = app.add_option("--config", config_file,
                                         "a TOML file with the same names; the command line wins");
    app.add_option(
           "--continue", record_file,
           "go on where the run of this record (-o x.json, x.h5) ended, as it was run, for as long "
           "again; the command line wins. An unfinished .h5: with that run, bit for bit")
        ->excludes(config);
    app.add_option("--set", sets, "a parameter, name=value[,value...] (repeatable)")
        ->allow_extra_args(false);
    app.add_option("--input", inputs,
                   "an input, name=value or name=table.csv (columns t,value; linear, or held from "
                   "row to row with :hold behind the file) (repeatable)")
        ->allow_extra_args(false);
    Config::start_fields([&]<class Value>(const Option& field, Value Start::*member) {
      option<Value>(app, field, {}, [member](Config& c) -> Value& { return c.start.*member; });
    });
    Config::fields([&]<class Value>(const Option& field, Value Config::*member) {
      option<Value>(app, field, Config().*member,
                    [member](Config& c) -> Value& { return c.*member; });
    });
    app.add_option(
           "-o,--output", options.outputs,
           "write .csv, .csv.gz, .h5 or .json, as the rows come; - is CSV to standard output "
           "(repeatable)")
        ->allow_extra_args(false);
    app.add_option("--report", options.report, "write a self-contained HTML page");
    app.add_flag("--json", options.json, "print the record as JSON");
    app.add_flag("--quiet", options.quiet, "print nothing but errors (and --json)");
    app.footer(
        "Exit status: 0 done, 1 numerical failure (what was computed is written), or interrupted "
        "or disk\n"
        "full (it is in FILE.part), 2 bad input.\n"
        "Examples:\n"
        "  hamel run suslov --until 20 --report suslov.html\n"
        "  hamel run suslov --set inertia=2,0.3,0.5,3,0.4,4 --velocity 1,0.5,0 --retraction exp\n"
        "  hamel run chaplygin_sleigh --scheme balance --step 0.05 -o sleigh.csv --json\n"
        "  hamel run rolling_disk --compose suzuki4 --velocity 0.7,1,0,2 -o disk.csv\n"
        "  hamel run segway --input right_torque=2 --input left_torque=torque.csv:hold\n"
        "  hamel run roller_racer -o first.json && hamel run --continue first.json --until 60\n"
        "  hamel run rolling_disk --until 1e5 -o disk.h5 || hamel run --continue disk.h5");
  }

  RunOptions resolve(const CLI::App& app) {
    Config& config = options.config;
    std::vector<std::string> mistakes;
    if (!config_file.empty()) config = read_config(config_file);
    if (!record_file.empty()) go_on(config);
    if (!system.empty() && system != config.system) {
      config.system = system;
      if (!record_file.empty()) {  // another system's, or a file's, which has none
        config.parameters.clear();
        config.inputs.clear();
      }
    }
    if (config.system.empty()) mistakes.push_back("system: name one, or give --config with one");
    if (app.count("--velocity") + app.count("--momentum") > 0)
      config.start.velocity = config.start.momentum = {};
    const auto collect = [&](const std::function<void()>& read) {
      try {
        read();
      } catch (const ConfigError& error) {
        mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
      }
    };
    for (const auto& override : overrides) collect([&] { override(config); });
    collect([&] { read_sets(sets, config.parameters); });
    collect([&] { read_inputs(inputs, config.inputs); });
    if (!mistakes.empty()) throw ConfigError(mistakes);
    return options;
  }

  // After the run of a record; or, of a file whose run is unfinished, with that run.
  void go_on(Config& config) {
    if (!record_file.ends_with(".h5") && !record_file.ends_with(".h5.part")) {
      config = Config::continued(read_file(record_file), record_file);
      return;
    }
    const Recorded file = read_recorded(record_file);
    config = file.config;
    if (file.finished) return;
    options.resumed = file.path;
    if (std::find(options.outputs.begin(), options.outputs.end(), file.path) ==
        options.outputs.end())
      options.outputs.push_back(file.path);
  }
};

int program(int argc, char** argv) {
  CLI::App app("Geometric integrators for nonholonomic systems on Lie groups.", "hamel");
  app.set_version_flag("--version", fmt::format("hamel {} ({})", version(), git_hash()));
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  hamel list systems\n"
      "  hamel describe suslov\n"
      "  hamel run suslov --retraction exp --s 0 --until 20 -o suslov.csv\n"
      "  hamel study tools/studies/readings.toml -o readings\n"
      "  hamel reproduce -o figures\n"
      "Every command has --help with examples.");
  std::function<int()> command;

  ListOptions listing;
  CLI::App* list_command = app.add_subcommand("list", "Tables of what exists by name");
  list_command->add_option("KIND", listing.kind,
                           "groups, retractions, schemes, solvers or systems");
  CLI::Option* as_json = list_command->add_flag("--json", listing.json, "as JSON");
  list_command->add_flag("--markdown", listing.markdown, "as the tables of README.md")
      ->excludes(as_json);
  list_command->footer("Examples:\n  hamel list\n  hamel list retractions --json");
  list_command->callback([&] { command = [&] { return list(listing); }; });

  DescribeOptions description;
  CLI::App* describe_command = app.add_subcommand(
      "describe", "One group, retraction, scheme, solver or system: formula, parameters, source");
  describe_command
      ->add_option("NAME", description.name, "a name (hamel list) or a file my_system.toml")
      ->required();
  std::vector<std::string> description_sets;
  describe_command
      ->add_option("--set", description_sets,
                   "a parameter of a system, name=value[,value...] (repeatable)")
      ->allow_extra_args(false);
  describe_command->add_flag("--analyse", description.analyse,
                             "a system: frame, structure constants, growth of brackets, what is "
                             "kept");
  describe_command->add_flag("--json", description.json, "as JSON");
  describe_command->footer(
      "Examples:\n  hamel describe suslov\n  hamel describe 'se2*so2'\n  hamel describe cayley "
      "--json\n  hamel describe --analyse chaplygin_sleigh --set offset=0");
  describe_command->callback([&] {
    command = [&] {
      read_sets(description_sets, description.parameters);
      return describe(description);
    };
  });

  RunLine line;
  CLI::App* run_command = app.add_subcommand("run", "One trajectory");
  line.define(*run_command);
  run_command->callback([&] { command = [&] { return run(line.resolve(*run_command)); }; });

  StudyOptions studying;
  CLI::App* study_command = app.add_subcommand(
      "study", "A comparative study: every combination of a file's lists, measured alike");
  study_command->add_option("FILE", studying.file, "a study, TOML (tools/studies)")->required();
  study_command->add_option("-o,--output", studying.directory,
                            "the folder for cells.csv, cells.h5, record.json, report.html "
                            "[FILE's name with -study]");
  study_command->add_option("--threads", studying.threads, "how many cells at a time [all cores]")
      ->check(CLI::Range(1, 1024));
  study_command->add_flag("--fresh", studying.fresh,
                          "begin anew where the folder has cells of an earlier run");
  study_command->add_flag("--json", studying.json, "print the record as JSON");
  study_command->add_flag("--quiet", studying.quiet, "print nothing but errors (and --json)");
  study_command->footer(
      "A study that was interrupted or killed goes on when the same command is given again.\n"
      "Exit status: 0 done (failed cells are results), 1 interrupted, 2 bad input.\n"
      "Examples:\n"
      "  hamel study tools/studies/readings.toml -o readings\n"
      "  hamel study tools/studies/solvers.toml -o solvers --threads 1   # quieter times");
  study_command->callback([&] { command = [&] { return study(studying); }; });

  SteadyOptions steadying;
  std::vector<std::string> steady_sets;
  std::string steady_configuration, steady_velocity;
  double steady_speed = 0;
  CLI::App* steady_command = app.add_subcommand(
      "steady", "A steady motion near a guess, its eigenvalues; along a parameter");
  steady_command
      ->add_option("SYSTEM", steadying.config.system,
                   "a system (hamel list systems) or a file my_system.toml")
      ->required();
  steady_command
      ->add_option("--set", steady_sets, "a parameter, name=value[,value...] (repeatable)")
      ->allow_extra_args(false);
  CLI::Option* steady_speed_option = steady_command->add_option(
      "--speed", steady_speed, "straight ahead at this speed, in m/s, for systems that know one");
  steady_command->add_option("--configuration", steady_configuration, "the guess, as for hamel run")
      ->type_name("A,B,...");
  steady_command->add_option("--velocity", steady_velocity, "the guess, as for hamel run")
      ->type_name("A,B,...");
  steady_command->add_option(
      "--vary", steadying.vary,
      "name=from:to:count: along a parameter, or speed; where stability changes");
  steady_command->add_option("--report", steadying.report,
                             "write a self-contained HTML page, with --vary");
  steady_command->add_flag("--json", steadying.json, "as JSON");
  steady_command->footer(
      "Exit status: 0 done, 1 none found, 2 bad input.\n"
      "Examples:\n"
      "  hamel steady bicycle --speed 5\n"
      "  hamel steady bicycle --vary speed=1:8:71 --report bicycle.html\n"
      "  hamel steady falling_disk --speed 1 --set gravity=1.62\n"
      "  hamel steady segway --speed 0 --vary height=0.2:1.2:11 --json");
  steady_command->callback([&] {
    command = [&] {
      read_sets(steady_sets, steadying.config.parameters);
      if (!steady_configuration.empty())
        read_text("--configuration", steady_configuration, steadying.config.start.configuration);
      if (!steady_velocity.empty())
        read_text("--velocity", steady_velocity, steadying.config.start.velocity);
      if (steady_speed_option->count() > 0) steadying.speed = steady_speed;
      return steady(steadying);
    };
  });

  ReproduceOptions reproduction;
  CLI::App* reproduce_command =
      app.add_subcommand("reproduce", "The paper's two figures, all readings side by side");
  reproduce_command->add_option("-o,--output", reproduction.directory,
                                "the folder for report.html, readings.csv and summary.txt "
                                "[reproduce-output]");
  reproduce_command->add_flag("--quiet", reproduction.quiet, "print nothing but errors");
  reproduce_command->footer("Examples:\n  hamel reproduce\n  hamel reproduce -o build/reproduce");
  reproduce_command->callback([&] { command = [&] { return reproduce(reproduction); }; });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  try {
    return command();
  } catch (const ConfigError& error) {
    for (const std::string& mistake : error.mistakes()) fmt::print(stderr, "hamel: {}\n", mistake);
    return kBadInput;
  } catch (const Unfinished& error) {
    fmt::print(stderr, "hamel: {}\n", error.what());
    return kUnfinished;
  } catch (const std::exception& error) {
    fmt::print(stderr, "hamel: {}\n", error.what());
    return kBadInput;
  }
}

}  // namespace
}  // namespace hamel::tools

int main(int argc, char** argv) { return hamel::tools::program(argc, argv); }
