// Runs the program whose path is in $HAMEL_PROGRAM, as a shell would: arguments, output, exit
// status.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

extern template class nlohmann::basic_json<>;

namespace hamel::test {

struct Outcome {
  int status = -1;
  std::string out, err;
};

std::string contents(const std::filesystem::path& path);

std::vector<std::string> lines(const std::string& text);

std::vector<std::string> split(const std::string& text, char separator = ',');

/// Must this be there? The page where the build asked for it (HAMEL_REPORT_PAGE=ON), all else in
/// CI.
bool must_have(const std::string& part);
/// Skips a test for want of a part of the build or of the machine; fails where it must be there.
#define HAMEL_SKIP_WITHOUT(part)                                                           \
  do {                                                                                     \
    if (hamel::test::must_have(part)) FAIL() << "no " << (part) << ": tools/setup --gate"; \
    GTEST_SKIP() << "no " << (part);                                                       \
  } while (false)

/// A file of the source tree.
std::string source_file(const std::string& path);

/// The data in the text of a page.
nlohmann::json page_data(const std::string& page);

/// The figure of that title on a page; null where there is none.
nlohmann::json figure_of(const nlohmann::json& page, const std::string& title);

/// A folder of its own for each test, gone afterwards.
class CommandLine : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  std::string file(const std::string& name) const;
  std::vector<std::string> files() const;

  /// Runs the program in its folder, where out and err go to files beside it. before: what the
  /// shell does first; behind: what the output goes through.
  Outcome run(const std::vector<std::string>& arguments, const std::string& before = "",
              const std::string& behind = "") const;
  /// What these arguments print with --json.
  nlohmann::json answer(std::vector<std::string> arguments, int status = 0) const;
  /// The record of `run` with these arguments.
  nlohmann::json record(std::vector<std::string> arguments, int status = 0) const;
  /// The data of the page that these arguments write to this file; null where the program was built
  /// without the page.
  nlohmann::json page_by(const std::vector<std::string>& arguments,
                         const std::string& name = "page.html") const;
  /// The same of `run` with these arguments.
  nlohmann::json page_of(std::vector<std::string> arguments) const;
  /// The names of the curves in a run's figures, by their titles; none without the page.
  std::map<std::string, std::vector<std::string>> curves(std::vector<std::string> arguments) const;
  /// The path of system.toml, or of another file, with this text.
  std::string write(const std::string& text) const;
  std::string write(const std::string& name, const std::string& text) const;
  /// `run` of a file with this text, system.toml, is bad input.
  void refused(const std::string& text, const std::string& message) const;
  /// The program at work in its folder, its output nowhere.
  pid_t started(const std::vector<std::string>& arguments) const;

 private:
  static std::string quoted(const std::string& text);
  std::string program_;
  std::filesystem::path folder_;
};

}  // namespace hamel::test
