// The equations of motion by one dual number: what they give is of (t, g, xi) alone, whatever was
// asked before, and equal to what differences of the rows and the drift give.
#include <gtest/gtest.h>

#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/framework/schemes/static_problem.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/systems/knife_edge_on_incline.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace {

using namespace hamel;

using Element = SE2::Element<double>;

template <class S>
using Problem = StaticProblem<S, Cayley<SE2>>;

template <class S>
Problem<S> problem_of(const S& system) {
  return Problem<S>(std::shared_ptr<const Geometry>(), erase(system).mechanics);
}

// Constant rows that move: (0, b, 1) xi = drift(g).
struct Moving {
  using Group = SE2;
  Mat<3, 3> inertia() const { return Mat<3, 3>{{0.4, 0.1, 0}, {0.1, 2, 0.3}, {0, 0.3, 3}}; }
  Mat<1, 3> constraints() const { return Mat<1, 3>{0, 0.2, 1}; }
  auto potential(const auto& g) const { return g.translation[0] * g.translation[1]; }
};
struct ByDual : Moving {
  auto drift(const auto& g) const {
    using T = std::decay_t<decltype(g.translation[0])>;
    return VecT<T, 1>(0.3 * g.translation[0] * g.translation[0] + 0.5 * g.translation[1]);
  }
};
struct ByDifferences : Moving {
  Vec<1> drift(const Element& g) const {
    return Vec<1>(0.3 * g.translation[0] * g.translation[0] + 0.5 * g.translation[1]);
  }
};

const Vec<3> kVelocity(0.7, 1.1, -0.4);
Element place(double x) {
  return SE2::compose(Cayley<SE2>::tau(Vec<3>(0.3 * x, x, 1 - x)), SE2::identity<double>());
}

TEST(EquationsOfMotion, DoNotRememberAProjection) {
  const auto problem = problem_of(KnifeEdgeOnIncline());
  EquationsOfMotion motion(problem);
  const Element g = place(0.4);
  motion.solve(0, g, kVelocity);
  motion.solve(0, g, kVelocity);  // from the second one on by the dual number
  const Vec<3> expected = motion.acceleration();
  Vec<3> off(0.1, 0.2, 5);  // far off the rows
  motion.set(0, g);
  motion.project(off);
  motion.solve(0, g, kVelocity);
  EXPECT_EQ(motion.acceleration(), expected);
}

TEST(EquationsOfMotion, ADriftOfConstantRowsIsDifferentiated) {
  static_assert(Problem<ByDual>::has_dual_rates() && !Problem<ByDifferences>::has_dual_rates());
  const auto dual = problem_of(ByDual());
  const auto differences = problem_of(ByDifferences());
  EquationsOfMotion one(dual);
  EquationsOfMotion other(differences);
  for (const double x : {0.4, -0.8, 0.1, 1.3}) {
    one.solve(0, place(x), kVelocity);
    other.solve(0, place(x), kVelocity);
    EXPECT_LT((one.acceleration() - other.acceleration()).norm(), 1e-9) << x;
    EXPECT_LT((one.reaction() - other.reaction()).norm(), 1e-9) << x;
  }
}

}  // namespace
