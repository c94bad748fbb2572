// Fits: closed standard deviations, parameters back from motions without noise, directions that the
// data do not see, mistakes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <hamel/framework/inverse/fit.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/hamel.hpp>

namespace {

using hamel::Fit;
using hamel::FitRequest;
using hamel::Recording;
using testing::HasSubstr;

/// Columns of a run at times dt apart.
Recording recorded(const hamel::Simulation& simulation, const std::vector<std::string>& columns,
                   double dt, double until) {
  const hamel::Result result = hamel::Simulation(simulation).output(dt).until(until).run();
  EXPECT_TRUE(result.status.ok) << result.status.reason;
  Recording out;
  out.name = "recorded";
  out.columns = columns;
  const auto column = [&](const std::string& name) { return result.trajectory.column(name); };
  out.t = column("t");
  for (const std::string& name : columns) out.values.push_back(column(name));
  return out;
}

hamel::Simulation sleigh() {
  return hamel::simulate("chaplygin_sleigh")
      .set("mass", 1)
      .set("inertia", 1)
      .set("offset", 0.2)
      .start({.velocity = {1, 1, 0}})
      .tolerance({.relative = 1e-11});
}

/// The covariance at the exact data is that of the closed sensitivities.
TEST(Fit, OfTheSleighHasTheClosedDeviations) {
  FitRequest request;
  request.names = {{"offset"}, {"start.v1"}, {"start.omega"}};
  request.sigma = {{"omega", 0.01}, {"v1", 0.01}};
  request.recordings.push_back(recorded(sleigh(), {"omega", "v1"}, 0.05, 4));
  ASSERT_EQ(request.recordings[0].t.size(), 81u);
  const Fit fit = hamel::fit(sleigh(), request);
  ASSERT_TRUE(fit) << fit.reason;
  EXPECT_NEAR(fit.parameters[0].sigma, 1.18783e-3, 0.5e-8);
  EXPECT_NEAR(fit.parameters[1].sigma, 2.1315e-3, 0.5e-7);
  EXPECT_NEAR(fit.parameters[2].sigma, 1.98467e-3, 0.5e-8);
  EXPECT_EQ(fit.dof, 2 * 81 - 3);
  EXPECT_NEAR(std::sqrt(fit.covariance(0, 0)), fit.parameters[0].sigma, 1e-15);
}

struct BackCase {
  hamel::Simulation simulation;  // with the numbers
  std::vector<hamel::FitName> names;
  std::vector<double> truth;
  std::vector<std::string> columns;
  double until;
};

/// Without noise the numbers come back, from guesses that are off by 5 %.
TEST(Fit, FindsTheNumbersOfAMotion) {
  using hamel::simulate;
  const std::vector<BackCase> cases = {
      {sleigh(), {{"offset"}, {"start.v1"}, {"start.omega"}}, {0.2, 1, 1}, {"omega", "v1"}, 4},
      {simulate("snakeboard"),
       {{"rotor_inertia"}, {"half_length"}},
       {0.12, 0.2},
       {"x", "y", "theta"},
       2},
      {simulate("falling_disk"),
       {{"radius"}, {"start.omega3"}},
       {0.5, 5},
       {"omega1", "omega2", "omega3"},
       1},
      {simulate("bicycle").speed(3),
       {{"rider_mass"}, {"trail"}},
       {85, 0.08},
       {"w1", "w3", "steer.angle"},
       1.5}};
  for (const BackCase& one : cases) {
    SCOPED_TRACE(one.simulation.config().system);
    hamel::Simulation simulation = one.simulation;
    simulation.tolerance({.relative = 1e-12});
    FitRequest request;
    request.recordings.push_back(recorded(simulation, one.columns, one.until / 40, one.until));
    request.names = one.names;
    for (size_t i = 0; i < request.names.size(); ++i) request.names[i].guess = 1.05 * one.truth[i];
    const Fit fit = hamel::fit(simulation, request);
    ASSERT_TRUE(fit) << fit.reason;
    for (size_t i = 0; i < one.truth.size(); ++i)
      EXPECT_NEAR(fit.parameters[i].value, one.truth[i], 1e-10 * std::abs(one.truth[i]))
          << request.names[i].name;
  }
}

struct FreeBody {
  using Group = hamel::SO3;
  double i1 = 1, i2 = 2, i3 = 2.5;  // kg m^2
  auto inertia() const { return hamel::Mat<3, 3>(hamel::Vec<3>(i1, i2, i3).asDiagonal()); }
  auto constraints() const { return hamel::Mat<0, 3>(); }
  void fields(auto& f) {
    f("i1", i1, "kg m^2");
    f("i2", i2, "kg m^2");
    f("i3", i3, "kg m^2");
  }
};

/// omega' is a ratio of moments: their common scale is not in the data.
TEST(Fit, NamesTheScaleOfTheMomentsOfAFreeBody) {
  const hamel::Simulation simulation =
      hamel::simulate(FreeBody{}).start({.velocity = {0.3, 1, 0.2}}).tolerance({.relative = 1e-11});
  FitRequest request;
  request.recordings.push_back(recorded(simulation, {"omega1", "omega2", "omega3"}, 0.1, 6));
  request.names = {{"i1"}, {"i2"}, {"i3"}};
  request.sigma = {{"omega1", 0.01}, {"omega2", 0.01}, {"omega3", 0.01}};
  const Fit fit = hamel::fit(simulation, request);
  EXPECT_TRUE(fit.converged);
  EXPECT_FALSE(fit);
  ASSERT_EQ(fit.undetermined.size(), 1u);
  for (const char* name : {"i1", "i2", "i3"})
    EXPECT_NEAR(fit.undetermined[0].at(name), 1 / std::sqrt(3.0), 1e-6) << name;
  for (const hamel::FittedNumber& one : fit.parameters) EXPECT_FALSE(std::isfinite(one.sigma));
  request.names = {{"i1"}, {"i2"}};  // with one of them known
  const Fit known = hamel::fit(simulation, request);
  EXPECT_TRUE(known) << known.reason;
}

/// Missing cells, a marker by a formula, two recordings with starts of their own, bounds.
TEST(Fit, TakesGapsMarkersAndSeveralRecordings) {
  const hamel::Simulation other =
      sleigh().start({.configuration = {0.4, 0, 0}, .velocity = {-0.6, 1.5, 0}});
  FitRequest request;
  request.observe = {{"tip", "x + 0.5*cos(theta) + 0*offset"}};
  for (const hamel::Simulation& one : {sleigh(), other}) {
    const Recording full = recorded(one, {"omega", "x", "theta"}, 0.1, 3);
    Recording data = full;
    data.columns = {"omega", "tip"};
    data.values.resize(2);
    for (size_t i = 0; i < full.t.size(); ++i) {
      data.values[1][i] = full.values[1][i] + 0.5 * std::cos(full.values[2][i]);
      if (i % 3 == 1) data.values[0][i] = std::numeric_limits<double>::quiet_NaN();
    }
    request.recordings.push_back(data);
  }
  request.names = {
      {"offset", 0.3, 0.05, 1}, {"start.v1", 1.2}, {"start.omega", 0.7}, {"start.theta", 0.1}};
  const Fit fit = hamel::fit(sleigh(), request);
  ASSERT_TRUE(fit) << fit.reason;
  const std::map<std::string, double> truth = {
      {"offset", 0.2},     {"start.v1", 1},         {"start.omega", 1},    {"start.theta", 0},
      {"start.v1@2", 1.5}, {"start.omega@2", -0.6}, {"start.theta@2", 0.4}};
  ASSERT_EQ(fit.parameters.size(), truth.size());
  for (const hamel::FittedNumber& one : fit.parameters)
    EXPECT_NEAR(one.value, truth.at(one.name), 1e-9) << one.name;
  EXPECT_EQ(fit.residuals.size(), 2u);
  // Outside of its bounds the number stays at one of them.
  request.names[0] = {"offset", 0.3, 0.25, 1};
  const Fit bounded = hamel::fit(sleigh(), request);
  EXPECT_NEAR(bounded.parameters[0].value, 0.25, 1e-6);
  EXPECT_TRUE(bounded.parameters[0].at_bound);
}

/// Outliers move a fit by least squares, and hardly one with the loss of Huber.
TEST(Fit, WithTheLossOfHuberForgetsOutliers) {
  FitRequest request;
  request.names = {{"offset"}, {"start.v1"}, {"start.omega"}};
  request.sigma = {{"omega", 0.01}, {"v1", 0.01}};
  request.recordings.push_back(recorded(sleigh(), {"omega", "v1"}, 0.05, 4));
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 0.01);
  for (auto& column : request.recordings[0].values)
    for (size_t i = 0; i < column.size(); ++i) column[i] += normal(random) + (i % 10 == 3 ? 1 : 0);
  const Fit squares = hamel::fit(sleigh(), request);
  request.huber = 1.5;
  const Fit robust = hamel::fit(sleigh(), request);
  ASSERT_TRUE(robust) << robust.reason;
  EXPECT_GT(std::abs(squares.parameters[0].value - 0.2), 0.02);
  EXPECT_LT(std::abs(robust.parameters[0].value - 0.2), 0.005);
}

