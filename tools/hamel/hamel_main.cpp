#include "hamel_main.hpp"

#include <algorithm>
#include <exception>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <hamel/framework/graph/code.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>

#include "lines/command_lines.hpp"
#include "lines/help.hpp"
#include "words/screen.hpp"

namespace hamel::tools {
namespace {

constexpr int kUnfinished = 1, kBadInput = 2;

// The status of the command, unless its text is lost.
int finish(int status) {
  try {
    finish_screen();
    return status;
  } catch (const Unfinished& error) {
    complain("hamel: {}\n", error.what());
    return status == 0 ? kUnfinished : status;
  }
}

// Runs a command and returns its status; an exception becomes a message and a status.
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

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::App* one : app.get_subcommands({})) out.push_back(one->get_name());
  return out;
}

// hamel help COMMAND; without one, what hamel --help prints.
int print_help(const CLI::App& app, const std::string& of) {
  if (of.empty()) {
    say("{}", app.get_formatter()->make_help(&app, "hamel", CLI::AppFormatMode::Normal));
    return 0;
  }
  const std::vector<std::string> names = command_names(app);
  if (std::find(names.begin(), names.end(), of) == names.end())
    throw ConfigError({unknown_name("command", of, names)});
  CLI::App& asked = *app.get_subcommand(of);
  for (const Command& command : commands())
    if (command.name == of) command.define(asked);
  say("{}", app.get_formatter()->make_help(&asked, "hamel " + of, CLI::AppFormatMode::Normal));
  return 0;
}

// The first word that is neither a command nor an option of `hamel` itself; "" for none.
std::string first_mistake(const CLI::App& app, int argc, char** argv) {
  const std::vector<std::string> names = command_names(app);
  if (argc < 2) return fmt::format("a command is needed: expected one of {}", join(names));
  if (argv[1][0] == '-' || std::find(names.begin(), names.end(), argv[1]) != names.end()) return "";
  return unknown_name("command", argv[1], names);
}

// A mistake on the command line in the form of every other one.
std::string mistake_of(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> unexpected = app.remaining(true);
  const bool of_another_kind =
      dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr && !app.get_subcommands().empty();
  if (of_another_kind || unexpected.empty()) return error.what();
  const std::string word = unexpected.front().substr(0, unexpected.front().find('='));
  if (!word.starts_with('-')) return fmt::format("unexpected '{}'", word);
  const auto parsed = app.get_subcommands();
  std::vector<std::string> options;
  for (const CLI::Option* option : (parsed.empty() ? app : *parsed.front()).get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  return unknown_name("option", word, options);
}

// An option whose value is empty, as that of a variable of the shell which is not set; "" for none.
std::string empty_option(const CLI::App& app) {
  for (const CLI::App* line : app.get_subcommands()) {
    for (const CLI::Option* option : line->get_options()) {
      const std::vector<std::string>& given = option->results();
      if (!option->get_positional() && std::ranges::find(given, "") != given.end())
        return fmt::format("{}: got '', expected a value", option->get_name());
    }
  }
  return "";
}

std::string version_text(bool verbose) {
  std::string text = fmt::format("hamel {} ({})", version(), git_hash());
  if (!verbose) return text;
  text += fmt::format("\nbuilt by {}, {}", compiler(), build_flags());
  const std::string refused = graph::machine_code_refused();
  return text + (refused.empty()
                     ? "\nformulas: machine code for x86-64 with AVX, of 1, 4 or 8 bodies"
                     : fmt::format("\nformulas: interpreted, since {}", refused));
}

constexpr const char* kNoMachineCode = "--no-machine-code";

// Takes a flag that every command has out of the words before "--".
int take_no_machine_code(int argc, char** argv) {
  char** const last =
      std::find_if(argv, argv + argc, [](const char* word) { return std::string(word) == "--"; });
  char** const end = std::remove_if(argv + 1, std::max(argv + 1, last), [](const char* word) {
    return std::string(word) == kNoMachineCode;
  });
  if (end == last) return argc;
  setenv("HAMEL_NO_MACHINE_CODE", "1", 1);
  return static_cast<int>(std::copy(last, argv + argc, end) - argv);
}

}  // namespace

int hamel_main(int argc, char** argv) {
  begin_screen();
  argc = take_no_machine_code(argc, argv);
  CLI::App app("Geometric integrators for nonholonomic systems on Lie groups.", "hamel");
  app.set_version_flag("--version", [&app] { return version_text(app.count("--verbose") > 0); });
  app.add_flag("--verbose")->description("With --version: the build, and how formulas run");
  app.add_flag(kNoMachineCode)
      ->description("Of every command: formulas are interpreted, not machine code; the same bits");
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  hamel list systems\n"
      "  hamel describe suslov\n"
      "  hamel run suslov --scheme lift --retraction exp --s 0 --until 20 -o suslov.csv\n"
      "  hamel study tools/studies/readings.toml -o readings\n"
      "  hamel reproduce -o figures\n"
      "Every command has --help with examples.");
  std::function<int()> action;
  for (const Command& command : commands()) {
    CLI::App* line = app.add_subcommand(command.name, command.about);
    line->preparse_callback([&action, &command, line](size_t) { action = command.define(*line); });
  }
  std::string help_of;
  CLI::App* help = app.add_subcommand("help", "The help of a command");
  help->add_option("COMMAND", help_of, "one of those of hamel --help");
  help->footer("Example:\n  hamel help run");
  help->callback([&] { action = [&] { return print_help(app, help_of); }; });
  set_help(app);

  if (const std::string mistake = first_mistake(app, argc, argv); !mistake.empty()) {
    complain("hamel: {}\n", mistake);
    return kBadInput;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream text, unused;
    if (app.exit(error, text, unused) != 0) {
      complain("hamel: {}\n", mistake_of(app, error));
      return kBadInput;
    }
    return finish(carry_out([&] {
      say("{}", text.str());
      return 0;
    }));
  }
  if (const std::string mistake = empty_option(app); !mistake.empty()) {
    complain("hamel: {}\n", mistake);
    return kBadInput;
  }
  return finish(carry_out(action));
}

}  // namespace hamel::tools
