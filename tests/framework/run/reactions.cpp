// Reactions of a run: solved once a state.
#include <gtest/gtest.h>

#include <hamel/hamel.hpp>

#include <hamel/framework/run/run/rows/reactions.hpp>

namespace {

using namespace hamel;

long evaluations = 0;

// A point in two contacts.
struct InTwoContacts {
  using Group = Rn<4>;
  static std::string name() { return "in_two_contacts"; }
  static Mat<4, 4> inertia() { return Vec<4>(1, 2, 3, 0.5).asDiagonal(); }
  static Mat<2, 4> constraints(const Vec<4>& q) {
    ++evaluations;
    return Mat<2, 4>{{std::sin(q[3]), -std::cos(q[3]), 0, 0.1}, {0.2 * q[0], 0, 1, 0}};
  }
  static std::vector<int> contacts() { return {0, 1}; }
  static Start start() { return {.velocity = {1, 0, 0, 1}}; }
};

long evaluations_of(const std::vector<std::string>& events, bool rows) {
  evaluations = 0;
  auto simulation = simulate(InTwoContacts{}).scheme("lift").step(0.01).until(1).events(events);
  if (!rows) simulation.every(1000);
  EXPECT_TRUE(simulation.run());
  return evaluations;
}

TEST(Reactions, AreSolvedOnceAStateWhoeverWantsThem) {
  const long none = evaluations_of({}, false);
  const long one = evaluations_of({"contact_lost1"}, false);
  const long both = evaluations_of({"contact_lost1", "contact_lost2"}, false);
  EXPECT_GE(one, none + 100) << "one solve a step, at least";
  // Where the second crosses zero it is located: by its own solves between two nodes.
  EXPECT_LE(both, one + 40);
  EXPECT_LE(evaluations_of({"contact_lost1", "contact_lost2"}, true),
            evaluations_of({}, true) + 140)
      << "rows and contacts share them";
}

struct Counted final : LeftInvariantMechanics {
  using LeftInvariantMechanics::LeftInvariantMechanics;
  bool constant_constraints() const override { return false; }
  bool left_invariant() const override { return false; }
  void constraints(double t, const double* g, Matrix a, Vector b) const override {
    ++evaluations;
    LeftInvariantMechanics::constraints(t, g, a, b);
  }
};

TEST(Reactions, OfAnotherStateAreOthers) {
  const Eigen::Matrix3d inertia{{2, 0.3, 0.5}, {0.3, 3, 0.4}, {0.5, 0.4, 5}};
  const auto geometry = erased_geometry<Cayley<SO3>>();
  Reactions reactions(geometry, std::make_shared<Counted>(inertia, Eigen::RowVector3d(0, 0, 1)),
                      nullptr);
  Snapshot state;
  state.coordinates = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  state.velocity = {1, 2, 0};
  const double first = reactions.at(state)[0];
  // I xi' = ad*_xi I xi + A^T lambda, xi_3' = 0.
  const Eigen::Vector3d xi(1, 2, 0), torque = (inertia * xi).cross(xi);
  const Eigen::Vector2d rate =
      inertia.topLeftCorner<2, 2>().inverse() * Eigen::Vector2d(torque.head<2>());
  EXPECT_NEAR(first, inertia.row(2).head<2>().dot(rate) - torque[2], 1e-14);
  evaluations = 0;
  Snapshot kept = state;  // as a kernel has it
  kept.element.resize(static_cast<size_t>(geometry->size()));
  geometry->from_coordinates(state.coordinates, kept.element.data());
  EXPECT_EQ(reactions.at(kept)[0], first);
  EXPECT_EQ(evaluations, 0);
  state.velocity = {2, 4, 0};
  EXPECT_NEAR(reactions.at(state)[0], 4 * first, 1e-13);
  const long solved = evaluations;
  EXPECT_GT(solved, 0);
  EXPECT_EQ(reactions.at(kept)[0], first);
  EXPECT_GT(evaluations, solved);
}

}  // namespace