/// Of the equations of Lorenz in a file.
hamel::Simulation lorenz() {
  const char* root = std::getenv("HAMEL_SOURCE");
  EXPECT_NE(root, nullptr) << "set HAMEL_SOURCE to the source tree (ctest does)";
  return hamel::simulate(std::string(root == nullptr ? "." : root) +
                         "/tools/studies/lorenz_system.toml")
      .start({.velocity = {-8, 8, 27}})
      .tolerance({.relative = 1e-11});
}

/// A displacement grows by e^4: over the whole recording from guesses that are off by 5 %
/// there is no way to the numbers, over segments they come back without noise.
TEST(Fit, OfAChaoticMotionTakesSegments) {
  FitRequest request;
  request.recordings.push_back(recorded(lorenz(), {"X", "Y", "Z"}, 0.1, 5));
  request.names = {{"sigma", 10.5}, {"rho", 27}, {"beta", 2.8}, {"start.X", -8.4}};
  request.iterations = 30;
  const Fit fit = hamel::fit(lorenz(), request);
  ASSERT_TRUE(fit) << fit.reason;
  EXPECT_GT(fit.segments[0], 1);
  const std::vector<double> truth = {10, 28, 8 / 3.0, -8};
  for (size_t i = 0; i < truth.size(); ++i)
    EXPECT_NEAR(fit.parameters[i].value, truth[i], 1e-10 * std::abs(truth[i]))
        << request.names[i].name;
  request.segments = 1;
  request.iterations = 8;
  const Fit single = hamel::fit(lorenz(), request);
  EXPECT_FALSE(single && std::abs(single.parameters[1].value - 28) < 1e-3);
}

