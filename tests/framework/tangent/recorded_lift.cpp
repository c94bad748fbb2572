// The recorded equation of a lift step: its derivatives against differences of the step's map, for
// every formula that a system by data may state, on all groups that are recorded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/tangent/recorded_lift.hpp>
#include <hamel/framework/tangent/step_differences.hpp>
#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

struct Case {
  std::string name, text;
  int dim;
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

const Case kCases[] = {{"sleigh", R"toml(
group = "se2"
inertia = [1.3, 1, 1]
constraints = [[0, 0, 1]]
force = ["torque", "force - 0.1*v1", 0]
[inputs]
torque = {}
force = {}
)toml",
                        3},
                       {"potential_and_inertia", R"toml(
group = "se2*so2"
coordinates = ["theta", "x", "y", "psi"]
inertia = [["2 + cos(psi)", 0, 0, 0.1], [0, 1, 0, 0], [0, 0, "1 + x^2", 0], [0.1, 0, 0, 0.5]]
constraints = [["0.2*cos(psi)", "-sin(psi)", "cos(psi)", 0]]
potential = "sin(theta)*x + 0.3*y^2 + theta*psi"
force = ["push - 0.1*omega*v1", 0, 0, "cos(t)*push"]
[inputs]
push = {}
)toml",
                        4},
                       {"rotations", R"toml(
group = "so3*r2"
coordinates = ["R11", "R12", "R13", "R21", "R22", "R23", "R31", "R32", "R33", "x", "y"]
inertia = [2, 3, 4, 1, 1]
constraints = [[0, "R33", "-R32", 1, 0], [0, 0, "R31", 0, 1]]
drift = ["0.3*sin(t)*R11", "x*push"]
potential = "R33 + x*y"
[inputs]
push = {}
)toml",
                        5},
                       {"disk", R"toml(
group = "se3"
inertia = [0.0625, 0.0625, 0.125, 1, 1, 1]
constraints = [[0, 0, "-rho", "-R32/sqrt(R31^2 + R32^2)", "R31/sqrt(R31^2 + R32^2)", 0],
  ["-rho*R32", "rho*R31", 0,
   "-R33*R31/sqrt(R31^2 + R32^2)", "-R33*R32/sqrt(R31^2 + R32^2)", "sqrt(R31^2 + R32^2)"]]
holonomic = ["z - rho*sqrt(R31^2 + R32^2)"]
potential = "9.81*z"
force = ["push", 0, 0, 0, 0, 0]
[parameters]
rho = 0.5
[inputs]
push = {}
)toml",
                        6}};

class RecordedLiftOf : public testing::TestWithParam<std::tuple<Case, std::string, double>> {
 protected:
  RecordedLiftOf() : run_(simulation().build()) {
    map_ = std::make_unique<StepMap>(
        std::shared_ptr<const RunPlan>(std::shared_ptr<void>(), &run_.driver().plan()),
        all_inputs());
    equation_ = RecordedLift::of(map_->plan(), RecordedLift::Order::second);
    state_ = map_->start();
    if (std::get<0>(GetParam()).name != "disk") {
      for (Eigen::Index i = 0; i < state_.xi.size(); ++i)
        state_.xi[i] = std::sin(1.7 * static_cast<double>(i) + 0.4);
      map_->project(state_);
    }
    n_ = map_->velocities();
    inputs_ = map_->plan().setup.inputs->at(0);
    direction_.resize(map_->increments() + inputs_.size() + 2);
    for (Eigen::Index i = 0; i < direction_.size(); ++i)
      direction_[i] = std::sin(12.9898 * static_cast<double>(i + 1));
    direction_[direction_.size() - 2] *= kStep;
    if (map_->plan().system->mechanics->holonomic_rows() > 0)  // along phi = 0
      direction_.head(n_) = map_->basis(state_) * direction_.segment(n_, map_->increments() - n_);
  }
  static constexpr double kStep = 0.05;

