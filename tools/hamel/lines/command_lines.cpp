// The options of each command, read into what it runs.
#include "lines/command_lines.hpp"

#include <memory>
#include <string>

#include "commands.hpp"
#include "fit.hpp"
#include "lines/help.hpp"
#include "lines/number_option.hpp"
#include "lines/page_lines.hpp"
#include "lines/run_line.hpp"
#include "plan.hpp"
#include "section.hpp"
#include "steady.hpp"

namespace hamel::tools {
namespace {

// Options of a command whose work, pieces of a file, is cut into parts that share a folder.
void add_parts(CLI::App& app, PartOptions& options, const std::string& file,
               const std::string& pieces, const std::string& folder) {
  app.add_option("FILE", options.file, file + ", TOML (tools/studies)")->required();
  app.add_option("-o,--output", options.directory, "the folder for " + folder);
  app.add_option("--threads", options.threads, "how many " + pieces + " at a time [all cores]")
      ->check(CLI::Range(1, 1024));
  CLI::Option* merge = app.add_flag("--merge", options.merge,
                                    "join the parts that are in the folder; nothing is run");
  app.add_option("--shard", options.shard, "i/n: the i-th of n parts alone, kept in the folder")
      ->excludes(merge);
  app.add_flag("--fresh", options.fresh,
               "begin anew where the folder has " + pieces + " of an earlier run")
      ->excludes(merge);
  app.add_flag("--json", options.json, "print the record as JSON");
  app.add_flag("--quiet", options.quiet, "print nothing but errors (and --json)");
  add_verbose(app, options.verbose);
}

Action define_list(CLI::App& app) {
  const auto options = std::make_shared<ListOptions>();
  app.add_option("KIND", options->kind, "groups, retractions, schemes, solvers or systems");
  CLI::Option* as_json = app.add_flag("--json", options->json, "as JSON");
  app.add_flag("--markdown", options->markdown, "as the tables of README.md")->excludes(as_json);
  app.footer("Examples:\n  hamel list\n  hamel list retractions --json");
  return [options] { return list(*options); };
}

Action define_describe(CLI::App& app) {
  struct Line {
    DescribeOptions options;
    RobotLine robot;
    std::vector<std::string> sets;
  };
  const auto line = std::make_shared<Line>();
  app.add_option("NAME", line->options.name,
                 "a name (hamel list) or a file, my_system.toml, robot.urdf")
      ->required();
  app.add_option("--set", line->sets, "a parameter of a system, name=value[,value...] (repeatable)")
      ->allow_extra_args(false);
  app.add_flag("--analyse", line->options.analyse,
               "a system: frame, structure constants, growth of brackets, what is kept");
  CLI::Option* as_equations =
      app.add_option("--equations", line->options.equations,
                     "a system: its equations of motion, as latex, c, numpy or sympy");
  line->robot.define(app);
  CLI::Option* as_toml =
      app.add_flag("--toml", line->options.toml,
                   "print the file of a mechanism, of a robot in URDF too, for further changes");
  as_toml->excludes(as_equations);
  app.add_flag("--json", line->options.json, "as JSON")->excludes(as_toml)->excludes(as_equations);
  add_verbose(app, line->options.verbose);
  app.footer(
      "Examples:\n  hamel describe suslov\n  hamel describe 'se2*so2'\n  hamel describe cayley "
      "--json\n  hamel describe --analyse chaplygin_sleigh --set offset=0\n"
      "  hamel describe --equations numpy chaplygin_sleigh\n"
      "  hamel describe robot.urdf --wheel left_wheel --wheel right_wheel --toml");
  return [line] {
    read_sets(line->sets, line->options.parameters);
    line->options.name = line->robot.resolve(line->options.name);
    return describe(line->options);
  };
}

Action define_run(CLI::App& app) {
  const auto line = std::make_shared<RunLine>();
  line->define(app);
  return [line, &app] { return run(line->resolve(app)); };
}

Action define_study(CLI::App& app) {
  const auto options = std::make_shared<PartOptions>();
  add_parts(app, *options, "a study", "cells",
            "cells.csv, cells.h5, record.json, report.html [FILE's name with -study]");
  app.footer(
      "A study that was interrupted or killed resumes when the same command is given again.\n"
      "Exit status: 0 done (failed cells are results), 1 interrupted or disk full, 2 bad input.\n"
      "Examples:\n"
      "  hamel study tools/studies/readings.toml -o readings\n"
      "  hamel study tools/studies/solvers.toml -o solvers --threads 1   # quieter times");
  return [options] { return study(*options); };
}

Action define_ensemble(CLI::App& app) {
  const auto options = std::make_shared<EnsembleOptions>();
  add_parts(app, *options, "an ensemble", "members",
            "ensemble.h5, ensemble.csv, ensemble.json, report.html [FILE's name with -ensemble]");
  number_option<long>(
      app, "--member", [options](long member) { options->member = member; },
      "one member alone, from 0; with -o its configuration and its page")
      ->excludes(app.get_option("--shard"))
      ->excludes(app.get_option("--merge"));
  app.footer(
      "An ensemble that was interrupted or killed resumes when the same command is given again.\n"
      "Exit status: 0 done (failed members are listed), 1 interrupted or disk full, 2 bad input.\n"
      "Examples:\n"
      "  hamel ensemble tools/studies/rattleback_reversals.toml -o reversals\n"
      "  hamel ensemble tools/studies/suslov_scattering.toml --member 17 -o scattering\n"
      "  hamel ensemble many.toml -o many --shard 1/2     # on one machine\n"
      "  hamel ensemble many.toml -o many --shard 2/2     # on another\n"
      "  hamel ensemble many.toml -o many --merge\n"
      "  mpirun -n 4 hamel ensemble many.toml -o many     # a rank is a shard; rank 0 merges");
  return [options] { return ensemble(*options); };
}

Action define_steady(CLI::App& app) {
  struct Line {
    SteadyOptions options;
    RobotLine robot;
    std::vector<std::string> sets;
    std::string configuration, velocity;
  };
  const auto line = std::make_shared<Line>();
  SteadyOptions& options = line->options;
  app.add_option("SYSTEM", options.config.system,
                 "a system (hamel list systems) or a file, my_system.toml, robot.urdf")
      ->required();
  line->robot.define(app);
  app.add_option("--set", line->sets, "a parameter, name=value[,value...] (repeatable)")
      ->allow_extra_args(false);
  number_option(app, "--speed", options.config.speed,
                "the guess: straight ahead at this speed, in m/s, for systems that define a "
                "straight motion");
  app.add_option("--start", options.config.start_values,
                 "the guess by names, NAME=VALUE, also beside --speed (repeatable)")
      ->allow_extra_args(false);
  app.add_option("--configuration", line->configuration, "the guess, as for hamel run")
      ->type_name("A,B,...");
  app.add_option("--velocity", line->velocity, "the guess, as for hamel run")->type_name("A,B,...");
  app.add_option("--vary", options.vary,
                 "name=from:to:count: along a parameter, or speed; where stability changes");
  app.add_flag("--branches", options.branches,
               "with --vary: follow the branches that meet it, too");
  app.add_option("--report", options.report, "write a self-contained HTML page, with --vary");
  app.add_flag("--json", options.json, "as JSON; without --vary with the linearisation: A, B, C");
  add_verbose(app, options.verbose);
  number_option(app, "--sample-time", options.sample_time,
                "with --json: the discrete pair for inputs held so long, in s");
  app.footer(
      "Exit status: 0 done, 1 none found or disk full, 2 bad input.\n"
      "Examples:\n"
      "  hamel steady bicycle --speed 5\n"
      "  hamel steady bicycle --vary speed=1:8:71 --report bicycle.html\n"
      "  hamel steady falling_disk --speed 1 --set gravity=1.62\n"
      "  hamel steady segway --speed 0 --vary height=0.2:1.2:11 --json");
  return [line] {
    Config& config = line->options.config;
    config.system = line->robot.resolve(config.system);
    read_sets(line->sets, config.parameters);
    if (!line->configuration.empty())
      read_text("--configuration", line->configuration, config.start.configuration);
    if (!line->velocity.empty()) read_text("--velocity", line->velocity, config.start.velocity);
    return steady(line->options);
  };
}

Action define_section(CLI::App& app) {
  const auto line = std::make_shared<SectionLine>();
  line->define(app);
  return [line, &app] { return section(line->resolve(app)); };
}

Action define_plan(CLI::App& app) {
  const auto options = std::make_shared<PlanOptions>();
  app.add_option("FILE", options->file, "a plan file, TOML: system, inputs, [from], [to], [cost]")
      ->required();
  app.add_option("-o,--output", options->output,
                 "write the inputs as a table, .csv, that --input of hamel run takes");
  app.add_option("--report", options->report,
                 "write the page of the run that repeats the plan, self-contained HTML");
  app.add_option("--track", options->track,
                 "write the gains of a linear feedback along the plan as a table, .csv");
  app.add_flag("--json", options->json, "print everything as JSON");
  app.add_flag("--quiet", options->quiet, "print nothing but errors (and --json)");
  add_verbose(app, options->verbose);
  app.footer(
      "Exit status: 0 done, 1 out of reach (the plan that misses the goal least is written) or "
      "failed, 2 bad input.\n"
      "Examples:\n"
      "  hamel plan parking.toml -o parking.csv\n"
      "  hamel run sleigh.toml --scheme lift --step 0.04 --until 4 --input "
      "force=parking.csv:hold\n"
      "  hamel plan parking.toml --report parking.html --json");
  return [options] { return plan(*options); };
}

Action define_fit(CLI::App& app) {
  const auto line = std::make_shared<FitLine>();
  line->define(app);
  return [line, &app] { return fit(line->resolve(app)); };
}

Action define_new(CLI::App& app) {
  const auto options = std::make_shared<NewOptions>();
  app.add_option("KIND", options->kind, "system, group, scheme or project (a mechanism by parts)")
      ->required();
  app.add_option("NAME", options->name, "its name and folder, which must not exist: my_sleigh")
      ->required();
  app.footer(
      "The folder has CMakeLists.txt, the source, a program, a test with the laws of hamel, and a "
      "file for CI.\n"
      "Examples:\n"
      "  hamel new system my_sleigh\n"
      "  hamel new project my_cart");
  return [options] { return new_project(*options); };
}

Action define_reproduce(CLI::App& app) {
  const auto options = std::make_shared<ReproduceOptions>();
  app.add_option("-o,--output", options->directory,
                 "the folder for report.html, readings.csv and summary.txt [reproduce-output]");
  app.add_flag("--quiet", options->quiet, "print nothing but errors");
  app.footer("Examples:\n  hamel reproduce\n  hamel reproduce -o build/reproduce");
  return [options] { return reproduce(*options); };
}

}  // namespace

const std::vector<Command>& commands() {
  static const std::vector<Command> all = {
      {"list", "Tables of what exists by name", define_list},
      {"describe", "One group, retraction, scheme, solver or system: formula, parameters, source",
       define_describe},
      {"run", "One trajectory", define_run},
      {"report", "The page of a run that is recorded in a file; of several, compared",
       define_report},
      {"study", "A comparative study: every combination of a file's lists, measured alike",
       define_study},
      {"ensemble", "Many runs: parameters, starts and inputs varied, what is asked for kept",
       define_ensemble},
      {"steady", "A steady motion near a guess, its eigenvalues; along a parameter", define_steady},
      {"section", "A Poincare section: the states in which motions cross an event", define_section},
      {"live", "The playground in a browser, with a system in it: edited, moved, watched",
       define_live},
      {"plan", "Inputs that take a system to a goal at the least cost, from a file", define_plan},
      {"fit", "Parameters, starts and inputs from recordings", define_fit},
      {"new", "A project of your own that compiles: a system, a group, a scheme, a mechanism",
       define_new},
      {"reproduce", "The paper's two figures, all variants side by side", define_reproduce},
  };
  return all;
}

}  // namespace hamel::tools