/// Segments change neither the numbers nor their deviations: a noisy recording of the sleigh.
TEST(Fit, OfSegmentsIsThatOfOne) {
  FitRequest request;
  request.names = {{"offset", 0.25}, {"start.v1", 0.9}, {"start.omega"}};
  request.sigma = {{"omega", 0.01}, {"v1", 0.01}};
  request.recordings.push_back(recorded(sleigh(), {"omega", "v1"}, 0.05, 4));
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, 0.01);
  for (auto& column : request.recordings[0].values)
    for (double& x : column) x += normal(random);
  const Fit one = hamel::fit(sleigh(), request);
  ASSERT_TRUE(one) << one.reason;
  EXPECT_EQ(one.segments, std::vector<int>{1});
  request.segments = 5;
  const Fit five = hamel::fit(sleigh(), request);
  ASSERT_TRUE(five) << five.reason;
  EXPECT_EQ(five.segments, std::vector<int>{5});
  EXPECT_NEAR(five.chi2, one.chi2, 1e-8 * one.chi2);
  EXPECT_EQ(five.dof, one.dof);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(five.parameters[i].value, one.parameters[i].value, 1e-8);
    EXPECT_NEAR(five.parameters[i].sigma, one.parameters[i].sigma, 1e-7 * one.parameters[i].sigma);
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(five.covariance(i, j), one.covariance(i, j), 1e-12) << i << j;
}

/// A sleigh whose lengths are numbers of a smaller unit, `per_metre` of it.
hamel::Simulation sleigh_in(double per_metre) {
  return hamel::simulate("chaplygin_sleigh")
      .set("mass", 1)
      .set("inertia", per_metre * per_metre)
      .set("offset", 0.2 * per_metre)
      .start({.velocity = {1, per_metre, 0}})
      .tolerance({.relative = 1e-11});
}

/// Nothing depends on the unit of lengths: metres, millimetres, micrometres.
TEST(Fit, OverSegmentsIsTheSameInEveryUnitOfLength) {
  const auto fitted = [](double per_metre) {
    FitRequest request;
    request.names = {{"offset", 0.25 * per_metre}, {"start.v1", 0.9 * per_metre}, {"start.omega"}};
    request.sigma = {{"omega", 0.01}, {"v1", 0.01 * per_metre}, {"x", 0.01 * per_metre}};
    request.segments = 5;
    request.recordings.push_back(recorded(sleigh_in(per_metre), {"omega", "v1", "x"}, 0.05, 4));
    std::mt19937 random(2);
    std::normal_distribution<double> normal(0, 0.01);
    for (auto& column : request.recordings[0].values) {
      const double unit = &column == &request.recordings[0].values[0] ? 1 : per_metre;
      for (double& x : column) x += unit * normal(random);
    }
    return hamel::fit(sleigh_in(per_metre), request);
  };
  const Fit metres = fitted(1);
  ASSERT_TRUE(metres) << metres.reason;
  for (const double per_metre : {1e3, 1e6}) {
    SCOPED_TRACE(per_metre);
    const Fit fit = fitted(per_metre);
    ASSERT_TRUE(fit) << fit.reason;
    EXPECT_EQ(fit.iterations, metres.iterations);
    EXPECT_NEAR(fit.chi2, metres.chi2, 1e-9 * metres.chi2);
    EXPECT_NEAR(fit.parameters[0].value, per_metre * metres.parameters[0].value, 1e-9 * per_metre);
    EXPECT_NEAR(fit.parameters[2].value, metres.parameters[2].value, 1e-9);
  }
}