  /// q of the equation along the direction (eta, dy, u, h, t).
  Eigen::VectorXd parameters() {
    Eigen::VectorXd out(equation_->parameters());
    const Eigen::Index m = map_->increments() - n_;
    out << direction_.head(n_), map_->basis(state_) * direction_.segment(n_, m),
        direction_.tail(inputs_.size() + 2);
    return out;
  }
  /// The step at a distance along the direction, from the increments that keep the rows.
  bool step(double e, MotionState& end) {
    MotionState from = state_, moved;
    const Eigen::Index q = direction_.size();
    from.time += e * direction_[q - 1];
    map_->retract(from, e * direction_.head(map_->increments()), moved);
    map_->project(moved);
    map_->set_inputs(inputs_ + e * direction_.segment(map_->increments(), inputs_.size()));
    return map_->step(moved, moved.time + kStep + e * direction_[q - 2], end).ok;
  }

  hamel::Run run_;
  std::unique_ptr<StepMap> map_;
  std::unique_ptr<RecordedLift> equation_;
  MotionState state_;
  Eigen::VectorXd inputs_, direction_;
  Eigen::Index n_ = 0;

 private:
  static std::vector<std::size_t> all_inputs() {
    return std::get<0>(GetParam()).name == "sleigh" ? std::vector<std::size_t>{0, 1}
                                                    : std::vector<std::size_t>{0};
  }
  static Simulation simulation() {
    const auto& [one, retraction, s] = GetParam();
    Simulation out(registry(), "data",
                   OwnSystem{data_system_maker(registry(), one.name + ".toml", one.text)});
    out.scheme("lift").retraction(retraction).s(s).step(kStep).until(1);
    if (one.name == "sleigh") out.input("torque", 0.4).input("force", -0.7);
    else out.input("push", 0.3);
    if (one.name == "disk") out.start(FallingDisk{}.rolling(1, {0.1, 0.4, 2.5}));
    else out.start({.velocity = std::vector<double>(static_cast<size_t>(one.dim), 0.0)});
    return out;
  }
};

/// The end, its first derivatives and the guard against a step of another branch.
TEST_P(RecordedLiftOf, HasTheDerivativesOfTheStep) {
  ASSERT_NE(equation_, nullptr);
  MotionState end;
  ASSERT_TRUE(step(0, end));
  RecordedLift::Unknowns x;
  ASSERT_TRUE(equation_->solve(state_, inputs_, kStep, x));
  MotionState found_end;
  Eigen::VectorXd apart;
  ASSERT_TRUE(equation_->end(found_end));
  ASSERT_TRUE(displacement(map_->geometry(), end, found_end, apart));
  EXPECT_LT(apart.lpNorm<Eigen::Infinity>(), 1e-12);
  ASSERT_TRUE(equation_->linearise(map_->coordinates(end)));
  const Eigen::VectorXd found = equation_->jacobian() * parameters();
  Eigen::VectorXd expected;
  const auto moved = [&](double e, Eigen::VectorXd& by) {
    MotionState there;
    return step(e, there) && displacement(map_->geometry(), end, there, by);
  };
  ASSERT_TRUE(ThreeDifferences::derivative(ThreeDifferences::fine, 0x1p-7, moved, expected));
  EXPECT_LT((found - expected).lpNorm<Eigen::Infinity>(),
            2e-9 * (1 + expected.lpNorm<Eigen::Infinity>()));
}

