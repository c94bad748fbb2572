// Laws of the tangent of a run: of every registered system with the schemes that it is known of.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <hamel/framework/tangent/moved_motion.hpp>
#include <hamel/framework/tangent/sensitivities.hpp>
#include <hamel/framework/tangent/step_differences.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace {

using hamel::MotionState;
using hamel::NumberMatrix;
using hamel::RunTangent;
using hamel::ThreeDifferences;

const std::vector<std::string> kSchemes = {"lift", "rkmk4", "dopri5", "tsit5", "dop853"};

Eigen::MatrixXd matrix_of(const NumberMatrix& m) {
  Eigen::MatrixXd out(m.rows, m.columns);
  for (int i = 0; i < m.rows; ++i)
    for (int j = 0; j < m.columns; ++j) out(i, j) = m(i, j);
  return out;
}

RunTangent tangent_of(const hamel::Simulation& simulation) {
  hamel::Run run = simulation.build();
  EXPECT_TRUE(run.complete().ok);
  return run.tangent();
}

MotionState state_of(const hamel::Geometry& geometry, const hamel::Snapshot& now) {
  MotionState out;
  out.time = now.time;
  out.g.resize(geometry.size());
  geometry.from_coordinates(now.coordinates, out.g.data());
  out.xi = Eigen::Map<const Eigen::VectorXd>(now.velocity.data(),
                                             static_cast<Eigen::Index>(now.velocity.size()));
  return out;
}

/// Ends of whole runs from starts that are displaced, by extrapolated differences.
class WholeRuns {
 public:
  explicit WholeRuns(const hamel::Simulation& simulation)
      : run_(simulation.build()), geometry_(*run_.driver().plan().geometry) {
    until_ = run_.config().until;
    start_ = state_of(geometry_, run_.state());
    end_ = end_of(start_);
  }
  Eigen::VectorXd along(const Eigen::VectorXd& direction) {
    const auto moved = [&](double x, Eigen::VectorXd& by) {
      MotionState there;
      hamel::displace(geometry_, start_, direction, x, there);
      return hamel::displacement(geometry_, end_, end_of(there), by);
    };
    Eigen::VectorXd out;
    EXPECT_TRUE(ThreeDifferences::derivative(ThreeDifferences::fine, 0x1p-7, moved, out));
    return out;
  }
  Eigen::Index dim() const { return start_.xi.size(); }

 private:
  MotionState end_of(const MotionState& from) {
    std::vector<double> coordinates(static_cast<size_t>(geometry_.columns()));
    geometry_.coordinates(from.g.data(), coordinates.data());
    run_.restart({.configuration = coordinates,
                  .velocity = {from.xi.data(), from.xi.data() + from.xi.size()},
                  .momentum = {}});
    EXPECT_TRUE(run_.advance_to(until_).ok);
    return state_of(geometry_, run_.state());
  }
  hamel::Run run_;
  const hamel::Geometry& geometry_;
  double until_ = 0;
  MotionState start_, end_;
};

hamel::Simulation short_run(const std::string& name, const std::string& scheme) {
  return hamel::simulate(name)
      .scheme(scheme)
      .solver("newton", {.tolerance = 1e-15})
      .step(0.01)
      .until(0.1);
}

class TangentOf : public testing::TestWithParam<std::string> {};

/// Differences of whole runs, extrapolated: they are good to about 1e-9 of the largest entry.
TEST_P(TangentOf, IsThatOfWholeRuns) {
  int systems = 0, measured = 0;
  for (const std::string& name : hamel::systems()) {
    SCOPED_TRACE(name);
    const hamel::Simulation simulation = short_run(name, GetParam());
    const RunTangent t = tangent_of(simulation);
    ASSERT_TRUE(t.status.ok) << t.status.reason;
    WholeRuns runs(simulation);
    Eigen::VectorXd direction(2 * runs.dim());
    for (Eigen::Index i = 0; i < direction.size(); ++i)
      direction[i] = std::sin(12.9898 * static_cast<double>(i + 1));
    const Eigen::MatrixXd j = matrix_of(t.matrix), error = matrix_of(t.errors);
    const Eigen::VectorXd by_runs = runs.along(direction);
    const double scale = j.lpNorm<Eigen::Infinity>();
    EXPECT_LT((j * direction - by_runs).lpNorm<Eigen::Infinity>(), 2e-9 * scale);
    EXPECT_LT(error.lpNorm<Eigen::Infinity>(), 1e-5 * scale);  // of the coarser differences
    measured += error.lpNorm<Eigen::Infinity>() > 1e-14 * scale;
    ++systems;
  }
  EXPECT_GE(systems, 30);
  EXPECT_GE(measured, 25);  // no error is that of one set beside itself
}

INSTANTIATE_TEST_SUITE_P(Schemes, TangentOf, testing::ValuesIn(kSchemes),
                         [](const auto& scheme) { return scheme.param; });

/// The tangent of a run is the product of those of its two parts; starts are those of the first
/// part's end.
TEST(Tangent, OfARunIsTheProductOfItsParts) {
  for (const char* name : {"chaplygin_sleigh", "suslov", "falling_disk", "snakeboard"}) {
    SCOPED_TRACE(name);
    const hamel::Simulation whole = short_run(name, "dop853").until(0.2);
    hamel::Simulation second = whole;
    hamel::Run run = whole.build();
    ASSERT_TRUE(run.advance_to(0.1).ok);
    second.start({.configuration = run.state().coordinates,
                  .velocity = run.state().velocity,
                  .momentum = {}});
    second.from(0.1);
    const Eigen::MatrixXd a = matrix_of(tangent_of(hamel::Simulation(whole).until(0.1)).matrix),
                          b = matrix_of(tangent_of(second).matrix),
                          all = matrix_of(tangent_of(whole).matrix);
    EXPECT_LT((b * a - all).lpNorm<Eigen::Infinity>(), 1e-10 * all.lpNorm<Eigen::Infinity>());
  }
}

