// The engine of many runs alone: squares of numbers, each after the square of the number before.
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/framework/batch/engine.hpp>
#include <hamel/framework/io/errors.hpp>

#include "../temporary_folder.hpp"

namespace {

using namespace hamel;
using hamel::test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct Squares : BatchResult {
  std::vector<long> values;  // 0: not there
  long sum = 0;
};

class SquaresEngine : public Engine {
 public:
  SquaresEngine(const BatchSettings& settings, size_t count, Squares& result)
      : Engine(settings, result), part_(settings.shard), result_(result) {
    result.values.resize(count);
  }
  size_t throws_at = kNone;

 private:
  long all() const { return static_cast<long>(result_.values.size()); }
  JournalSubject subject() const override { return {"test", "squares", {std::to_string(all())}}; }
  void take(const std::string& line) override {
    const auto at = static_cast<size_t>(std::stol(line.substr(line.find(':') + 1)));
    result_.values.at(at) = static_cast<long>((at + 1) * (at + 1));
  }
  std::string lacks(const Shard& part) const override {
    for (long i = first_piece(part, all()); i < behind(part, all()); ++i)
      if (result_.values[static_cast<size_t>(i)] == 0) return "number " + std::to_string(i);
    return "";
  }
  Pieces pieces() const override {
    Pieces out;
    for (long i = first_piece(part_, all()); i < behind(part_, all()); ++i) {
      const auto at = static_cast<size_t>(i);
      out.all += 2;
      if (result_.values[at] != 0) ++out.resumed;
      else out.left.push_back({at, 2, out.left.empty() ? kNone : out.left.size() - 1});
    }
    return out;
  }
  Worker worker() override {
    return [this](size_t number, const Counted& counted) {
      if (number == throws_at) throw std::runtime_error("no square");
      counted(1);
      counted(100);  // more than its share
      if (stopped()) return false;
      keep([&] { return "{\"at\":" + std::to_string(number) + "}"; });
      if (number > 0 && part_.count == 1) {
        EXPECT_NE(result_.values[number - 1], 0) << number;
      }
      result_.values[number] = static_cast<long>((number + 1) * (number + 1));
      return true;
    };
  }
  void finish() override {
    for (const long x : result_.values) result_.sum += x;
  }

  Shard part_;
  Squares& result_;
};

Squares squares(const BatchSettings& settings, size_t count = 4) {
  Squares out;
  SquaresEngine(settings, count, out).run();
  return out;
}

TEST(Engine, TakesPiecesInTheirOrder) {
  for (const int threads : {1, 2, 5}) {
    std::vector<double> fractions;
    const Squares out =
        squares({.threads = threads, .progress = [&](double x) { fractions.push_back(x); }});
    EXPECT_THAT(out.values, ElementsAre(1, 4, 9, 16));
    EXPECT_TRUE(out.complete);
    EXPECT_EQ(out.sum, 30);
    EXPECT_EQ(out.threads, threads);
    EXPECT_EQ(fractions.front(), 0);
    EXPECT_EQ(fractions.back(), 1);
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
  }
  EXPECT_TRUE(squares({}, 0).complete);
}

/// Whatever throws, no thread waits for a piece that does not come.
TEST(Engine, ThrowsWhatAPieceHasThrown) {
  for (const int threads : {1, 3}) {
    Squares out;
    const BatchSettings settings{.threads = threads};
    SquaresEngine engine(settings, 4, out);
    engine.throws_at = 2;
    EXPECT_THAT([&] { engine.run(); }, ThrowsMessage<std::runtime_error>(HasSubstr("no square")));
    EXPECT_THAT(out.values, ElementsAre(1, 4, 0, 0));
  }
}

TEST(Engine, StopsAndResumes) {
  const TemporaryFolder folder;
  std::atomic<bool> stop = false;
  BatchSettings settings{.threads = 2, .folder = folder.path(), .stop = &stop};
  settings.progress = [&](double fraction) { stop = fraction > 0.5; };
  const Squares part = squares(settings);
  EXPECT_FALSE(part.complete);
  EXPECT_EQ(part.resumed, 0u);
  stop = false;
  settings.progress = {};
  std::ofstream(folder / "journal.jsonl", std::ios::app) << "{\"at\":3,\"sum\":\"0\"}\n{\"a";
  const Squares rest = squares(settings);
  EXPECT_TRUE(rest.complete);
  EXPECT_EQ(rest.resumed, 2u);
  EXPECT_EQ(rest.sum, 30);
  EXPECT_THAT(rest.notes, ElementsAre(HasSubstr("journal.jsonl:4: damaged (its checksum)")));
  EXPECT_EQ(squares(settings).resumed, 4u);
  EXPECT_THAT([&] { squares(settings, 5); },
              ThrowsMessage<ConfigError>(HasSubstr("holds the squares of another test")));
  settings.fresh = true;
  EXPECT_EQ(squares(settings, 5).resumed, 0u);
}

TEST(Engine, JoinsShards) {
  const TemporaryFolder folder;
  BatchSettings settings{.folder = folder.path()};
  const auto merged = [&] {
    Squares out;
    const BatchSettings whole{.folder = folder.path()};
    SquaresEngine(whole, 7, out).merge();
    return out;
  };
  EXPECT_THAT(merged, ThrowsMessage<MissingParts>(HasSubstr("has no shards")));
  for (const long i : {3L, 1L}) {
    settings.shard = {i, 3};
    EXPECT_TRUE(squares(settings, 7).complete);
  }
  EXPECT_THAT(merged, ThrowsMessage<MissingParts>(HasSubstr("shard 2/3 is missing")));
  settings.shard = {2, 3};
  std::atomic<bool> stop = true;
  settings.stop = &stop;
  EXPECT_FALSE(squares(settings, 7).complete);
  EXPECT_THAT(merged, ThrowsMessage<MissingParts>(HasSubstr("shard 2/3 is incomplete: number 2")));
  stop = false;
  squares(settings, 7);
  const Squares whole = merged();
  EXPECT_THAT(whole.values, ElementsAre(1, 4, 9, 16, 25, 36, 49));
  EXPECT_EQ(whole.sum, 140);
  EXPECT_EQ(whole.shards, 3);
  EXPECT_TRUE(whole.complete);
  settings.folder.clear();
  EXPECT_THAT([&] { squares(settings, 7); },
              ThrowsMessage<ConfigError>(HasSubstr("needs a folder")));
}

}  // namespace
