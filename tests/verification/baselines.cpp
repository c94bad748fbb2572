// The properties of the baselines (framework/README.md; (M25) to (M29)), each claim bounded from
// both sides: a baseline that behaves better than documented fails here as one that behaves worse.
// Errors are those of the motion, against the exact one or a converged reference; energy and rows
// are bounded beside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include <hamel/framework/schemes/rkmk4.hpp>
#include <hamel/hamel.hpp>

#include "without_dtau.hpp"

namespace hamel {
namespace {

/// value in [low, high].
void expect_within(double value, double low, double high, const std::string& what) {
  EXPECT_GE(value, low) << what;
  EXPECT_LE(value, high) << what;
}
/// The order that errors with steps h and h/2 show.
double order(double coarse, double fine) { return std::log2(coarse / fine); }

/// Suslov's body with full inertia: its exact motion contracts onto a steady rotation like e^{-A
/// t}, A^2 = q^2 + p^2 / det J (systems/suslov.hpp).
constexpr double kRate = 0.28802;
Simulation suslov(const std::string& scheme, double h, double until,
                  const Registry& among = registry()) {
  Simulation run(among, "suslov");
  run.set("inertia", {2, 0.3, 0.5, 3, 0.4, 4});
  run.start({.configuration = {}, .velocity = {1, 0.5, 0}, .momentum = {}});
  return run.scheme(scheme).step(h).until(until);
}

TEST(Suslov, ContractsAtTheRateUsedHere) {
  const Mat<2, 2> j{{2, 0.3}, {0.3, 3}};
  const Vec<2> k(0.5, 0.4), w(1, 0.5), turned(-0.5, 1);
  const double p = k.dot(w), q = k.dot(j.inverse() * turned);
  EXPECT_NEAR(std::sqrt(q * q + p * p / j.determinant()), kRate, 1e-5);
}

/// gni: the momentum across the constraint, of size O(h), is multiplied by -e^{A h} in a step; the
/// velocity at the nodes has its square. The error of lift with the same step does not grow.
TEST(Gni, IsEndedByAModeThatAlternatesAndGrows) {
  const double h = 0.0125;
  hamel::Run run = suslov("gni", h, 20).build();
  const auto flow = run.system().exact(run.config().start);
  std::vector<double> across, velocity_error;
  while (run.state().time < 16 - h / 2) {
    ASSERT_TRUE(run.step().ok);
    const Snapshot& now = run.state();
    across.push_back(now.constraint_rates.at(0));
    if (now.time < 12 - h / 2) continue;
    const std::vector<double> exact = flow(now.time).second;
    velocity_error.push_back(std::hypot(now.velocity[0] - exact[0], now.velocity[1] - exact[1],
                                        now.velocity[2] - exact[2]));
  }
  const size_t last = across.size() - 1, first = last - velocity_error.size() + 1;
  const double seconds = static_cast<double>(last - first) * h;
  for (size_t k = first; k < last; ++k) {
    ASSERT_LT(across[k] * across[k + 1], 0) << "no alternation at step " << k;
  }
  expect_within(std::log(std::abs(across[last] / across[first])) / seconds, 0.99 * kRate,
                1.01 * kRate, "growth of the momentum across the constraint");
  expect_within(std::log(velocity_error.back() / velocity_error.front()) / seconds, 1.9 * kRate,
                2.1 * kRate, "growth of the velocity's error");
}

TEST(Gni, HasOrderTwoUntilThen) {
  const Result coarse = suslov("gni", 0.05, 10).run(), fine = suslov("gni", 0.025, 10).run();
  expect_within(order(coarse.exact_error_final, fine.exact_error_final), 1.9, 2.1, "configuration");
  expect_within(coarse.exact_velocity_error_max, 1e-3, 2e-3, "velocity at t = 10");
  expect_within(order(coarse.constraint_max, fine.constraint_max), 0.9, 1.1,
                "its steps' row: O(h)");
  const Result lost = suslov("gni", 0.05, 40).run(), kept = suslov("lift", 0.05, 40).run();
  ASSERT_TRUE(lost.status.ok);
  expect_within(lost.exact_velocity_error_max, 1, 3, "gni at t = 40");
  expect_within(lost.exact_error_max, 1, 4, "gni's configuration at t = 40");
  expect_within(kept.exact_velocity_error_max, 1e-4, 5e-4, "lift at t = 40");
  expect_within(kept.exact_error_max, 0.01, 0.03, "lift's configuration at t = 40");
  expect_within(kept.energy_error_max, 4e-5, 2e-4, "lift's energy");
}

/// The mode starts with h, its square with h^2: half the step puts the end off by log(2)/A, 2.4 s,
/// whatever the step.
TEST(Gni, IsNotSavedBySmallerSteps) {
  const auto end = [](double h) {
    hamel::Run run = suslov("gni", h, 40).build();
    const auto flow = run.system().exact(run.config().start);
    while (run.step().ok && run.state().time < 40) {
      const Snapshot& now = run.state();
      if (std::abs(now.velocity[0] - flow(now.time).second[0]) > 0.05) break;
    }
    return run.state().time;
  };
  const double first = end(0.05), second = end(0.025), third = end(0.0125);
  EXPECT_LT(third, 30);
  const double delay = std::log(2) / kRate;
  expect_within(second - first, 0.8 * delay, 1.2 * delay, "0.05 -> 0.025");
  expect_within(third - second, 0.9 * delay, 1.1 * delay, "0.025 -> 0.0125");
}

TEST(EnergyPreserving, KeepsTheEnergyAndNothingElse) {
  const Result coarse = suslov("energy_preserving", 0.05, 40).run(),
               fine = suslov("energy_preserving", 0.025, 40).run(),
               lift = suslov("lift", 0.05, 40).run();
  EXPECT_LT(coarse.energy_error_max, 2e-12);
  EXPECT_GT(lift.energy_error_max, 1e6 * coarse.energy_error_max);
  expect_within(order(coarse.exact_error_max, fine.exact_error_max), 1.95, 2.05, "configuration");
  expect_within(order(coarse.exact_velocity_error_max, fine.exact_velocity_error_max), 1.95, 2.05,
                "velocity");
  expect_within(coarse.exact_error_max / lift.exact_error_max, 0.8, 1.25, "against lift's motion");
}

/// On a motion that settles in a steady rotation the explicit schemes have their full order, by the
/// correction with dL tau^-1.
TEST(RungeKutta, HasOrderFourAndTwoWithoutTheCorrection) {
  Registry mine = registry();
  add_scheme<verification::WithoutDtau<Rkmk4>>(mine);
  for (const std::string retraction : {"exp", "cayley"}) {
    for (const auto& [scheme, claim] :
         {std::pair{"rkmk4", 4.0}, {"rk4_projected", 4.0}, {"without_dtau", 2.0}}) {
      const Result coarse = suslov(scheme, 0.1, 10, mine).retraction(retraction).run(),
                   fine = suslov(scheme, 0.05, 10, mine).retraction(retraction).run();
      expect_within(order(coarse.exact_error_final, fine.exact_error_final), claim - 0.1,
                    claim + 0.1, scheme + (", " + retraction) + ": configuration");
    }
  }
}

Simulation disk(const std::string& scheme, double h, double until) {
  return simulate("falling_disk").scheme(scheme).step(h).until(until).every(5);
}

/// A disk that rolls and wobbles for ever, with constant energy and height of the contact: the
/// errors of lift and reversible are bounded by O(h^2), those of the explicit schemes drift. Their
/// error of order 4 averages out over such a reversible motion; the term that adds up is h^5 t
/// (framework/schemes/README.md, section 4).
TEST(FallingDisk, ExplicitSchemesDrift) {
  for (const std::string scheme : {"rkmk4", "rk4_projected"}) {
    const Result half = disk(scheme, 0.02, 80).run(), whole = disk(scheme, 0.02, 160).run(),
                 fine = disk(scheme, 0.01, 160).run();
    expect_within(whole.energy_error_max / half.energy_error_max, 1.8, 2.2,
                  scheme + ": energy in t");
    expect_within(order(whole.energy_error_max, fine.energy_error_max), 4.8, 5.2,
                  scheme + ": energy in h");
    expect_within(whole.holonomic_max / half.holonomic_max, 1.8, 2.2, scheme + ": height in t");
    expect_within(order(whole.holonomic_max, fine.holonomic_max), 4.8, 5.2,
                  scheme + ": height in h");
  }
}
TEST(FallingDisk, LiftAndReversibleDoNot) {
  for (const std::string scheme : {"lift", "reversible"}) {
    const Result early = disk(scheme, 0.02, 20).run(), late = disk(scheme, 0.02, 160).run(),
                 fine = disk(scheme, 0.01, 20).run();
    expect_within(late.energy_error_max / early.energy_error_max, 1, 1.02,
                  scheme + ": energy in t");
    expect_within(order(early.energy_error_max, fine.energy_error_max), 1.9, 2.1,
                  scheme + ": energy in h");
    if (scheme == "lift") {
      EXPECT_LT(late.holonomic_max, 1e-13);
      EXPECT_LT(late.constraint_max, 1e-12);
    } else {
      expect_within(late.holonomic_max / early.holonomic_max, 1, 1.02, "reversible: height in t");
      expect_within(order(early.holonomic_max, fine.holonomic_max), 1.9, 2.1,
                    "reversible: height in h");
      expect_within(order(early.constraint_max, fine.constraint_max), 1.9, 2.1,
                    "reversible: rows of the step in h");
    }
  }
}
TEST(FallingDisk, MotionsHaveTheirOrder) {
  const double until = 1;
  const Result exact = disk("lift", 0.005, until).compose("kahan_li6").run();
  const auto error = [&](const std::string& scheme, double h) {
    const Result r = disk(scheme, h, until).with(&Config::force_at, std::string("base")).run();
    double sum = 0;
    for (size_t i = 0; i < r.last.coordinates.size(); ++i) {
      sum += std::pow(r.last.coordinates[i] - exact.last.coordinates[i], 2);
    }
    return std::sqrt(sum);
  };
  const double lift = error("lift", 0.005);
  for (const auto& [scheme, claim, low, high] : {std::tuple{"lift", 2.0, 1.0, 1.0},
                                                 {"reversible", 2.0, 3.0, 5.0},
                                                 {"rkmk4", 4.0, 5e-5, 2e-4},
                                                 {"rk4_projected", 4.0, 5e-5, 2e-4}}) {
    const double coarse = error(scheme, 0.005), fine = error(scheme, 0.0025);
    expect_within(order(coarse, fine), claim - 0.1, claim + 0.1, scheme);
    expect_within(coarse / lift, low, high, scheme + std::string(": against lift"));
  }
}

}  // namespace
}  // namespace hamel
