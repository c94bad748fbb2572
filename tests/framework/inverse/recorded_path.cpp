// Recorded formulas of a state: values and both derivatives against differences along the group.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/inverse/recorded_path.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/run/data/event_formula.hpp>
#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/tangent/step_differences.hpp>
#include <hamel/framework/tangent/step_map.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

class PathOf {
 public:
  PathOf(const std::string& system, const std::string& retraction,
         const std::vector<std::string>& texts)
      : run_(simulate(system).scheme("lift").retraction(retraction).step(0.01).until(1).build()),
        map_(std::shared_ptr<const RunPlan>(std::shared_ptr<void>(), &run_.driver().plan())) {
    const SystemModel& model = *map_.plan().system;
    const QuantityNames names(model);
    const StateVariables variables(model, names.variables());
    std::vector<RecordedNumber> recorded;
    for (const std::string& text : texts) {
      const Expression formula(names.in_formula(text), variables.names());
      values_.push_back(variables.value(formula));
      recorded.push_back(variables.recorded(formula));
    }
    path = RecordedPath::of(map_.plan(), recorded);
    state_ = map_.start();
    state_.time = 0.3;
  }
  std::unique_ptr<RecordedPath> path;

  void expect_derivatives() {
    ASSERT_NE(path, nullptr);
    const Eigen::Index n = map_.velocities();
    Eigen::VectorXd direction(2 * n + 1), weights(static_cast<Eigen::Index>(values_.size()));
    for (Eigen::Index i = 0; i < direction.size(); ++i)
      direction[i] = std::sin(12.9898 * static_cast<double>(i + 1));
    for (Eigen::Index i = 0; i < weights.size(); ++i)
      weights[i] = std::cos(3.1 * static_cast<double>(i));
    // Along g tau(e eta).
    const auto moved = [&](double e, Eigen::VectorXd& out) {
      MotionState there;
      displace(map_.geometry(), state_, direction.head(2 * n), e, there);
      const std::vector<double> g = map_.coordinates(there);
      out.resize(weights.size());
      for (size_t i = 0; i < values_.size(); ++i)
        out[static_cast<Eigen::Index>(i)] =
            values_[i](state_.time + e * direction[2 * n], g, {there.xi.data(), g_size(n)});
      return true;
    };
    Eigen::VectorXd here, expected, forth, back;
    ASSERT_TRUE(moved(0, here));
    ASSERT_TRUE(
        path->evaluate(state_.time, map_.coordinates(state_), {state_.xi.data(), g_size(n)}));
    EXPECT_LT((path->values() - here).lpNorm<Eigen::Infinity>(), 1e-13);
    ASSERT_TRUE(ThreeDifferences::derivative(ThreeDifferences::fine, 0x1p-6, moved, expected));
    EXPECT_LT((path->slopes() * direction - expected).lpNorm<Eigen::Infinity>(), 1e-10);
    const auto curvature = [&](double e) {
      moved(e, forth);
      moved(-e, back);
      return weights.dot(forth - 2 * here + back) / (e * e);
    };
    constexpr double e = 0x1p-6;
    const double second = (4 * curvature(e / 2) - curvature(e)) / 3;
    const Eigen::MatrixXd& h = path->hessian(weights);
    EXPECT_EQ(h, h.transpose());
    EXPECT_NEAR(direction.dot(h * direction), second, 1e-6);
  }

 private:
  static size_t g_size(Eigen::Index n) { return static_cast<size_t>(n); }
  Run run_;
  StepMap map_;
  std::vector<StateVariables::Value> values_;
  MotionState state_;
};

TEST(RecordedPath, HasTheDerivativesOfItsFormulas) {
  for (const char* retraction : {"exp", "cayley"}) {
    SCOPED_TRACE(retraction);
    PathOf("chaplygin_sleigh", retraction,
           {"(x - 0.3)^2 + y*sin(theta)", "omega^2*x + t*v1", "cos(theta + t)*omega*v1"})
        .expect_derivatives();
    PathOf("suslov", retraction, {"R11*R23 + omega1*R31", "exp(R12) + t^2"}).expect_derivatives();
    PathOf("rolling_disk", retraction, {"x*y + roll^2", "theta*omega"}).expect_derivatives();
  }
}

/// Where rows turn with the place, xi follows it: no formula of the velocity is taken.
TEST(RecordedPath, TakesVelocitiesWhereNothingTurns) {
  EXPECT_NE(PathOf("nonholonomic_particle", "exp", {"x1 + x2*x3"}).path, nullptr);
  EXPECT_EQ(PathOf("nonholonomic_particle", "exp", {"x1 + x2*x1'"}).path, nullptr);
}

}  // namespace
}  // namespace hamel
