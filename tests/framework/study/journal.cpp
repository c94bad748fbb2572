// A journal is read as it is found: damaged lines are left out with a note, and their work is done
// again.
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/batch/journal_file.hpp>

#include "studies.hpp"

namespace {

using namespace hamel;
using namespace hamel::test;
using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;

class StudyJournal : public testing::Test {
 protected:
  StudyJournal() {
    config_ = small();
    config_.axes["solver"] = {"newton", "hybrid"};
    whole_ = Study(registry(), config_).threads(1).folder(folder_.path()).run();
    std::ifstream in(journal());
    for (std::string line; std::getline(in, line);) lines_.push_back(line);
  }
  std::string journal() const { return folder_ / "journal.jsonl"; }
  /// Goes on from these lines.
  StudyResult resumed(const std::vector<std::string>& lines) {
    std::ofstream out(journal());
    for (const std::string& line : lines) out << line << '\n';
    out.close();
    return Study(registry(), config_).threads(1).folder(folder_.path()).run();
  }
  void expect_equal(const StudyResult& other) const {
    ASSERT_TRUE(other.complete);
    for (size_t i = 0; i < whole_.metrics.size(); ++i) {
      EXPECT_EQ(other.metrics[i].error, whole_.metrics[i].error);
      EXPECT_EQ(other.metrics[i].final, whole_.metrics[i].final);
      EXPECT_EQ(other.metrics[i].order, whole_.metrics[i].order);
      EXPECT_EQ(other.metrics[i].energy_slope, whole_.metrics[i].energy_slope);
    }
  }

  TemporaryFolder folder_;
  StudyConfig config_;
  StudyResult whole_;
  std::vector<std::string> lines_;
};

/// Each line in turn cut short, with one digit changed, or replaced by noise.
TEST_F(StudyJournal, DamagedLinesAreComputedAgain) {
  ASSERT_GE(lines_.size(), 1u + 1 + 6 + 6);
  for (size_t i = 1; i < lines_.size(); ++i) {
    std::vector<std::string> lines = lines_;
    std::string& line = lines[i];
    if (i % 3 == 0) line.resize(line.size() / 2);
    else if (i % 3 == 1) line = "\xff\x00[[[{";
    else line[line.find_first_of("0123456789", line.size() / 2)] ^= 1;
    const StudyResult result = resumed(lines);
    EXPECT_THAT(result.notes,
                ElementsAre(HasSubstr("journal.jsonl:" + std::to_string(i + 1) + ": damaged")));
    EXPECT_LE(result.resumed, 6u);
    expect_equal(result);
  }
  EXPECT_THAT(resumed(lines_).notes, testing::IsEmpty());
}

/// Lengths and indices are checked too, under a checksum that is right: they end up in loops over
/// other lists.
TEST_F(StudyJournal, LengthsAndIndicesAreChecked) {
  const auto with = [&](size_t i, auto change) {
    std::vector<std::string> lines = lines_;
    Json line = Json::parse(lines[i]);
    line.erase("sum");
    change(line);
    lines[i] = sealed(line.dump());
    const StudyResult result = resumed(lines);
    EXPECT_EQ(result.notes.size(), 1u) << lines[i];
    expect_equal(result);
  };
  size_t reference = 0, cell = 0, timing = 0;
  for (size_t i = 1; i < lines_.size(); ++i) {
    const Json line = Json::parse(lines_[i]);
    (line.contains("reference") ? reference : line.contains("round") ? timing : cell) = i;
  }
  with(cell, [](Json& line) { line["final"].clear(); });
  with(cell, [](Json& line) { line["final"].push_back(1); });
  with(cell, [](Json& line) { line["cell"] = 1000; });
  with(cell, [](Json& line) { line["cell"] = -1; });
  with(cell, [](Json& line) { line["steps"] = 1e300; });
  with(cell, [](Json& line) { line["error"] = "small"; });
  with(cell, [](Json& line) { line.erase("error"); });
  with(reference, [](Json& line) { line["reference"] = 7; });
  with(reference, [](Json& line) { line["times"].erase(0); });
  with(reference, [](Json& line) { line["coordinates"].erase(0); });
  with(reference, [](Json& line) { line["coordinates"][3].erase(0); });
  with(reference, [](Json& line) { line["velocities"][3].push_back(0); });
  with(timing, [](Json& line) { line["round"] = 1; });
}

/// Without its first line the study of the cells is unknown: refused, not thrown away.
TEST_F(StudyJournal, ADamagedFirstLineIsRefused) {
  for (const std::string& first : {lines_[0].substr(0, 40), std::string("{\"journal\":[}"),
                                   std::string("{\"journal\":1,\"study\":7,\"version\":[]}")}) {
    std::vector<std::string> lines = lines_;
    lines[0] = first;
    EXPECT_THAT([&] { resumed(lines); },
                testing::ThrowsMessage<ConfigError>(HasSubstr("--fresh forgets them")));
    std::ifstream in(journal());
    std::stringstream text;
    text << in.rdbuf();
    EXPECT_THAT(text.str(), HasSubstr(lines_.back()));
  }
}

/// A study killed while it wrote the first line begins anew.
TEST_F(StudyJournal, ATornFirstLineBeginsAnew) {
  std::ofstream(journal()) << lines_[0].substr(0, 40);
  const StudyResult result = Study(registry(), config_).folder(folder_.path()).run();
  EXPECT_EQ(result.resumed, 0u);
  expect_equal(result);
}

}  // namespace