/// d^T H d against differences of the first derivatives; symmetric.
TEST_P(RecordedLiftOf, HasItsSecondDerivatives) {
  ASSERT_NE(equation_, nullptr);
  MotionState end;
  ASSERT_TRUE(step(0, end));
  const std::vector<double> reference = map_->coordinates(end);
  const Eigen::VectorXd along = parameters();
  Eigen::VectorXd lambda(2 * n_);
  for (Eigen::Index i = 0; i < lambda.size(); ++i)
    lambda[i] = std::cos(3.1 * static_cast<double>(i));
  RecordedLift::Unknowns x;
  const auto slope = [&](double e, Eigen::VectorXd& out) {
    MotionState there;
    displace(map_->geometry(), state_, along.head(2 * n_), e, there);
    there.time = state_.time + e * along[along.size() - 1];
    const Eigen::VectorXd u = inputs_ + e * along.segment(2 * n_, inputs_.size());
    if (!equation_->solve(there, u, kStep + e * along[along.size() - 2], x) ||
        !equation_->linearise(reference))
      return false;
    out.resize(1);
    out[0] = lambda.dot(equation_->jacobian() * along);
    return true;
  };
  Eigen::VectorXd expected;
  ASSERT_TRUE(ThreeDifferences::derivative(ThreeDifferences::fine, 0x1p-7, slope, expected));
  Eigen::VectorXd here;
  ASSERT_TRUE(slope(0, here));
  const Eigen::MatrixXd h = equation_->hessian(lambda);
  EXPECT_LT((h - h.transpose()).lpNorm<Eigen::Infinity>(), 1e-12 * h.lpNorm<Eigen::Infinity>());
  EXPECT_NEAR(along.dot(h * along), expected[0], 1e-8 * (1 + std::abs(expected[0])));
}

INSTANTIATE_TEST_SUITE_P(Steps, RecordedLiftOf,
                         testing::Combine(testing::ValuesIn(kCases),
                                          testing::Values("exp", "cayley"),
                                          testing::Values(0.0, 0.3, 0.5)),
                         [](const auto& test) {
                           return std::get<0>(test.param).name + "_" + std::get<1>(test.param) +
                                  "_" +
                                  std::to_string(static_cast<int>(10 * std::get<2>(test.param)));
                         });

/// First derivatives by (eta, w) and by h of a step of a registered system, against differences of
/// the map of the step.
void expect_derivatives_of(const Simulation& simulation, const std::string& name) {
  SCOPED_TRACE(name);
  hamel::Run run = simulation.build();
  StepMap map(std::shared_ptr<const RunPlan>(std::shared_ptr<void>(), &run.driver().plan()));
  const auto equation = RecordedLift::of(map.plan(), RecordedLift::Order::first);
  ASSERT_NE(equation, nullptr);
  const auto& inputs = map.plan().setup.inputs;
  const Eigen::VectorXd u = inputs == nullptr ? InputValues() : inputs->at(0);
  const double h = run.config().step.value();
  const MotionState from = map.start();
  const Eigen::Index n = map.velocities(), m = map.increments() - n;
  Eigen::VectorXd d(map.increments() + 1);
  for (Eigen::Index i = 0; i < d.size(); ++i) d[i] = std::sin(12.9898 * static_cast<double>(i + 1));
  d[d.size() - 1] *= h;
  if (map.plan().system->mechanics->holonomic_rows() > 0)  // along phi = 0
    d.head(n) = map.basis(from) * d.segment(n, m);
  MotionState end, found_end;
  ASSERT_TRUE(map.step(from, from.time + h, end).ok);
  RecordedLift::Unknowns x;
  ASSERT_TRUE(equation->solve(from, u, h, x));
  ASSERT_TRUE(equation->end(found_end));
  Eigen::VectorXd apart, expected;
  ASSERT_TRUE(displacement(map.geometry(), end, found_end, apart));
  EXPECT_LT(apart.lpNorm<Eigen::Infinity>(), 1e-11);
  ASSERT_TRUE(equation->linearise(map.coordinates(end)));
  Eigen::VectorXd q = Eigen::VectorXd::Zero(equation->parameters());
  q.head(n) = d.head(n);
  q.segment(n, n) = map.basis(from) * d.segment(n, m);
  q[q.size() - 2] = d[d.size() - 1];
  const Eigen::VectorXd found = equation->jacobian() * q;
  const auto moved = [&](double e, Eigen::VectorXd& by) {
    MotionState begin, there;
    map.retract(from, e * d.head(d.size() - 1), begin);
    map.project(begin);
    return map.step(begin, begin.time + h + e * d[d.size() - 1], there).ok &&
           displacement(map.geometry(), end, there, by);
  };
  ASSERT_TRUE(ThreeDifferences::derivative(ThreeDifferences::fine, 0x1p-8, moved, expected));
  EXPECT_LT((found - expected).lpNorm<Eigen::Infinity>(),
            4e-9 * (1 + expected.lpNorm<Eigen::Infinity>()));
}

