// The commands of the program in a page: a command line and files in; what it prints, and the data
// of the pages that it writes, out.
#include <emscripten.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/pages/page.hpp>

#include "commands.hpp"
#include "hamel_main.hpp"
#include "request.hpp"
#include "words/interrupt.hpp"
#include "words/screen.hpp"

namespace hamel {
namespace tools {
namespace {

std::string screen;  // of the command that runs

// Commands that need other programs, or a disk.
int nowhere(const char* command) {
  throw ConfigError({std::string(command) + ": not in a page; install hamel for it"});
}

}  // namespace

void begin_screen() { screen.clear(); }
void write_screen(std::string_view text) { screen += text; }
void finish_screen() {}
void write_message(std::string_view text) { screen += text; }

const std::atomic<bool>& stop_when_asked() {
  static const std::atomic<bool> never = false;
  return never;
}

Elapsed::Elapsed(std::string) {}
Elapsed::~Elapsed() = default;
Progress::Progress(std::string what, bool) : what_(std::move(what)), active_(false) {}
Progress::~Progress() = default;
void Progress::operator()(double) {}

int live(const LiveOptions&) { return nowhere("live"); }
int new_project(const NewOptions&) { return nowhere("new"); }
int report(const ReportOptions&) { return nowhere("report"); }
int reproduce(const ReproduceOptions&) { return nowhere("reproduce"); }

}  // namespace tools

namespace pages {

// A page is its data alone: this one is around them.
std::string_view report_page() { return "__HAMEL_DATA__"; }

}  // namespace pages

namespace playground {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// {status, text, pages: [{file, page}], files} of {words, files: {name: text}}, in an empty folder.
Json command(const Json& request) {
  const fs::path folder = "/terminal";
  fs::current_path("/");
  fs::remove_all(folder);
  fs::create_directory(folder);
  fs::current_path(folder);
  for (const auto& [name, text] : request.at("files").items())
    std::ofstream(folder / fs::path(name).filename(), std::ios::binary) << text.get<std::string>();
  std::vector<std::string> words = request.at("words");
  words.insert(words.begin(), "hamel");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int status = tools::hamel_main(static_cast<int>(words.size()), arguments.data());
  Json pages = Json::array(), files = Json::array();
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder);
    if (!entry.is_regular_file() || request.at("files").contains(name)) continue;
    files.push_back(name);
    if (entry.path().extension() != ".html") continue;
    pages.push_back({{"file", name}, {"page", Json::parse(text_of(entry.path()))}});
  }
  return {{"ok", true},
          {"status", status},
          {"text", tools::screen},
          {"pages", pages},
          {"files", files}};
}

}  // namespace
}  // namespace playground
}  // namespace hamel

extern "C" {

/// A command line of the program.
EMSCRIPTEN_KEEPALIVE const char* hamel_command(const char* request) {
  return hamel::playground::answer(request, hamel::playground::command);
}
}
