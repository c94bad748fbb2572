// Runs that are recorded as they go: what is left of one that was ended, and what it becomes.
#pragma once

#include <signal.h>

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace hamel::test {

using Words = std::vector<std::string>;

inline Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class Recorded : public CommandLine {
 protected:
  /// The rows of a CSV, and its first line.
  std::vector<std::string> rows(const std::string& name) const {
    return rows_of(contents(file(name)));
  }
  static std::vector<std::string> rows_of(const std::string& text) {
    std::vector<std::string> out = lines(text);
    std::erase_if(out, [](const std::string& line) { return line.starts_with('#'); });
    return out;
  }
  /// The record of a run without what differs from run to run.
  nlohmann::json record(const std::string& name) const {
    nlohmann::json out = nlohmann::json::parse(contents(file(name)));
    out.erase("timing");
    return out;
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(file(name)); }
};

}  // namespace hamel::test
