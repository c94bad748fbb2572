// hamel: the command line. Names and formats are those of the contract (README, "Command line").
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/version.hpp>

#include "commands.hpp"

namespace hamel::tools {
namespace {

constexpr int kBadInput = 2;

// "1,10,100" -> {1, 10, 100}.
std::vector<double> read_numbers(const std::string& option, const std::string& text) {
  if (text.empty() || text.back() == ',') {
    throw ConfigError(
        {fmt::format("{}: got '{}', expected numbers separated by commas", option, text)});
  }
  std::vector<double> out;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) {
    size_t used = 0;
    double value = 0;
    try {
      value = std::stod(word, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || used != word.size()) {
      throw ConfigError({fmt::format("{}: '{}' in '{}' is not a number", option, word, text)});
    }
    out.push_back(value);
  }
  return out;
}

// The options of `hamel run` as given; the file first, then what the command line says.
struct RunLine {
  std::string system, config_file;
  std::optional<std::string> configuration, velocity, momentum;
  std::vector<std::string> sets;
  std::optional<std::string> scheme, retraction, solver, on_failure, compose;
  std::optional<double> s, tolerance, step, until;
  std::optional<long> every;
  RunOptions options;

  void define(CLI::App& app) {
    app.add_option("SYSTEM", system,
                   "a registered system (hamel list systems) or a file my_system.toml");
    app.add_option("--config", config_file,
                   "a TOML file with the same names; the command line wins");
    app.add_option("--set", sets, "a parameter, name=value[,value...] (repeatable)")
        ->allow_extra_args(false);
    app.add_option("--configuration", configuration, "start: the element's CSV columns, a,b,...");
    app.add_option("--velocity", velocity, "start: body velocity, a,b,...");
    app.add_option("--momentum", momentum, "start: body momentum, a,b,...");
    app.add_option("--scheme", scheme, "reading of the method [lift]");
    app.add_option("--s", s, "discretisation parameter in [0, 1] [0.5]");
    app.add_option("--retraction", retraction, "retraction map [cayley]");
    app.add_option("--solver", solver, "implicit-equation solver [newton]");
    app.add_option("--tolerance", tolerance, "relative residual of each step [1e-13]");
    app.add_option("--on-failure", on_failure,
                   "a step that fails: stop, halve, or retry:<solver> [stop]");
    app.add_option("--compose", compose,
                   "none, yoshida4, suzuki4, yoshida6, kahan_li6 or suzuki_umeno8 [none]");
    app.add_option("--step", step, "step in seconds, of either sign [0.01]");
    app.add_option("--until", until, "end time in seconds [20]");
    app.add_option("--every", every, "record every this many steps [1]");
    app.add_option("-o,--output", options.outputs, "write .csv or .json (repeatable)")
        ->allow_extra_args(false);
    app.add_option("--report", options.report, "write a self-contained HTML page");
    app.add_flag("--json", options.json, "print the record as JSON");
    app.add_flag("--quiet", options.quiet, "print nothing but errors (and --json)");
    app.footer(
        "Exit status: 0 done, 1 numerical failure (what was computed is written), 2 bad input.\n"
        "Examples:\n"
        "  hamel run suslov --until 20 --report suslov.html\n"
        "  hamel run suslov --set inertia=2,0.3,0.5,3,0.4,4 --velocity 1,0.5,0 --retraction exp\n"
        "  hamel run chaplygin_sleigh --scheme balance --step 0.05 -o sleigh.csv --json\n"
        "  hamel run rolling_disk --compose suzuki4 --velocity 0.7,1,0,2 -o disk.csv");
  }

  RunOptions resolve() {
    Config& config = options.config;
    std::vector<std::string> mistakes;
    if (!config_file.empty()) config = read_config(config_file);
    if (!system.empty()) config.system = system;
    if (config.system.empty()) mistakes.push_back("system: name one, or give --config with one");
    const auto take = [](const auto& given, auto& value) {
      if (given) value = *given;
    };
    take(scheme, config.scheme);
    take(retraction, config.retraction);
    take(solver, config.solver);
    take(on_failure, config.on_failure);
    take(compose, config.compose);
    take(s, config.s);
    take(tolerance, config.tolerance);
    take(step, config.step);
    take(until, config.until);
    take(every, config.every);
    const auto collect = [&](const std::function<void()>& read) {
      try {
        read();
      } catch (const ConfigError& error) {
        mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
      }
    };
    const auto list = [&](const char* option, const std::optional<std::string>& text,
                          std::vector<double>& out) {
      if (text) collect([&] { out = read_numbers(option, *text); });
    };
    if (velocity || momentum) config.start.velocity = config.start.momentum = {};
    list("--configuration", configuration, config.start.configuration);
    list("--velocity", velocity, config.start.velocity);
    list("--momentum", momentum, config.start.momentum);
    for (const std::string& set : sets) {
      collect([&] {
        const size_t equal = set.find('=');
        if (equal == std::string::npos || equal == 0) {
          throw ConfigError({fmt::format("--set: '{}' is not name=value[,value...]", set)});
        }
        const std::string name = set.substr(0, equal);
        config.parameters[name] = read_numbers("--set " + name, set.substr(equal + 1));
      });
    }
    if (!mistakes.empty()) throw ConfigError(mistakes);
    return options;
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
  describe_command->add_option("NAME", description.name, "a name (hamel list)")->required();
  describe_command->add_flag("--analyse", description.analyse,
                             "a system (or a file my_system.toml): frame, structure constants, "
                             "growth of brackets, what is kept");
  describe_command->add_flag("--json", description.json, "as JSON");
  describe_command->footer(
      "Examples:\n  hamel describe suslov\n  hamel describe 'se2*so2'\n  hamel describe cayley "
      "--json\n  hamel describe --analyse chaplygin_sleigh");
  describe_command->callback([&] { command = [&] { return describe(description); }; });

  RunLine line;
  CLI::App* run_command = app.add_subcommand("run", "One trajectory");
  line.define(*run_command);
  run_command->callback([&] { command = [&] { return run(line.resolve()); }; });

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
  } catch (const std::exception& error) {
    fmt::print(stderr, "hamel: {}\n", error.what());
    return kBadInput;
  }
}

}  // namespace
}  // namespace hamel::tools

int main(int argc, char** argv) { return hamel::tools::program(argc, argv); }
