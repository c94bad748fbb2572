#include "lines/run_line.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/run/record/result.hpp>

#include "lines/help.hpp"

namespace hamel::tools {
namespace {

std::string read_file(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw ConfigError({fmt::format("cannot read '{}'", path)});
  return text.str();
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

}  // namespace

void group_run_options(CLI::App& app) {
  group_options(app, "Motion",
                {"--config", "--continue", "--set", "--input", "--configuration", "--velocity",
                 "--momentum", "--speed", "--start", "--slip", "--from", "--until"});
  group_options(
      app, "Method",
      {"--scheme", "--retraction", "--s", "--step", "--rtol", "--atol", "--step-max", "--steps-max",
       "--solver", "--tolerance", "--force-at", "--compose", "--force", "--on-failure"});
  group_options(app, "Events and checks", {"--events", "--stop-at", "--check", "--no-exact"});
  group_options(app, "Output",
                {"--output", "--every", "--output-step", "--output-times", "--report", "--json",
                 "--quiet", "--verbose"});
}

std::string flag_of(const Option& option) {
  std::string flag = fmt::format("--{}", option.name);
  std::ranges::replace(flag, '_', '-');
  return flag;
}

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

void RunLine::define_run(CLI::App& app, const std::set<std::string>& without) {
  app.add_option("SYSTEM", system,
                 "a registered system (hamel list systems) or a file, my_system.toml, robot.urdf");
  app.add_option("--config", config_file, "a TOML file with the same names; the command line wins");
  robot.define(app);
  define_options(app, without);
}

void RunLine::define_options(CLI::App& app, const std::set<std::string>& without) {
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
    if (without.contains(field.name)) return;
    option<Value>(app, field, Config().*member,
                  [member](Config& c) -> Value& { return c.*member; });
  });
}

std::map<std::string, std::string> RunLine::given(const CLI::App& app) {
  std::map<std::string, std::string> out;
  const auto take = [&](const Option& field, auto) {
    const CLI::Option* option = app.get_option_no_throw(flag_of(field));
    if (option != nullptr && option->count() > 0)
      out[field.name] = fmt::format("{}", fmt::join(option->results(), ","));
  };
  Config::start_fields(take);
  Config::fields(take);
  return out;
}

void RunLine::define(CLI::App& app) {
  define_run(app, {});
  for (const char* name : {"output", "report", "json", "quiet", "verbose"}) own[name];
  for (const std::string& name : RobotLine::keys()) own[name];
  app.add_option(
         "--continue", record_file,
         "resume where the run of this record (-o x.json, x.h5) ended, as it was run, for as long "
         "again; the command line wins. An unfinished .h5: with that run, bit for bit")
      ->excludes("--config");
  app.add_option("-o,--output", options.outputs,
                 "write .csv, .csv.gz, .h5 or .json, as the rows come; - is CSV to standard output "
                 "(repeatable)")
      ->allow_extra_args(false);
  app.add_option("--report", options.report, "write a self-contained HTML page");
  app.add_flag("--json", options.json, "print the record as JSON");
  app.add_flag("--quiet", options.quiet, "print nothing but errors (and --json)");
  add_verbose(app, options.verbose);
  group_run_options(app);
  app.footer(
      "Exit status: 0 done, 1 numerical failure (what was computed is written), or interrupted "
      "or disk\n"
      "full (it is in FILE.part), 2 bad input.\n"
      "--events and --stop-at also take formulas, with = or with > or < for one direction, over "
      "t,\n"
      "columns, velocities by name, and parameters: 'x^2+y^2=1', 'theta>pi/2', 'omega1=omega2'.\n"
      "Examples:\n"
      "  hamel run suslov --until 20 --report suslov.html\n"
      "  hamel run suslov --set inertia=2,0.3,0.5,3,0.4,4 --velocity 1,0.5,0 --retraction exp\n"
      "  hamel run chaplygin_sleigh --scheme balance --step 0.05 -o sleigh.csv --json\n"
      "  hamel run bicycle --speed 5 --report bicycle.html\n"
      "  hamel run bicycle --speed 5 --start steer.angle=0.1,w1=0.2 --until 5\n"
      "  hamel run bicycle --speed 5 --stop-at 'steer.angle<-0.02' -o bicycle.csv\n"
      "  hamel run rolling_disk --compose suzuki4 --velocity 0.7,1,0,2 -o disk.csv\n"
      "  hamel run robot.urdf --wheel auto --speed 0.5\n"
      "  hamel run robot.urdf --wheel left_wheel,radius=0.05 --wheel right_wheel --motor "
      "left_axle\n"
      "  hamel run segway --input right_torque=2 --input left_torque=torque.csv:hold\n"
      "  hamel run roller_racer -o first.json && hamel run --continue first.json --until 60\n"
      "  hamel run rolling_disk --until 1e5 -o disk.h5 || hamel run --continue disk.h5");
}

RunOptions RunLine::resolve(const CLI::App& app) {
  Config& config = options.config;
  std::vector<std::string> mistakes;
  if (!config_file.empty()) {
    config = read_config_file(config_file, own);
    take(app, "output", options.outputs);
    take(app, "report", options.report);
    take(app, "json", options.json);
    take(app, "quiet", options.quiet);
    take(app, "verbose", options.verbose);
    take(app, "wheel", robot.wheels);
    take(app, "motor", robot.motors);
    take(app, "weld", robot.welds);
    take(app, "weld_all_but", robot.movable);
    take(app, "joint_friction", robot.rubbing);
    take(app, "hold", robot.held);
    take(app, "root", robot.root);
  }
  if (!record_file.empty()) go_on(config);
  if (!system.empty() && system != config.system) {
    config.system = system;
    if (!record_file.empty()) {  // another system's, or a file's, which has none
      config.parameters.clear();
      config.inputs.clear();
    }
  }
  if (config.system.empty()) mistakes.push_back("system: name one, or give --config with one");
  if (app.count("--velocity") + app.count("--momentum") > 0) {
    config.start.velocity = config.start.momentum = {};
    config.speed.reset();
  }
  if (app.count("--speed") > 0) config.start = {};
  const auto given = [&](const char* flag) {
    const CLI::Option* option = app.get_option_no_throw(flag);
    return option != nullptr && option->count() > 0;
  };
  if (given("--every") || given("--output-step") || given("--output-times")) {  // one of them
    config.every = Config().every;
    config.output_step.reset();
    config.output_times.clear();
  }
  const auto collect = [&](const std::function<void()>& read) {
    try {
      read();
    } catch (const ConfigError& error) {
      mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
    }
  };
  for (const auto& override : overrides) collect([&] { override(config); });
  collect([&] { config.system = robot.resolve(config.system); });
  collect([&] { read_sets(sets, config.parameters); });
  collect([&] { read_inputs(inputs, config.inputs); });
  if (!mistakes.empty()) throw ConfigError(mistakes);
  return options;
}

void RunLine::go_on(Config& config) {
  if (!record_file.ends_with(".h5") && !record_file.ends_with(".h5.part")) {
    config = Config::continued(read_file(record_file), record_file);
    return;
  }
  const Recorded file = read_recorded(record_file);
  config = file.config;
  if (file.finished) return;
  options.resumed = file.path;
  const bool named = std::ranges::any_of(options.outputs, [&](const std::string& path) {
    return place_of(path) == place_of(file.path);
  });
  if (!named) options.outputs.push_back(file.path);
}

}  // namespace hamel::tools
