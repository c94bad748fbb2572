// hamel study in a folder of its own, and the cells that it wrote.
#pragma once

#include <signal.h>

#include <algorithm>
#include <fstream>
#include <sstream>
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
  pid_t started_study(const std::string& name, const std::string& folder) const {
    return started({"study", name, "-o", folder});
  }
  /// The rows of cells.csv without the columns that are times.
  std::vector<std::string> cells(const std::string& folder) const {
    std::vector<std::string> out;
    for (const std::string& line : lines(contents(file(folder + "/cells.csv"))))
      out.push_back(line.substr(0, line.rfind(',', line.rfind(',') - 1)));
    EXPECT_FALSE(out.empty());
    return out;
  }
  /// The texts of a column of cells.csv.
  std::vector<std::string> column(const std::string& folder, const std::string& name) const {
    const auto fields = [](const std::string& row) {
      std::vector<std::string> out;
      std::istringstream in(row);
      for (std::string field; std::getline(in, field, ',');) out.push_back(field);
      return out;
    };
    std::vector<std::string> out, rows = lines(contents(file(folder + "/cells.csv")));
    const std::vector<std::string> names = fields(rows.at(0));
    const auto place = static_cast<size_t>(std::ranges::find(names, name) - names.begin());
    for (size_t i = 1; i < rows.size(); ++i) out.push_back(fields(rows[i]).at(place));
    return out;
  }
  size_t count(const std::vector<std::string>& rows, const std::string& piece) const {
    return static_cast<size_t>(std::count_if(rows.begin(), rows.end(), [&](const auto& row) {
      return row.find(piece) != std::string::npos;
    }));
  }
};

}  // namespace hamel::test
