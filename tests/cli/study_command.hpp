// hamel study in a folder of its own, and the cells that it wrote.
#pragma once

#include <fcntl.h>
#include <signal.h>

#include <algorithm>
#include <string>
#include <vector>

#include "program.hpp"

namespace hamel::test {

class StudyCommand : public CommandLine {
 protected:
  std::string study(const std::string& text, const std::string& name = "small.toml") const {
    std::ofstream(file(name)) << text;
    return name;
  }
  /// The program at work on a study, its output nowhere.
  pid_t started(const std::string& name, const std::string& folder) const {
    const pid_t child = fork();
    EXPECT_GE(child, 0);
    if (child != 0) return child;
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDERR_FILENO);
    dup2(nowhere, STDOUT_FILENO);
    if (chdir(file("").c_str()) == 0)
      execl(std::getenv("HAMEL_PROGRAM"), "hamel", "study", name.c_str(), "-o", folder.c_str(),
            nullptr);
    _exit(127);
  }
  /// The rows of cells.csv without the columns that are times.
  std::vector<std::string> cells(const std::string& folder) const {
    std::vector<std::string> out;
    for (const std::string& line : lines(contents(file(folder + "/cells.csv"))))
      out.push_back(line.substr(0, line.rfind(',', line.rfind(',') - 1)));
    EXPECT_FALSE(out.empty());
    return out;
  }
  size_t count(const std::vector<std::string>& rows, const std::string& piece) const {
    return static_cast<size_t>(std::count_if(rows.begin(), rows.end(), [&](const auto& row) {
      return row.find(piece) != std::string::npos;
    }));
  }
};

}  // namespace hamel::test
