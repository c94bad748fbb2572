// Every registered system that is not left-invariant (and a few that are), with every scheme that
// is defined for it: the measured order is the claimed one, against the exact motion or, where
// there is none, against lift of order 6 with a step ten times smaller; holonomic rows stay at
// round-off; the constraint residual stays at its floor.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include <hamel/hamel.hpp>

#include "../framework/schemes/dynamic_problem.hpp"
#include "cases.hpp"

namespace hamel {
namespace {

constexpr double kUntil = 0.8;

Simulation run_of(const std::string& system, const std::string& scheme, double s,
                  const std::string& retraction, long steps) {
  Simulation out = simulate(system);
  out.scheme(scheme).s(s).retraction(retraction).step(kUntil / static_cast<double>(steps));
  return out.until(kUntil).every(steps);
}

std::vector<double> end_of(const Result& result) {
  std::vector<double> out = result.last.coordinates;
  out.insert(out.end(), result.last.velocity.begin(), result.last.velocity.end());
  return out;
}

std::vector<std::string> general_systems() {
  std::vector<std::string> out;
  for (const std::string& name : registry().systems()) {
    const SystemModel model = registry().system(name)->make({});
    const bool there =
        model.mechanics->left_invariant() && model.exact && verification::has_motion(name);
    if (!there) out.push_back(name);  // else scheme_laws.cpp holds it to more
  }
  return out;
}

class GeneralOrders : public testing::TestWithParam<std::string> {};

TEST_P(GeneralOrders, AreAsClaimed) {
  const std::string& system = GetParam();
  const Result reference = run_of(system, "lift", 0.5, "exp", 3200).compose("kahan_li6").run();
  ASSERT_TRUE(reference.status.ok) << reference.status.reason;
  const std::vector<double> end = end_of(reference);
  // Motions with no symmetry that would raise the order.
  const bool generic =
      std::set<std::string>{"falling_disk", "ball_on_turntable", "snakeboard", "segway"}.contains(
          system);
  for (const std::string& scheme : registry().schemes()) {
    const SchemeInfo& info = *registry().scheme(scheme);
    const bool left_invariant = reference.system->mechanics->left_invariant();
    if (!info.adapted || !info.defined(left_invariant)) continue;
    for (const std::string retraction : {"exp", "cayley"}) {
      // Where s is not used, one that would show if it were.
      for (const double s :
           info.uses_s ? std::vector<double>{0, 0.5, 1} : std::vector<double>{0.25}) {
        const ClaimedOrder claim = info.claim(s, true, left_invariant);  // exp, cayley: symmetric
        if (claim.order == 0) continue;                                  // approximates nothing
        // First-order errors show their order late.
        const long coarse = claim.order == 1 ? 800 : claim.order == 2 ? 160 : 24;
        const Result a = run_of(system, scheme, s, retraction, coarse).run();
        const Result b = run_of(system, scheme, s, retraction, 2 * coarse).run();
        const std::string what =
            system + ", " + scheme + ", " + retraction + ", s = " + std::to_string(s);
        ASSERT_TRUE(a.status.ok) << what << ": " << a.status.reason;
        ASSERT_TRUE(b.status.ok) << what << ": " << b.status.reason;
        const double coarse_error = euclidean_distance(end_of(a), end),
                     fine_error = euclidean_distance(end_of(b), end);
        const double order = std::log2(coarse_error / fine_error);
        if (fine_error > 1e-10) {  // else exact up to round-off: nothing to measure
          const double bound = claim.order == 1   ? 0.1
                               : claim.order == 2 ? 0.05
                               : claim.order == 4 ? 0.2
                                                  : 0.6;
          EXPECT_GT(order, claim.order - bound)
              << what << ", errors " << coarse_error << ", " << fine_error;
          // No better either, so that s is seen to be used.
          if (generic && (scheme == "lift" || scheme == "balance")) {
            EXPECT_LT(order, claim.order + bound)
                << what << ", errors " << coarse_error << ", " << fine_error;
          }
        }
        if (info.steps_admissible) {
          EXPECT_LT(b.constraint_max, 1e-11) << what;
        }
        if (info.steps_admissible && !std::isnan(b.holonomic_max)) {
          EXPECT_LT(b.holonomic_max, 1e-13) << what;
        }
        EXPECT_LT(b.group_defect_max, 1e-14) << what;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Systems, GeneralOrders, testing::ValuesIn(general_systems()),
                         [](const auto& it) { return it.param; });

/// A user's suite (check/scheme_laws.hpp) sees a wrong claim: lift at s = 0 and 1 is of order 1 on
/// systems that are not left-invariant, not of order 2, and does not return. At s = 1/2 all holds.
TEST(SchemeSuite, SeesAWrongClaim) {
  Registry boastful = registry();
  SchemeInfo info = *boastful.scheme("lift");
  info.claims = [](double, TauTraits, bool) { return ClaimedOrder{2, true}; };
  boastful.add(info);
  int orders = 0, returns = 0, held = 0;
  for (const LawResult& law : check_scheme(boastful, "lift")) {
    const bool half = law.law.find("s = 1/2") != std::string::npos;
    if (half && law.law.find("second_kind") == std::string::npos) {
      EXPECT_TRUE(law.passed()) << law;
    }
    held += law.passed() ? 1 : 0;
    if (law.passed()) continue;
    if (law.law.starts_with("order at least 2: ")) ++orders;
    if (law.law.starts_with("a run with h and one with -h")) ++returns;
  }
  EXPECT_GT(orders, 10);
  EXPECT_GT(returns, 10);
  EXPECT_GT(held, 200);
}

TEST(SchemeSuite, HoldsTheLibrarysOwn) {
  for (const std::string scheme : {"lift", "rkmk4", "unadapted"}) {
    for (const LawResult& law : check_scheme(registry(), scheme)) {
      EXPECT_TRUE(law.passed()) << scheme << ": " << law;
    }
  }
  EXPECT_THROW(check_scheme(registry(), "lft"), ConfigError);
}

/// On a left-invariant system the general schemes are the compiled ones.
TEST(GeneralSchemes, AreTheCompiledOnesOnLeftInvariantSystems) {
  Registry general = registry();
  for (const std::string system : {"suslov", "chaplygin_sleigh", "rolling_disk"}) {
    const SystemInfo& info = *registry().system(system);
    SystemInfo erased = info;
    erased.make = [make = info.make](const Parameters& given) { return test::erased(make(given)); };
    general.add(erased);
    for (const std::string scheme : {"lift", "balance"}) {
      for (const std::string retraction : {"exp", "cayley", "second_kind"}) {
        for (const double s : {0.0, 0.3, 0.5, 1.0}) {
          Config config;
          config.system = system;
          config.scheme = scheme;
          config.retraction = retraction;
          config.s = s;
          config.step = 0.05;
          config.until = 3;
          if (system == std::string("suslov")) {
            config.parameters["inertia"] = {2, .3, .5, 3, .4, 4};
            config.start.velocity = {1, 0.5, 0};
          }
          const Result fast = Simulation(registry(), system).config(config).run();
          const Result slow = Simulation(general, system).config(config).run();
          EXPECT_LT(euclidean_distance(end_of(fast), end_of(slow)), 1e-11)
              << system << ", " << scheme << ", " << retraction << ", s = " << s;
        }
      }
    }
  }
}

TEST(GeneralSchemes, RefuseAStartOffTheHolonomicConstraint) {
  Start start;
  start.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0.3};
  start.velocity = {0, 0, 1, 0, 0, 0};
  try {
    simulate("falling_disk").start(start).run();
    FAIL() << "a disk that hovers was accepted";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("holonomic"), std::string::npos) << error.what();
  }
}

TEST(GeneralSchemes, SayWhatIsNotDefined) {
  try {
    simulate("falling_disk").scheme("boxed").run();
    FAIL() << "boxed ran on a disk";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("left-invariant"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace hamel
