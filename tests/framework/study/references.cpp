// References of a study: how they are found, kept in the journal, and stopped.
#include <atomic>
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/framework/batch/journal_file.hpp>
#include <hamel/framework/study/parts.hpp>

#include "studies.hpp"

namespace {

using namespace hamel;
using namespace hamel::test;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

StudyReference reference_of(const Registry& all, const StudyConfig& config) {
  const StudyCells cells = study_cells(config, all);
  return study::reference(
      all, config, config.systems[0], cells[0].config(), [](long) {}, nullptr);
}

/// Cells of more steps than a reference may have are compared with a coarser run of order 6.
TEST(StudyReferences, NeedNoFinerStepThanTheCells) {
  StudyConfig config = forgetful();
  config.until = 50;
  config.axes["step"] = {1e-4};
  const StudyReference reference = reference_of(with_forgetful(), config);
  EXPECT_THAT(reference.kind, HasSubstr("converged"));
  EXPECT_LT(reference.bound, 1e-9);
  EXPECT_EQ(reference.coordinates.size(), reference.times.size());
}

/// A motion too fast for every step: the reason is that of the runs, and there is no number.
TEST(StudyReferences, SayWhyThereIsNone) {
  StudyConfig config = forgetful();
  config.systems[0].start.velocity = {1e9, 1e9, 0};
  const StudyReference reference = reference_of(with_forgetful(), config);
  EXPECT_THAT(reference.kind, AllOf(HasSubstr("none: lift, s = 0.5, exp, kahan_li6 fails with"),
                                    HasSubstr(" steps: the "), Not(HasSubstr("nan"))));
  EXPECT_TRUE(std::isnan(reference.bound));
}

// A heavy asymmetric top: chaotic, and no step that a reference may have follows it for 200 s.
struct HeavyTop {
  using Group = SO3;
  static std::string name() { return "heavy_top"; }
  Mat<3, 3> inertia() const { return Vec<3>(1, 2, 2.6).asDiagonal(); }
  auto potential(const auto& g) const { return 6.0 * g(2, 0) + 3.0 * g(2, 1) + 4.0 * g(2, 2); }
  Start start() const { return {.configuration = {}, .velocity = {0.5, 1, 0.7}, .momentum = {}}; }
};

/// Two runs that differ by the size of the motion are no reference: no number is derived from them.
TEST(StudyReferences, ThatDoNotConvergeSaySo) {
  Registry all = registry();
  add_system<HeavyTop>(all);
  StudyConfig config;
  config.systems = {{"top", "heavy_top"}};
  config.until = 200;
  config.axes["step"] = {0.02, 0.01};
  const StudyReference reference = reference_of(all, config);
  EXPECT_THAT(reference.kind, AllOf(HasSubstr("not converged: lift"), HasSubstr("differs by")));
  EXPECT_TRUE(std::isnan(reference.bound));
  EXPECT_TRUE(reference.coordinates.empty());
}

/// They are computed by Newton, independently of on_failure of the cells.
TEST(StudyReferences, DoNotDependOnTheCells) {
  StudyConfig config = forgetful();
  config.axes["solver"] = {"hybrid"};
  config.axes["on_failure"] = {"retry:newton"};
  EXPECT_THAT(reference_of(with_forgetful(), config).kind, HasSubstr("converged"));
}

// Suslov's body with an exact motion that is lost after a second.
struct Lost : Forgetful {
  static std::string name() { return "lost"; }
  auto exact(const Mat<3, 3>& g0, const Vec<3>& xi0) const {
    return [g0, xi0](double t) { return std::pair{Mat<3, 3>(t > 1 ? g0 * NAN : g0), xi0}; };
  }
};

/// A motion that is not finite has no extent; the largest of its finite values would be misleading.
TEST(StudyReferences, DropNoNaN) {
  Registry all = registry();
  add_system<Lost>(all);
  StudyConfig config = forgetful();
  config.systems[0].name = "lost";
  EXPECT_TRUE(std::isnan(reference_of(all, config).extent));
  const StudyResult study = Study(all, config).run();
  EXPECT_TRUE(std::isnan(study.metrics[0].error));
}

/// Work on a reference is shown in the progress and ends when stopped.
TEST(StudyReferences, AreStoppedOnTheWay) {
  StudyConfig config = forgetful();
  config.until = 2000;
  std::atomic<bool> stop = false;
  const Registry all = with_forgetful();
  const StudyResult part = Study(all, config)
                               .threads(1)
                               .stop(&stop)
                               .progress([&](double fraction) {
                                 EXPECT_FALSE(stop) << "continues at " << fraction;
                                 EXPECT_LT(fraction, 0.1);
                                 if (fraction > 0) stop = true;
                               })
                               .run();
  EXPECT_FALSE(part.complete);
  EXPECT_TRUE(part.references[0].times.empty());
  EXPECT_FALSE(part.metrics[0].done);
}

/// A reference that is in the journal is not made again.
TEST(StudyReferences, AreKept) {
  const TemporaryFolder folder;
  const Registry all = with_forgetful();
  Study study(all, forgetful());
  const StudyResult first = study.folder(folder.path()).run();
  std::vector<std::string> journal;
  std::ifstream in(folder / "journal.jsonl");
  for (std::string line; std::getline(in, line);) {
    if (const size_t at = line.find("converged: lift"); at != std::string::npos) {
      line.replace(at, 15, "converged: kept");
      line = sealed(line.substr(0, line.rfind(",\"sum\"")) + "}");
    }
    journal.push_back(line);
  }
  std::ofstream out(folder / "journal.jsonl");
  for (const std::string& line : journal) out << line << '\n';
  out.close();
  const StudyResult again = study.run();
  EXPECT_THAT(again.references[0].kind, HasSubstr("converged: kept"));
  EXPECT_EQ(again.references[0].bound, first.references[0].bound);
  EXPECT_EQ(again.references[0].extent, first.references[0].extent);
  EXPECT_EQ(again.references[0].times, first.references[0].times);
  EXPECT_EQ(again.references[0].coordinates, first.references[0].coordinates);
  EXPECT_EQ(again.references[0].velocities, first.references[0].velocities);
  EXPECT_EQ(again.metrics[0].order, first.metrics[0].order);
}

/// Neither the number of threads nor which of the references is ready first changes anything.
TEST(StudyReferences, AreTheSameOnEveryNumberOfThreads) {
  StudyConfig config = forgetful();
  config.axes["retraction"] = {"exp", "cayley"};
  config.systems.push_back(kFull);
  config.systems.push_back(
      {.label = "slower", .name = "forgetful", .start = {.velocity = {0.3, 0, 0}}});
  const Registry all = with_forgetful();
  const StudyResult one = Study(all, config).threads(1).run();
  const StudyResult four = Study(all, config).threads(4).run();
  ASSERT_TRUE(one.complete && four.complete);
  for (size_t i = 0; i < one.references.size(); ++i) {
    EXPECT_EQ(one.references[i].kind, four.references[i].kind);
    EXPECT_EQ(one.references[i].coordinates, four.references[i].coordinates);
  }
  for (size_t i = 0; i < one.metrics.size(); ++i) {
    EXPECT_EQ(one.metrics[i].error, four.metrics[i].error);
    EXPECT_EQ(one.metrics[i].order, four.metrics[i].order);
    EXPECT_EQ(four.metrics[i].nanoseconds.size(), 1u);
  }
}

}  // namespace
