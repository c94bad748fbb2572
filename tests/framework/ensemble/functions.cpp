// What is varied and kept by functions of the program.
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/hamel.hpp>

#include "../run/refusal.hpp"
#include "../temporary_folder.hpp"
#include "ensembles.hpp"

namespace {

using namespace hamel;
using namespace hamel::test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Law = Variation::Law;

double angle(long member) { return 0.1 * static_cast<double>(member) - 0.3; }

/// Functions and what they compute, as a list and a formula: the same bytes.
TEST(EnsembleFunctions, AreListsAndFormulas) {
  EnsembleConfig config = body();
  config.vary.clear();
  config.members = 20;
  EnsembleConfig listed = config;
  listed.vary = {{"start.omega1", Law::values, {}}, {"inertia3", Law::values, {}}};
  for (long k = 0; k < 20; ++k) {
    listed.vary[0].numbers.push_back(angle(k));
    listed.vary[1].numbers.push_back(0.5 + 0.01 * angle(k));
  }
  config.vary_by("start.omega1", angle);
  config.vary_by("inertia3", [](long member) { return 0.5 + 0.01 * angle(member); });
  const EnsembleResult whole = Ensemble(registry(), config).threads(2).run();
  EXPECT_THAT(whole.notes, IsEmpty());  // lanes are as before
  expect_same(whole, Ensemble(registry(), listed).threads(1).run());

  listed.keep.push_back({"sum", "end.omega1 + end.omega2"});
  config.keep_by("sum", [](hamel::Run& run) {
    const Snapshot& end = run.state();
    return end.velocity[0] + end.velocity[1];
  });
  const Ensemble kept(registry(), config);
  const EnsembleResult one = Ensemble(kept).threads(1).run(), two = Ensemble(kept).threads(2).run();
  expect_same(one, two);
  EXPECT_EQ(column(one, "sum"), column(Ensemble(registry(), listed).run(), "sum"));
  EXPECT_EQ(kept.member(7).kept.back().second, column(one, "sum")[7]);
  EXPECT_THAT(Ensemble(kept).lanes(false).run().notes, IsEmpty());
}

/// Where lanes are compiled for the system, a function of the run leaves them.
TEST(EnsembleFunctions, NoteThatLanesAreLeft) {
  EnsembleConfig config = body();
  config.keep_by("end", [](hamel::Run& run) { return run.time(); });
  const std::vector<std::string> notes = Ensemble(registry(), config).run().notes;
  if (registry().lanes("so3", *simulate("suslov").step(0.1).build().system().mechanics, "cayley",
                       "lift") == nullptr) {
    EXPECT_THAT(notes, IsEmpty());
  } else {
    EXPECT_THAT(notes, ElementsAre(HasSubstr("'end' is a function of their run")));
  }
}

TEST(EnsembleFunctions, OfAMemberMayFail) {
  EnsembleConfig config = body();
  config.members = 5;
  config.keep_by("odd", [](hamel::Run& run) {
    return run.state().velocity[0] > 1 ? std::numeric_limits<double>::quiet_NaN() : 1.0;
  });
  config.vary = {{"start.omega1", Law::values, {0.1, 0.2, 5, 0.3, 0.4}}};
  const EnsembleResult result = Ensemble(registry(), config).run();
  ASSERT_EQ(result.failures.size(), 1u);
  EXPECT_EQ(result.failures[0].member, 2);
  EXPECT_EQ(result.failures[0].reason, "'odd' is not a number");
  config.keep_by("thrown", [](hamel::Run&) -> double { throw std::runtime_error("too dark"); });
  const EnsembleResult none = Ensemble(registry(), config).run();
  ASSERT_EQ(none.failures.size(), 5u);
  EXPECT_EQ(none.failures[0].reason, "too dark");
}

TEST(EnsembleFunctions, AreCheckedBeforeAnythingRuns) {
  EnsembleConfig config = body();
  config.vary.pop_back();
  config.vary_by("start.omega2",
                 [](long member) { return 1 / (3.0 - static_cast<double>(member)); });
  EXPECT_THAT(refusal([&] { Ensemble(registry(), config); }),
              HasSubstr("vary.start.omega2: member 3 would have inf, expected a finite number"));
  config.vary.back().function = [](long member) -> double {
    throw std::runtime_error(member == 0 ? "too dark" : "later");
  };
  EXPECT_THAT(refusal([&] { Ensemble(registry(), config); }),
              HasSubstr("vary.start.omega2: of member 0: too dark"));
  config.vary.back().function = {};
  EXPECT_THAT(refusal([&] { Ensemble(registry(), config); }),
              HasSubstr("vary.start.omega2: expected a function of the member"));
  config.vary.pop_back();
  config.keep_by("", [](hamel::Run&) { return 1.0; });
  EXPECT_THAT(refusal([&] { Ensemble(registry(), config); }), HasSubstr("a function has no name"));
}

/// A journal has the name of a function.
TEST(EnsembleFunctions, AreResumedByName) {
  const TemporaryFolder folder;
  EnsembleConfig config = body();
  config.keep_by("end", [](hamel::Run& run) { return run.time(); });
  const auto whole = Ensemble(registry(), config).folder(folder.path()).run();
  const auto again = Ensemble(registry(), config).folder(folder.path()).run();
  EXPECT_EQ(again.resumed, 100u);
  expect_same(whole, again);
  config.keep.back().name = "other";
  EXPECT_THAT(refusal([&] { Ensemble(registry(), config).folder(folder.path()).run(); }),
              HasSubstr("here:  keep other = a function of the run"));
}

}  // namespace