Simulation step_of(const std::string& name) {
  return simulate(name)
      .scheme("lift")
      .s(0.5)
      .solver("newton", {.tolerance = 1e-15})
      .step(0.01)
      .until(0.02);
}

/// Those without formulas of recorded numbers, and why, are known.
TEST(RecordedLift, IsExactOfEveryRegisteredSystemThatHasFormulas) {
  std::vector<std::string> without;
  for (const std::string& name : registry().systems()) {
    const hamel::Run run = step_of(name).build();
    if (RecordedLift::of(run.driver().plan(), RecordedLift::Order::first) == nullptr)
      without.push_back(name);
    else expect_derivatives_of(step_of(name), name);
  }
  EXPECT_THAT(without, testing::UnorderedElementsAre("roller_racer"));
}

/// Formulas of groups branch on the angle of a step: series or closed form. Steps that turn little
/// and much in turns are those of an equation that saw nothing else, however often.
TEST(RecordedLift, KeepsARecordOfEachBranch) {
  constexpr double kStep = 0.5;
  hamel::Run run = simulate("chaplygin_sleigh")
                       .scheme("lift")
                       .s(0.5)
                       .step(kStep)
                       .until(1)
                       .solver("newton", {.tolerance = 1e-15})
                       .build();
  StepMap map(std::shared_ptr<const RunPlan>(std::shared_ptr<void>(), &run.driver().plan()));
  const auto equation = RecordedLift::of(map.plan(), RecordedLift::Order::first);
  ASSERT_NE(equation, nullptr);
  const Eigen::VectorXd u = map.plan().setup.inputs == nullptr
                                ? Eigen::VectorXd()
                                : Eigen::VectorXd(map.plan().setup.inputs->at(0));
  RecordedLift::Unknowns x;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    MotionState from = map.start();
    from.xi << (i % 2 == 0 ? 0.01 : 3.0 + 0.02 * i), 0.8, 0;
    MotionState end, alone_end;
    ASSERT_TRUE(equation->solve(from, u, kStep, x));
    ASSERT_TRUE(equation->end(end));
    ASSERT_TRUE(equation->linearise(map.coordinates(end)));
    const auto alone = RecordedLift::of(map.plan(), RecordedLift::Order::first);
    RecordedLift::Unknowns y;
    ASSERT_TRUE(alone->solve(from, u, kStep, y));
    ASSERT_TRUE(alone->end(alone_end));
    ASSERT_TRUE(alone->linearise(map.coordinates(end)));
    Eigen::VectorXd apart;
    ASSERT_TRUE(displacement(map.geometry(), end, alone_end, apart));
    EXPECT_LT(apart.lpNorm<Eigen::Infinity>(), 1e-12);
    EXPECT_LT((equation->jacobian() - alone->jacobian()).lpNorm<Eigen::Infinity>(), 1e-11);
  }
}

/// Mechanisms: a free root on wheels with heights, a planar one with motors, a ball.
TEST(RecordedLift, IsExactOfMechanisms) {
  for (const char* name : {"bicycle", "car", "ballbot", "kick_scooter", "tricycle"})
    expect_derivatives_of(step_of(name), name);
}

}  // namespace
}  // namespace hamel
