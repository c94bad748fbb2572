// hamel: the command line. Names and formats are those of the contract (README, "Command line").
#include <algorithm>
#include <exception>
#include <functional>
#include <sstream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>

#include "commands.hpp"
#include "help.hpp"
#include "run_line.hpp"
#include "screen.hpp"
#include "steady.hpp"

namespace hamel::tools {
namespace {

constexpr int kUnfinished = 1, kBadInput = 2;

// The status of what was asked for, unless its text is lost.
int finish(int status) {
  try {
    finish_screen();
    return status;
  } catch (const Unfinished& error) {
    complain("hamel: {}\n", error.what());
    return status == 0 ? kUnfinished : status;
  }
}

// What a command returns; what it throws as a message and a status.
int carry_out(const std::function<int()>& command) {
  try {
    return command();
  } catch (const ConfigError& error) {
    for (const std::string& mistake : error.mistakes()) complain("hamel: {}\n", mistake);
    return kBadInput;
  } catch (const Unfinished& error) {
    complain("hamel: {}\n", error.what());
    return kUnfinished;
  } catch (const std::exception& error) {
    complain("hamel: {}\n", error.what());
    return kBadInput;
  }
}

int program(int argc, char** argv) {
  begin_screen();
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

  ReportOptions reporting;
  CLI::App* report_command = app.add_subcommand(
      "report", "The page of a run that is recorded in a file; of several, compared");
  report_command->add_option("FILE", reporting.files, "recorded runs, .h5 (hamel run -o x.h5)")
      ->required();
  report_command->add_option("-o,--output", reporting.output, "the page [report.html]");
  report_command->footer(
      "Examples:\n"
      "  hamel report disk.h5 -o disk.html\n"
      "  hamel report lift.h5 balance.h5 rkmk4.h5 -o compared.html");
  report_command->callback([&] { command = [&] { return report(reporting); }; });

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
      "Exit status: 0 done (failed cells are results), 1 interrupted or disk full, 2 bad input.\n"
      "Examples:\n"
      "  hamel study tools/studies/readings.toml -o readings\n"
      "  hamel study tools/studies/solvers.toml -o solvers --threads 1   # quieter times");
  study_command->callback([&] { command = [&] { return study(studying); }; });

  SteadyOptions steadying;
  std::vector<std::string> steady_sets;
  std::string steady_configuration, steady_velocity;
  CLI::App* steady_command = app.add_subcommand(
      "steady", "A steady motion near a guess, its eigenvalues; along a parameter");
  steady_command
      ->add_option("SYSTEM", steadying.config.system,
                   "a system (hamel list systems) or a file my_system.toml")
      ->required();
  steady_command
      ->add_option("--set", steady_sets, "a parameter, name=value[,value...] (repeatable)")
      ->allow_extra_args(false);
  steady_command->add_option(
      "--speed", steadying.config.speed,
      "the guess: straight ahead at this speed, in m/s, for systems that know such a motion");
  steady_command->add_option("--configuration", steady_configuration, "the guess, as for hamel run")
      ->type_name("A,B,...");
  steady_command->add_option("--velocity", steady_velocity, "the guess, as for hamel run")
      ->type_name("A,B,...");
  steady_command->add_option(
      "--vary", steadying.vary,
      "name=from:to:count: along a parameter, or speed; where stability changes");
  steady_command->add_flag("--branches", steadying.branches,
                           "with --vary: follow the branches that meet it, too");
  steady_command->add_option("--report", steadying.report,
                             "write a self-contained HTML page, with --vary");
  steady_command->add_flag("--json", steadying.json,
                           "as JSON; without --vary with the linearisation: A, B, C");
  steady_command->add_option("--sample-time", steadying.sample_time,
                             "with --json: the discrete pair for inputs held so long, in s");
  steady_command->footer(
      "Exit status: 0 done, 1 none found or disk full, 2 bad input.\n"
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

  std::string help_of;
  CLI::App* help_command = app.add_subcommand("help", "The help of a command");
  help_command->add_option("COMMAND", help_of, "one of those of hamel --help");
  help_command->footer("Example:\n  hamel help run");
  help_command->callback([&] {
    command = [&] {
      std::vector<std::string> names;
      for (const CLI::App* one : app.get_subcommands({})) names.push_back(one->get_name());
      const bool known = std::find(names.begin(), names.end(), help_of) != names.end();
      if (!known && !help_of.empty()) throw ConfigError({unknown_name("command", help_of, names)});
      const CLI::App& asked = known ? *app.get_subcommand(help_of) : app;
      say("{}", app.get_formatter()->make_help(&asked, known ? "hamel " + help_of : "hamel",
                                               CLI::AppFormatMode::Normal));
      return 0;
    };
  });
  set_help(app);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream help, mistake;
    const int status = app.exit(error, help, mistake) == 0 ? 0 : kBadInput;
    complain("{}", mistake.str());
    return finish(carry_out([&] {
      say("{}", help.str());
      return status;
    }));
  }
  return finish(carry_out(command));
}

}  // namespace
}  // namespace hamel::tools

int main(int argc, char** argv) { return hamel::tools::program(argc, argv); }
