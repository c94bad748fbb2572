// The work of the reactions along the motion, measured on the configurations.
#include <gtest/gtest.h>

#include <cmath>

#include <hamel/hamel.hpp>

namespace hamel {
namespace {

// Is b != 0 somewhere along the default motion?
bool moves(const SystemModel& model, const Result& run) {
  if (model.mechanics->left_invariant()) return false;
  const Mechanics& mechanics = *model.mechanics;
  const auto geometry = registry().geometry(run.system->group.name, "cayley");
  Eigen::VectorXd g(geometry->size()), b(mechanics.constraint_count());
  Eigen::MatrixXd a(mechanics.constraint_count(), mechanics.dim());
  const auto columns = static_cast<size_t>(geometry->columns());
  for (size_t i = 0; i < run.trajectory.rows(); ++i) {
    geometry->from_coordinates(run.trajectory.row(i).subspan(1, columns), g.data());
    mechanics.constraints(run.trajectory.at(i, 0), g.data(), a, b);
    if (b.norm() > 0) return true;
  }
  return false;
}

/// Constraints that rest do no work: lambda . A v, the v of lift's steps recovered from the
/// configurations.
TEST(Reactions, DoNoWorkWhereTheConstraintRests) {
  int seen = 0;
  for (const std::string& system : registry().systems()) {
    const Result run = simulate(system).step(0.01).until(4).run();
    ASSERT_TRUE(run.status.ok) << system << ": " << run.status.reason;
    if (std::isnan(run.reaction_work) || moves(registry().system(system)->make({}), run)) continue;
    ++seen;
    double effort = 0;  // an upper bound in that time
    for (int j = 1; run.trajectory.has("lambda" + std::to_string(j)); ++j) {
      for (const double lambda : run.trajectory.column("lambda" + std::to_string(j))) {
        effort = std::max(effort, std::abs(lambda));
      }
    }
    EXPECT_LE(std::abs(run.reaction_work), 1e-11 * std::max(effort, 1.0)) << system;
  }
  EXPECT_GE(seen, 15);
}

/// Steps that violate the constraint have a measured work: the column is not set by the code.
TEST(Reactions, WorkWhereTheStepsLeaveTheConstraint) {
  const Result run =
      simulate("knife_edge_on_incline").scheme("reversible").step(0.1).until(4).run();
  double largest = 0;
  for (const double p : run.trajectory.column("reaction_power")) {
    largest = std::max(largest, std::abs(p));
  }
  EXPECT_GT(largest, 1e-5);
}

/// A normal reaction can push only: a disk with a slow turn that falls over is pulled from t = 0.56
/// s on, and that is noted with its first time. Rolling as it starts by default it is pushed all
/// the way.
TEST(Reactions, OfAContactThatPullsIsNoted) {
  const auto notes = [](const Result& run) {
    std::string all;
    for (const std::string& note : run.notes) all += note + "\n";
    return all;
  };
  const Result falls =
      simulate("falling_disk").start({.velocity = {0.5, 0, 0, 0, 0, 0}}).until(0.6).run();
  ASSERT_TRUE(falls.status.ok);
  const std::vector<double> normal = falls.trajectory.column("lambda3"),
                            t = falls.trajectory.column("t");
  const auto first = std::find_if(normal.begin(), normal.end(), [](double n) { return n < 0; });
  ASSERT_NE(first, normal.end());
  EXPECT_NEAR(t[static_cast<size_t>(first - normal.begin())], 0.56, 1e-9);
  EXPECT_NE(notes(falls).find("the contact pulls from t = 0.56 on, lambda3 < 0"), std::string::npos)
      << notes(falls);
  EXPECT_EQ(notes(simulate("falling_disk").until(5).run()).find("pulls"), std::string::npos);
}

/// On a turning table nothing but the reactions works on the ball: its energy changes by their
/// work, to O(h^2).
TEST(Reactions, OfAMovingConstraintFeedInTheEnergy) {
  const auto balance = [](double h) {
    const Result run = simulate("ball_on_turntable").step(h).until(2).run();
    const std::vector<double> energy = run.trajectory.column("energy");
    const double change = energy.back() - energy.front();
    EXPECT_GT(std::abs(change), 1e-3);  // there is something to balance
    return std::abs(run.reaction_work - change) / std::abs(change);
  };
  const double coarse = balance(0.02), fine = balance(0.01);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2);
}

}  // namespace
}  // namespace hamel
