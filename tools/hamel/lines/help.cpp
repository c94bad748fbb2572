#include "lines/help.hpp"

#include <memory>

namespace hamel::tools {
namespace {

constexpr size_t kHelpWidth = 100, kHelpColumn = 30;

// A name and, from a column on, its meaning.
std::string entry(const std::string& name, const std::string& meaning) {
  std::string out = name;
  if (name.size() < kHelpColumn) out.append(kHelpColumn - name.size(), ' ');
  else out += '\n' + std::string(kHelpColumn, ' ');
  bool first = true;
  for (std::string line : wrapped(meaning, kHelpWidth - kHelpColumn)) {
    if (line.ends_with(' ')) line.pop_back();
    out += (first ? "" : std::string(kHelpColumn, ' ')) + line + '\n';
    first = false;
  }
  return out;
}

class Help final : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool positional) const override {
    return entry("  " + make_option_name(option, positional) + make_option_opts(option),
                 make_option_desc(option));
  }
  std::string make_subcommand(const CLI::App* command) const override {
    return entry("  " + command->get_name(), command->get_description());
  }
};

}  // namespace

// The lines of a text, broken behind spaces and commas where it is longer; a longer word stays
// whole.
std::vector<std::string> wrapped(const std::string& text, size_t width) {
  std::vector<std::string> out;
  std::string line, word;
  const auto put = [&] {
    if (!line.empty() && line.size() + word.size() - (word.ends_with(' ') ? 1 : 0) > width) {
      out.push_back(line);
      line.clear();
    }
    line += word;
    word.clear();
  };
  for (const char c : text) {
    word += c;
    if (c == ' ' || c == ',') put();
  }
  put();
  out.push_back(line);
  return out;
}

void add_verbose(CLI::App& app, bool& verbose) {
  app.add_flag("--verbose", verbose, "print notes in full");
}

void set_help(CLI::App& app) {
  const auto help = std::make_shared<Help>();
  app.formatter(help);
  for (CLI::App* command : app.get_subcommands({})) command->formatter(help);
}

void group_options(CLI::App& app, const std::string& title, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (CLI::Option* option = app.get_option_no_throw(name)) option->group(title);
  }
}

}  // namespace hamel::tools