/// There and back: on admissible variations the identity. A reversible scheme returns exactly.
TEST(Tangent, ThereAndBackIsTheIdentity) {
  for (const char* name : {"chaplygin_sleigh", "suslov", "falling_disk", "roller_racer"}) {
    SCOPED_TRACE(name);
    const hamel::Simulation there = short_run(name, "lift");
    hamel::Run run = there.build();
    ASSERT_TRUE(run.advance_to(0.1).ok);
    hamel::Simulation back = there;
    back.start({.configuration = run.state().coordinates,
                .velocity = run.state().velocity,
                .momentum = {}});
    back.from(0.1).until(0).step(-0.01);
    const Eigen::MatrixXd a = matrix_of(tangent_of(there).matrix),
                          b = matrix_of(tangent_of(back).matrix),
                          still = matrix_of(tangent_of(hamel::Simulation(there).until(0)).matrix);
    // still: the projection onto the linearised constraints.
    EXPECT_LT((b * a - still).lpNorm<Eigen::Infinity>(), 1e-9 * a.lpNorm<Eigen::Infinity>());
  }
}

/// A left translation of the start of a left-invariant system changes nothing.
TEST(Tangent, OfASymmetricSystemIsLeftInvariant) {
  const hamel::Simulation here =
      short_run("chaplygin_sleigh", "lift").start({.velocity = {0.9, 1, 0}});
  hamel::Simulation moved = here;
  moved.start({.configuration = {2.1, -3, 7}, .velocity = {0.9, 1, 0}});
  const Eigen::MatrixXd a = matrix_of(tangent_of(here).matrix),
                        b = matrix_of(tangent_of(moved).matrix);
  EXPECT_LT((a - b).lpNorm<Eigen::Infinity>(), 1e-11);
}

/// Diagonal Suslov: Omega is constant, R = exp(t Omega), and so eta = Ad^-1 eta0 + t dLexp dOmega.
TEST(Tangent, OfDiagonalSuslovIsClosed) {
  const hamel::Simulation simulation = hamel::simulate("suslov")
                                           .set("inertia", {1, 10, 100})
                                           .start({.velocity = {0.3, -0.4, 0}})
                                           .scheme("dop853")
                                           .step(0.05)
                                           .until(2);
  const Eigen::MatrixXd j = matrix_of(tangent_of(simulation).matrix);
  const double w = 0.5, t = 2, a = w * t;
  Eigen::Matrix3d hat;
  hat << 0, 0, -0.4, 0, 0, -0.3, 0.4, 0.3, 0;
  hat /= w;
  const Eigen::Matrix3d back =
      Eigen::Matrix3d::Identity() - std::sin(a) * hat + (1 - std::cos(a)) * hat * hat;
  const Eigen::Matrix3d left =
      Eigen::Matrix3d::Identity() - (1 - std::cos(a)) / a * hat + (1 - std::sin(a) / a) * hat * hat;
  const Eigen::Matrix3d admissible = Eigen::Vector3d(1, 1, 0).asDiagonal();
  EXPECT_LT((j.topLeftCorner(3, 3) - back).norm(), 1e-10);
  EXPECT_LT((j.topRightCorner(3, 3) - t * left * admissible).norm(), 1e-9);
  EXPECT_LT((j.bottomRightCorner(3, 3) - admissible).norm(), 1e-10);
  EXPECT_LT(j.bottomLeftCorner(3, 3).norm(), 1e-10);
}

/// Of a run that is stepped by hand: to its current state, with the inputs that it was given.
TEST(Tangent, OfARunByHandIsThatOfItsSteps) {
  const hamel::Simulation segway = short_run("segway", "lift")
                                       .input("left_torque", 0)
                                       .start({.velocity = {0.1, 1, 0, 4, 4, 0.2}});
  hamel::Run run = segway.build();
  run.input("left_torque", 0.7);
  ASSERT_TRUE(run.step(4).ok);
  const RunTangent found = run.tangent();
  ASSERT_TRUE(found.status.ok) << found.status.reason;
  const RunTangent expected =
      tangent_of(hamel::Simulation(segway).input("left_torque", 0.7).until(0.04));
  EXPECT_LT((matrix_of(found.matrix) - matrix_of(expected.matrix)).norm(), 1e-12);
  run.restart({.velocity = {0, 2, 0, 8, 8, 0}});
  ASSERT_TRUE(run.step(2).ok);
  const RunTangent restarted = run.tangent();
  ASSERT_TRUE(restarted.status.ok) << restarted.status.reason;
  EXPECT_GT((matrix_of(found.matrix) - matrix_of(restarted.matrix)).norm(), 1e-3);
  run.input("left_torque", -30);
  ASSERT_TRUE(run.step(2).ok);
  const RunTangent steered = run.tangent();
  EXPECT_FALSE(steered.status.ok);
  EXPECT_THAT(steered.status.reason, testing::HasSubstr("inputs were changed on the way"));
}

}  // namespace
