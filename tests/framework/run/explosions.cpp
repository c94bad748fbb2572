// Motions that leave what the numbers can hold: a run ends with a Status, never with an exception,
// and the good rows are in its files, under their final names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>

#include <hamel/simulate.hpp>

#include "../study/studies.hpp"

namespace {

using namespace hamel;
using testing::HasSubstr;

/// An angle grows past 1e9 rad, which no element is read from: that step fails.
TEST(Explosions, AnAngleBeyondTheElements) {
  const test::TemporaryFolder folder;
  for (const std::string group : {"so2", "so2^2", "r1*so2"}) {
    const int n = group == "so2" ? 1 : 2;
    std::string inertia = "1", velocity = group == "r1*so2" ? "0, 1e7" : "1e7";
    for (int i = 1; i < n; ++i) inertia += ", 1";
    while (std::count(velocity.begin(), velocity.end(), ',') < n - 1) velocity += ", 0";
    const std::string system = folder / "spin.toml";
    std::ofstream(system) << "group = \"" << group << "\"\ninertia = [" << inertia
                          << "]\nvelocity = [" << velocity << "]\n";
    for (Simulation made : {simulate(system).scheme("lift").step(0.1),
                            simulate(system).scheme("dop853").tolerance({1e-6}).output(0.5),
                            simulate(system).scheme("dop853").tolerance({1e-6})}) {
      const std::string file = folder / "x.csv";
      const Result result = made.until(1000).record_to(file).keep_rows(100000).run();
      EXPECT_FALSE(result.status.ok) << group;
      EXPECT_THAT(result.status.reason, HasSubstr("expected an angle in radians below 1e9"));
      EXPECT_GT(result.last.time, 50) << group;
      EXPECT_LT(result.last.time, 101) << group;
      EXPECT_GT(result.trajectory.rows(), 10u) << group;
      EXPECT_TRUE(std::filesystem::exists(file)) << group;
      EXPECT_FALSE(std::filesystem::exists(file + ".part")) << group;
      for (size_t i = 0; i < result.trajectory.rows(); ++i)
        for (const double x : result.trajectory.row(i)) EXPECT_TRUE(std::isfinite(x)) << group;
      std::filesystem::remove(file);
    }
  }
}

/// Systems at random whose forces grow without limit or lose their value on the way, by every
/// family of schemes and every kind of output.
TEST(Explosions, EndWithAStatus) {
  std::mt19937 random(34);
  const auto one_of = [&](const std::vector<std::string>& all) {
    return all[random() % all.size()];
  };
  const test::TemporaryFolder folder;
  struct Kind {
    std::string group;
    int dim;
    std::vector<std::string> quantities;
  };
  const std::vector<Kind> kinds = {{"r1", 1, {"x1", "xi1"}},
                                   {"so2", 1, {"theta", "omega"}},
                                   {"se2", 3, {"theta", "x", "y", "omega", "v1", "v2"}},
                                   {"so3", 3, {"R11", "R23", "omega1", "omega2", "omega3"}},
                                   {"se3", 6, {"R11", "x", "z", "omega1", "v1", "v3"}},
                                   {"so2*r1", 2, {"xi1", "xi2", "t"}}};
  const std::vector<std::string> forms = {"Q^3",         "1e4*Q",       "exp(Q)",    "exp(exp(Q))",
                                          "1/(Q - 1.5)", "sqrt(2 - Q)", "1e150*Q^2", "log(3 - Q)",
                                          "1e6",         "tan(Q)",      "Q^99",      "-1e6*Q^3"};
  const std::vector<std::string> schemes = {"lift",  "balance",       "gni",    "reversible",
                                            "rkmk4", "rk4_projected", "dopri5", "dop853",
                                            "tsit5", "dop853"};
  int failed = 0, ended = 0;
  for (int k = 0; k < 400; ++k) {
    const Kind& kind = kinds[random() % kinds.size()];
    std::string inertia, velocity, force;
    for (int i = 0; i < kind.dim; ++i) {
      std::string term = one_of(forms);
      const std::string name = one_of(kind.quantities);
      for (size_t at = term.find('Q'); at != term.npos; at = term.find('Q', at + name.size()))
        term.replace(at, 1, name);
      inertia += i == 0 ? "1" : ", 1.5";
      velocity += i == 0 ? "1" : ", 0.5";
      force += (i == 0 ? "\"" : ", \"") + term + "\"";
    }
    const std::string system = folder / "system.toml", file = folder / "x.csv";
    const std::string text = "group = \"" + kind.group + "\"\ninertia = [" + inertia +
                             "]\nvelocity = [" + velocity + "]\nforce = [" + force + "]\n";
    std::ofstream(system) << text;
    const std::string scheme = one_of(schemes);
    Simulation made = simulate(system).scheme(scheme).until(50).keep_rows(100000).record_to(file);
    if (scheme.starts_with("dop") || scheme == "tsit5") made.tolerance({1e-6});
    else made.step(0.05);
    if (random() % 3 == 0) made.output(0.1);
    if (random() % 3 == 0) made.events({one_of(kind.quantities) + "=2"});
    std::optional<hamel::Run> run;
    try {
      run.emplace(made.build());
    } catch (const ConfigError&) {
      continue;  // no value at the start
    }
    SCOPED_TRACE(scheme + "\n" + text);
    EXPECT_NO_THROW({
      Status status;
      for (int step = 0; step < 400 && status.ok && run->time() < 50; ++step)
        status = run->step_towards(50);
      const Result result = run->finish();
      failed += result.status.ok ? 0 : 1;
      ++ended;
      for (size_t i = 0; i < result.trajectory.rows(); ++i)
        EXPECT_TRUE(std::isfinite(result.trajectory.at(i, 1)));
      (void)result.report();
      (void)result.record();
    });
    EXPECT_TRUE(std::filesystem::exists(file));
    EXPECT_FALSE(std::filesystem::exists(file + ".part"));
    std::filesystem::remove(file);
  }
  EXPECT_GT(failed, 50);
  EXPECT_GT(ended, 200);
}

}  // namespace
