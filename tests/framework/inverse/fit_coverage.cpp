// Intervals of fits: of 1000 recordings with noise, 95 % of the intervals hold the truth.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <hamel/framework/inverse/fit.hpp>
#include <hamel/hamel.hpp>

namespace {

constexpr int kRecordings = 1000;
constexpr double kSigma = 0.01, kNormal95 = 1.959964;

/// A sleigh, 81 samples of both velocities: sd of the share is 0.69 %.
TEST(FitCoverage, OfTheSleighIsThatOfItsDeviations) {
  const hamel::Simulation sleigh = hamel::simulate("chaplygin_sleigh")
                                       .set("mass", 1)
                                       .set("inertia", 1)
                                       .set("offset", 0.2)
                                       .start({.velocity = {1, 1, 0}})
                                       .tolerance({.relative = 1e-9});
  const hamel::Result exact = hamel::Simulation(sleigh).output(0.05).until(4).run();
  ASSERT_TRUE(exact.status.ok);
  hamel::FitRequest request;
  request.names = {{"offset"}, {"start.v1"}, {"start.omega"}};
  request.sigma = {{"omega", kSigma}, {"v1", kSigma}};
  hamel::Recording data;
  data.name = "recorded";
  data.columns = {"omega", "v1"};
  const auto column = [&](const std::string& name) { return exact.trajectory.column(name); };
  data.t = column("t");
  const std::vector<std::vector<double>> truth = {column("omega"), column("v1")};
  const std::vector<double> numbers = {0.2, 1, 1};
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, kSigma);
  std::vector<int> held(numbers.size(), 0);
  double chi2 = 0;
  long dof = 0;
  for (int i = 0; i < kRecordings; ++i) {
    data.values = truth;
    for (std::vector<double>& values : data.values)
      for (double& x : values) x += noise(random);
    request.recordings = {data};
    const hamel::Fit fit = hamel::fit(sleigh, request);
    ASSERT_TRUE(fit) << fit.reason;
    for (size_t k = 0; k < numbers.size(); ++k)
      held[k] +=
          std::abs(fit.parameters[k].value - numbers[k]) <= kNormal95 * fit.parameters[k].sigma;
    chi2 += fit.chi2;
    dof = fit.dof;
  }
  for (const int count : held) EXPECT_NEAR(count / double{kRecordings}, 0.95, 0.014);
  EXPECT_NEAR(chi2 / kRecordings / static_cast<double>(dof), 1, 0.015);
}

}  // namespace
