// Full disks, damaged files, what a kill left, files that are gone: what becomes of a run that is
// recorded.
#include "recorded.hpp"

namespace {

using namespace hamel::test;
using testing::AllOf;
using testing::HasSubstr;

class RecordedFaults : public Recorded {};

/// A disk that is full from the start, or soon: a message, and what goes by the name of rows has
/// some.
TEST_F(RecordedFaults, NoRoomToBegin) {
  for (int blocks = 0; blocks < 40; ++blocks) {  // of 512 bytes
    for (const Words& outputs : {Words{"-o", "a.h5"}, Words{"-o", "b.csv", "-o", "a.h5"}}) {
      SCOPED_TRACE(blocks);
      const Outcome o = run(with({"run", "suslov", "--until", "1", "--quiet"}, outputs),
                            "(ulimit -f " + std::to_string(blocks) + " && exec ", "2>&1) | cat");
      EXPECT_THAT(o.out, AllOf(HasSubstr("cannot write"), HasSubstr("File too large"))) << o.out;
      EXPECT_FALSE(exists("a.h5.part.new"));
      EXPECT_EQ(exists("a.h5.part"), o.out.find("--continue a.h5") != std::string::npos) << o.out;
      for (const std::string& name : files()) std::filesystem::remove(file(name));
    }
  }
}

/// What a damaged file makes of a run is the undisturbed one or a refusal.
TEST_F(RecordedFaults, DamagedFiles) {
  const Words words = {"run", "chaplygin_sleigh", "--step", "0.01", "--until", "150", "--quiet"};
  ASSERT_EQ(run(with(words, {"-o", "whole.h5", "-o", "whole.csv"})).status, 0);
  ASSERT_EQ(run(with(words, {"-o", "cut.h5"}), "ulimit -f 3500 && exec ").status, 1);
  const std::string cut = contents(file("cut.h5.part")), whole = contents(file("whole.h5"));
  int went_on = 0;
  const auto expect = [&](const std::string& bytes) {
    std::ofstream(file("a.h5.part"), std::ios::binary) << bytes;
    const Outcome o = run({"run", "--continue", "a.h5", "--quiet", "-o", "a.csv"}, "timeout 30 ");
    if (o.status == 0) {
      ++went_on;
      EXPECT_TRUE(rows("a.csv") == rows("whole.csv"));
    } else {
      EXPECT_EQ(o.status, 2);
      EXPECT_THAT(o.err, HasSubstr("'a.h5.part': it is damaged"));
    }
    EXPECT_FALSE(exists("a.csv.part"));
    for (const char* name : {"a.h5", "a.csv", "a.h5.part"}) std::filesystem::remove(file(name));
  };
  for (const size_t part : {0, 1, 2, 4, 8, 12, 14, 15}) {  // of 16: truncated, a page of zeros
    SCOPED_TRACE(part);
    const size_t at = 5000 + (cut.size() - 5000) * part / 16;
    expect(cut.substr(0, at));
    expect(cut.substr(0, at) + std::string(4096, '\0') +
           cut.substr(std::min(cut.size(), at + 4096)));
  }
  EXPECT_GT(went_on, 6);
  // A finished one has no page.
  std::ofstream(file("a.h5"), std::ios::binary) << whole.substr(0, whole.size() / 2) +
                                                       std::string(4096, '\0') +
                                                       whole.substr(whole.size() / 2 + 4096);
  const Outcome o = run({"report", "a.h5", "-o", "a.html"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err,
              testing::AnyOf(HasSubstr("'a.h5': it is damaged"), HasSubstr("without the page")));
}

/// One changed byte of what a run resumes from, or of what its page is made of: refused, and
/// nothing is left.
TEST_F(RecordedFaults, TextsAreThoseWritten) {
  const Words sleigh = {"run", "chaplygin_sleigh", "--until", "150", "--set", "mass=61", "--quiet"};
  ASSERT_EQ(run(with(sleigh, {"-o", "whole.h5"})).status, 0);
  ASSERT_EQ(run(with(sleigh, {"-o", "cut.h5"}), "ulimit -f 3500 && exec ").status, 1);
  const std::string cut = contents(file("cut.h5.part")), whole = contents(file("whole.h5"));
  for (const char* name : {"whole.h5", "cut.h5.part"}) std::filesystem::remove(file(name));
  const auto changed = [](std::string bytes, const std::string& text) {
    const size_t at = bytes.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    bytes[at + text.size() - 1] ^= 1;
    return bytes;
  };
  const auto refused = [&](const Words& command, const std::string& name) {
    const Outcome o = run(command);
    if (o.err.find("without the page") != std::string::npos) return;
    EXPECT_EQ(o.status, 2) << o.out;
    EXPECT_THAT(o.err, HasSubstr("it is damaged"));
    EXPECT_THAT(files(), testing::ElementsAre(name));
  };
  // The configuration, the record before the first step, the unit of a column.
  for (const char* text : {"mass = [6", "until = 1", "\"until\": 1", "\"mass\": 6", "rad/s"}) {
    SCOPED_TRACE(text);
    std::ofstream(file("a.h5.part"), std::ios::binary) << changed(cut, text);
    refused({"run", "--continue", "a.h5", "--quiet", "-o", "a.csv", "-o", "a.csv.gz"}, "a.h5.part");
    std::filesystem::remove(file("a.h5.part"));
  }
  for (const char* text : {"mass = [6", "\"status\": \"o", "\"steps\": 1", "rad/s"}) {
    SCOPED_TRACE(text);
    std::ofstream(file("a.h5"), std::ios::binary) << changed(whole, text);
    refused({"report", "a.h5", "-o", "a.html"}, "a.h5");
    refused({"run", "--continue", "a.h5", "--quiet", "-o", "a.csv"}, "a.h5");
    std::filesystem::remove(file("a.h5"));
  }
}

/// What a --continue that was killed left beside the file goes with the next run of that name.
TEST_F(RecordedFaults, WhatAKillLeftIsReplaced) {
  const Words disk = {"run", "rolling_disk", "--until", "1e4", "--quiet", "-o", "a.h5"};
  ASSERT_EQ(run(disk, "ulimit -f 4000 && exec ").status, 1);
  for (const Words& words : {Words{"run", "--continue", "a.h5", "--quiet"}, disk}) {
    std::ofstream(file("a.h5.part.new")) << "the beginning of a file\n";
    EXPECT_EQ(run(words).status, 0);
    EXPECT_THAT(files(), testing::ElementsAre("a.h5"));
  }
  // One that could not begin takes its own along.
  ASSERT_EQ(run(disk, "ulimit -f 4000 && exec ").status, 1);
  EXPECT_EQ(run({"run", "--continue", "a.h5"}, "ulimit -f 2000 && exec ").status, 1);
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.h5", "a.h5.part"));
}

/// A page is of the run as it was, whatever became of the files that it was made of.
TEST_F(RecordedFaults, NeedsNoOtherFile) {
  const auto write_files = [&](const std::string& value, const std::string& friction) {
    std::ofstream(file("torque.csv")) << "# caf\xe9\nt,value\n0," << value << "\n20,0\n";
    std::string scooter = source_file("tests/examples/scooter_by_rows.toml");
    std::ofstream(file("scooter.toml")) << scooter << friction;
  };
  const auto page_of_file = [&](const std::string& name) {
    const Outcome o = run({"report", name, "-o", "page.html"});
    if (o.err.find("without the page") != std::string::npos) return nlohmann::json();
    EXPECT_EQ(o.status, 0) << o.err;
    nlohmann::json out = page_data(contents(file("page.html")));
    out.erase("generated");
    return out;
  };
  write_files("2", "");
  ASSERT_EQ(run({"run", "segway", "--input", "right_torque=torque.csv", "--until", "1", "--quiet",
                 "-o", "a.h5"})
                .status,
            0);
  ASSERT_EQ(run({"run", "scooter.toml", "--until", "1", "--quiet", "-o", "b.h5"}).status, 0);
  const nlohmann::json a = page_of_file("a.h5"), b = page_of_file("b.h5");
  write_files("-5", "\n# edited\n[no_such_table]\n");
  EXPECT_TRUE(page_of_file("a.h5") == a);
  EXPECT_TRUE(page_of_file("b.h5") == b);
  EXPECT_THAT(run({"run", "--continue", "b.h5"}).err, HasSubstr("is not what it was"));
  std::filesystem::remove(file("torque.csv"));
  std::filesystem::remove(file("scooter.toml"));
  EXPECT_TRUE(page_of_file("a.h5") == a);
  EXPECT_TRUE(page_of_file("b.h5") == b);
}

/// A page or a record for which there is no room: what was written before it is there, which is no
/// bad input.
TEST_F(RecordedFaults, NoRoomForTheLast) {
  for (const Words& last : {Words{"-o", "a.json"}, Words{"--report", "a.html", "-o", "a.csv"}}) {
    const Outcome o = run(with({"run", "suslov", "--until", "0.01", "--quiet"}, last),
                          "ulimit -f " + std::string(last[0] == "-o" ? "4" : "100") + " && exec ");
    if (o.err.find("without the page") != std::string::npos) continue;
    EXPECT_EQ(o.status, 1) << o.err;
    EXPECT_THAT(o.err, AllOf(HasSubstr("cannot write '" + last[1]), HasSubstr("File too large")));
    EXPECT_FALSE(exists(last[1]));
  }
}

}  // namespace
