#include "program.hpp"

#include <fcntl.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

template class nlohmann::basic_json<>;

namespace hamel::test {

std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, separator);) out.push_back(word);
  return out;
}

bool must_have(const std::string& part) {
  if (part != "page") return std::getenv("CI") != nullptr;
  const char* const asked = std::getenv("HAMEL_REPORT_PAGE");
  return asked != nullptr && std::string(asked) == "ON";
}

std::string source_file(const std::string& path) {
  const char* root = std::getenv("HAMEL_SOURCE");
  EXPECT_NE(root, nullptr) << "set HAMEL_SOURCE to the source tree (ctest does)";
  return contents(std::filesystem::path(root != nullptr ? root : "") / path);
}

nlohmann::json page_data(const std::string& page) {
  const std::string head = "id=\"hamel-data\">";
  const size_t from = page.find(head) + head.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

nlohmann::json figure_of(const nlohmann::json& page, const std::string& title) {
  for (const nlohmann::json& section : page["sections"])
    for (const nlohmann::json& block : section["blocks"])
      if (block.value("title", "") == title) return block;
  return {};
}

void CommandLine::SetUp() {
  const char* path = std::getenv("HAMEL_PROGRAM");
  ASSERT_NE(path, nullptr) << "set HAMEL_PROGRAM to the program (ctest does)";
  program_ = path;
  std::string pattern = (std::filesystem::temp_directory_path() / "hamel_cli_XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  folder_ = pattern;
}

void CommandLine::TearDown() { std::filesystem::remove_all(folder_); }

std::string CommandLine::file(const std::string& name) const { return (folder_ / name).string(); }

std::vector<std::string> CommandLine::files() const {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    out.push_back(entry.path().filename());
  return out;
}

Outcome CommandLine::run(const std::vector<std::string>& arguments, const std::string& before,
                         const std::string& behind) const {
  const std::string out = folder_.string() + ".out", err = folder_.string() + ".err";
  std::string command = "cd " + quoted(folder_.string()) + " && " + before + quoted(program_);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command += " 2>" + quoted(err) + " </dev/null " + behind + " >" + quoted(out);
  const int status = std::system(command.c_str());
  Outcome result{WIFEXITED(status) ? WEXITSTATUS(status) : 128, contents(out), contents(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
#ifdef HAMEL_PAGE_IS_MADE
  EXPECT_THAT(result.err, testing::Not(testing::HasSubstr("without the page")))
      << "the build was configured with the page (HAMEL_REPORT_PAGE, node, npm)";
#endif
  return result;
}

nlohmann::json CommandLine::answer(std::vector<std::string> arguments, int status) const {
  arguments.emplace_back("--json");
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.status, status) << outcome.err;
  return nlohmann::json::parse(outcome.out.empty() ? "{}" : outcome.out);
}

nlohmann::json CommandLine::record(std::vector<std::string> arguments, int status) const {
  arguments.insert(arguments.begin(), "run");
  return answer(std::move(arguments), status);
}

nlohmann::json CommandLine::page_by(const std::vector<std::string>& arguments,
                                    const std::string& name) const {
  const Outcome outcome = run(arguments);
  if (outcome.err.find("without the page") != std::string::npos) return {};
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return page_data(contents(file(name)));
}

nlohmann::json CommandLine::page_of(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), "run");
  arguments.insert(arguments.end(), {"--quiet", "--report", "page.html"});
  return page_by(arguments);
}

std::map<std::string, std::vector<std::string>> CommandLine::curves(
    std::vector<std::string> arguments) const {
  std::map<std::string, std::vector<std::string>> out;
  const nlohmann::json page = page_of(std::move(arguments));
  if (page.is_null()) return out;
  for (const auto& section : page["sections"]) {
    for (const auto& block : section["blocks"]) {
      if (!block.contains("series")) continue;
      for (const auto& series : block["series"]) out[block["title"]].push_back(series["name"]);
    }
  }
  return out;
}

std::string CommandLine::write(const std::string& text) const { return write("system.toml", text); }

std::string CommandLine::write(const std::string& name, const std::string& text) const {
  std::ofstream(file(name)) << text;
  return file(name);
}

void CommandLine::refused(const std::string& text, const std::string& message) const {
  const Outcome outcome = run({"run", write(text)});
  EXPECT_EQ(outcome.status, 2) << text;
  EXPECT_THAT(outcome.err, testing::HasSubstr(message)) << text;
}

pid_t CommandLine::started(const std::vector<std::string>& arguments) const {
  const pid_t child = fork();
  EXPECT_GE(child, 0);
  if (child != 0) return child;
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDERR_FILENO);
  dup2(nowhere, STDOUT_FILENO);
  std::vector<char*> words = {const_cast<char*>("hamel")};
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  if (chdir(folder_.c_str()) == 0) execv(program_.c_str(), words.data());
  _exit(127);
}

std::string CommandLine::quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace hamel::test