/// The fitted run repeats the fitted motion.
TEST(Fit, GivesARun) {
  FitRequest request;
  request.names = {{"offset", 0.25}, {"start.omega", 0.9}};
  request.recordings.push_back(recorded(sleigh(), {"omega", "v1"}, 0.1, 3));
  const Fit fit = hamel::fit(sleigh(), request);
  ASSERT_TRUE(fit) << fit.reason;
  const hamel::Config again = hamel::Config::from_toml(fit.run.to_toml());
  hamel::Run run = hamel::simulate("chaplygin_sleigh").config(again).build();
  ASSERT_TRUE(run.advance_to(3).ok);
  EXPECT_NEAR(run.state().velocity[0], request.recordings[0].values[0].back(), 1e-8);
}

TEST(Fit, RefusesMistakes) {
  const auto mistake = [](const FitRequest& request) -> std::string {
    try {
      hamel::fit(sleigh(), request);
      return "";
    } catch (const hamel::ConfigError& error) {
      return error.what();
    }
  };
  const Recording good = {"x.csv", {"omega"}, {0, 1, 2}, {{1, 1, 1}}, {2, 3, 4}};
  EXPECT_THAT(mistake({.names = {{"ofset"}}, .recordings = {good}}),
              HasSubstr("did you mean 'offset'?"));
  Recording bad = good;
  bad.columns = {"omga"};
  EXPECT_THAT(mistake({.names = {{"offset"}}, .recordings = {bad}}),
              HasSubstr("x.csv: column 2: unknown quantity 'omga'"));
  bad = good;
  bad.t[0] = -1;
  EXPECT_THAT(mistake({.names = {{"offset"}}, .recordings = {bad}}),
              HasSubstr("x.csv:2: column t: got -1, before the start of the run at 0"));
  EXPECT_THAT(mistake({.names = {{"offset"}}, .recordings = {good}, .sigma = {{"omeg", 1}}}),
              HasSubstr("sigma: unknown column of the data 'omeg'"));
  EXPECT_THAT(mistake({.names = {{"offset", 2, 0, 1}}, .recordings = {good}}),
              HasSubstr("got 2:0:1, expected guess:low:high"));
  EXPECT_THAT(mistake({.names = {{"mass", -1}}, .recordings = {good}}), HasSubstr("mass"));
  EXPECT_THAT(mistake({.names = {{"start.v2", 0.5}}, .recordings = {good}}),
              HasSubstr("leave no choice"));
  EXPECT_THAT(mistake({.names = {{"offset"}}, .recordings = {good}, .observe = {{"a", "x"}}}),
              HasSubstr("observe: unknown column of the data 'a'"));

  EXPECT_THAT(mistake({.names = {{"offset"}}, .recordings = {good}, .segments = 4}),
              HasSubstr("segments: got 4, expected a whole number from 1 to 3"));
  try {  // a stop would end it before the data do
    hamel::fit(sleigh().stop_at({"start"}), {.names = {{"offset"}}, .recordings = {good}});
    ADD_FAILURE() << "a stop is refused";
  } catch (const hamel::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("leave stop_at out"));
  }

  const auto text = [](const char* csv) -> std::string {
    try {
      hamel::parse_recording(csv, "d.csv");
      return "";
    } catch (const hamel::ConfigError& error) {
      return error.what();
    }
  };
  EXPECT_THAT(text("omega\n1\n"), HasSubstr("d.csv:1: expected a column t"));
  EXPECT_THAT(text("t,omega\n0,1\n0.1,x1\n"),
              HasSubstr("d.csv:3: column 2 (omega): got 'x1', expected a finite number"));
  EXPECT_THAT(text("t,omega\n0,1\n0,2\n"),
              HasSubstr("d.csv:3: column 1 (t): got 0, expected more"));
  EXPECT_THAT(text("t,omega\n0\n"), HasSubstr("d.csv:2: got 1 cells, expected 2"));
  EXPECT_THAT(text("t,omega\n"), HasSubstr("there is no row"));
  EXPECT_EQ(text("# of a tracker\nt, omega\n0,\n1,2\n"), "");
}

}  // namespace
