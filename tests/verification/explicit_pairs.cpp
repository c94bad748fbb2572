// The explicit pairs: order of every tableau on motions with fields that are not constant, error
// against tolerance, dense output and what is kept.
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

#include <gtest/gtest.h>
#include <hamel/hamel.hpp>

#include <hamel/framework/schemes/dop853.hpp>
#include <hamel/framework/schemes/dopri5.hpp>
#include <hamel/framework/schemes/tsit5.hpp>
#include <hamel/framework/study/parts.hpp>

#include "../framework/distances.hpp"
#include "without_dtau.hpp"

namespace hamel {
namespace {

using test::distance;

struct Case {
  std::string system;
  std::map<std::string, std::vector<double>> set;
  Start start;
  double step, until;
};

/// On the Heisenberg group with full inertia, so that its velocity turns.
struct Twisted {
  using Group = Heisenberg;
  static std::string name() { return "twisted"; }
  static Mat<3, 3> inertia() { return Mat<3, 3>{{2, 0.3, 0.9}, {0.3, 3, 0.7}, {0.9, 0.7, 4}}; }
  static Mat<1, 3> constraints() { return Mat<1, 3>{0, 0, 1}; }
};
const Registry& systems() {
  static const Registry all = [] {
    Registry out = registry();
    add_system<Twisted>(out);
    return out;
  }();
  return all;
}

// One for each group: so3, se2, se3 with a holonomic row, heisenberg, and one with a moving
// constraint.
std::vector<Case> cases() {
  return {{"suslov", {{"inertia", {2, 0.3, 0.5, 3, 0.4, 4}}}, {.velocity = {1, 0.5, 0}}, 0.4, 8},
          {"chaplygin_sleigh", {}, {.velocity = {0.9, -1, 0}}, 0.4, 8},
          {"falling_disk", {}, {}, 0.04, 1},
          {"twisted", {}, {.velocity = {1, 0.5, 0}}, 0.4, 8},
          {"ball_on_turntable", {}, {}, 0.2, 4}};
}

Simulation run_of(const Case& c, const std::string& scheme, const Registry& known = systems()) {
  Simulation out(known, c.system);
  for (const auto& [name, value] : c.set) out.set(name, value);
  return out.start(c.start).scheme(scheme).step(c.step).until(c.until).every(1000000);
}

// At the tightest tolerance, and another tableau agrees.
Result reference(const Case& c) {
  const Result out = run_of(c, "dop853").tolerance({.relative = 1e-14}).run();
  EXPECT_TRUE(out) << c.system << ": " << out.status.reason;
  EXPECT_LT(distance(out, run_of(c, "tsit5").tolerance({.relative = 1e-12}).run()), 1e-8);
  return out;
}

// The slope over five steps, the first of size h.
double order_of(const Case& c, const std::string& scheme, double h,
                const Registry& known = systems()) {
  const Result exact = reference(c);
  std::vector<double> x, y;
  for (const double part : {1.0, 1.2, 1.4, 1.7, 2.0}) {
    const double step = c.until / std::ceil(c.until / h * part);
    const Result r = run_of(c, scheme, known).step(step).run();
    x.push_back(std::log(step));
    y.push_back(std::log(distance(r, exact)));
  }
  return study::slope(x, y);
}

TEST(ExplicitPairs, HaveTheOrderOfTheirTableauOnEveryGroup) {
  for (const Case& c : cases()) {
    for (const auto& [scheme, claim, part] :
         {std::tuple{"dopri5", 5.0, 8.0}, {"tsit5", 5.0, 8.0}, {"dop853", 8.0, 1.0}}) {
      const double order = order_of(c, scheme, c.step / part);
      EXPECT_GT(order, claim - 0.5) << c.system << " " << scheme;
      EXPECT_LT(order, claim + 1.2) << c.system << " " << scheme;
    }
  }
}

// With exp as well, whose dL tau^-1 is another one.
TEST(ExplicitPairs, HaveItWithEveryRetraction) {
  const Case c = cases().front();
  for (const std::string& retraction : registry().retractions("so3")) {
    Case coarse = c;
    const Result exact = reference(c);
    const Result one = run_of(c, "dopri5").retraction(retraction).run();
    const Result two = run_of(c, "dopri5").retraction(retraction).step(c.step / 2).run();
    const double order = std::log2(distance(one, exact) / distance(two, exact));
    EXPECT_GT(order, 4.6) << retraction;
    EXPECT_LT(order, 6.6) << retraction;
  }
}

TEST(ExplicitPairs, LoseItWithoutTheDerivativeOfTheRetraction) {
  Registry mine = systems();
  add_scheme<verification::WithoutDtau<Dopri5>>(mine);
  for (const Case& c : cases()) {
    if (c.system == "ball_on_turntable") continue;  // its fields commute
    EXPECT_LT(order_of(c, "without_dtau", c.step / 4, mine), 3) << c.system;
  }
}

// What the start of a run, a tenth of it and its end say of c_i = sum_j a_ij, sum_i b_i = 1, sum_i
// b_i c_i = 1/2, the weights of the estimate and of the dense output at its end.
TEST(ExplicitPairs, HaveConsistentTableaus) {
  for (const Tableau* table : {&Dopri5::tableau(), &Tsit5::tableau(), &Dop853::tableau()}) {
    const int all = table->all_stages();
    for (int i = 1; i < all; ++i) {
      double sum = 0;
      for (int j = 0; j < i; ++j) sum += table->at(i, j);
      EXPECT_NEAR(sum, table->c[static_cast<size_t>(i)], 2e-15 * 10);
    }
    double moments[5] = {0, 0, 0, 0, 0}, estimate = 0, end = 0;
    for (int i = 0; i < all; ++i) {
      const double c = table->c[static_cast<size_t>(i)];
      const double b = i < table->stages ? table->at(table->stages, i) : 0;
      for (int k = 0; k < 5; ++k) moments[k] += b * std::pow(c, k);
      if (i <= table->stages) estimate += table->e[static_cast<size_t>(i)];
      double weight = -b;  // of the dense output at the end, less b_i
      for (int j = 0; j < table->degree; ++j)
        weight += table->dense[static_cast<size_t>(i * table->degree + j)];
      end += std::abs(weight);
    }
    for (int k = 0; k < 5; ++k) EXPECT_NEAR(moments[k], 1.0 / (k + 1), 1e-13);
    EXPECT_NEAR(estimate, 0, 1e-13);
    EXPECT_NEAR(end, 0, 1e-11);
  }
}

// The error is proportional to the tolerance, and the constraints are kept.
TEST(ExplicitPairs, FollowTheTolerance) {
  for (Case c : cases()) {
    c.until *= 4;
    // A circle and a motion of few steps leave the asymptotic range.
    const bool strict = c.system != "ball_on_turntable" && c.system != "twisted";
    const Result exact = reference(c);
    for (const std::string scheme : {"dopri5", "tsit5", "dop853"}) {
      std::vector<double> x, y;
      for (const double rtol : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
        const Result r = run_of(c, scheme).step(0.01).tolerance({.relative = rtol}).run();
        ASSERT_TRUE(r) << r.status.reason;
        const double error = distance(r, exact);
        EXPECT_LT(error, (strict ? 100 : 1000) * rtol) << c.system << " " << scheme << " " << rtol;
        EXPECT_DOUBLE_EQ(r.last.time, c.until);
        EXPECT_LT(r.constraint_max, 1e-13) << c.system;
        EXPECT_LT(r.group_defect_max, 1e-14) << c.system;
        if (!std::isnan(r.holonomic_max)) {
          EXPECT_LT(r.holonomic_max, 1e-13);
        }
        x.push_back(std::log(rtol));
        y.push_back(std::log(error));
      }
      EXPECT_NEAR(study::slope(x, y), 1, strict ? 0.2 : 0.3) << c.system << " " << scheme;
    }
  }
}

// At any time the error is that of the nodes, within ten.
TEST(ExplicitPairs, HaveADenseOutputOfTheirOrder) {
  std::mt19937 random(7);
  for (Case c : cases()) {
    c.until *= 2;
    std::uniform_real_distribution<double> in(0, c.until);
    std::vector<double> times;
    for (int i = 0; i < 1000; ++i) times.push_back(in(random));
    std::sort(times.begin(), times.end());
    const Result exact =
        run_of(c, "dop853").every(1).tolerance({.relative = 1e-13}).output(times).run();
    for (const std::string scheme : {"dopri5", "tsit5", "dop853"}) {
      Simulation one = run_of(c, scheme).every(1).step(0.01).tolerance({.relative = 1e-7});
      const Result nodes = one.run();
      std::vector<double> at = nodes.trajectory.column("t");
      const Result there =
          run_of(c, "dop853").every(1).tolerance({.relative = 1e-13}).output(at).run();
      const Result dense = Simulation(one).output(times).run();
      ASSERT_EQ(dense.trajectory.rows(), times.size());
      const size_t columns =
          dense.system->group.columns.size() + static_cast<size_t>(dense.system->group.dim);
      const auto worst = [&](const Trajectory& a, const Trajectory& b) {
        double out = 0;
        for (size_t i = 0; i < a.rows(); ++i) {
          EXPECT_DOUBLE_EQ(a.at(i, 0), b.at(i, 0));
          out = std::max(
              out, euclidean_distance(a.row(i).subspan(1, columns), b.row(i).subspan(1, columns)));
        }
        return out;
      };
      const double at_nodes = worst(nodes.trajectory, there.trajectory),
                   between = worst(dense.trajectory, exact.trajectory);
      EXPECT_LT(between, 10 * at_nodes) << c.system << " " << scheme;
      EXPECT_LT(dense.constraint_max, 1e-13) << c.system;
      EXPECT_LT(dense.group_defect_max, 1e-14) << c.system;
      if (!std::isnan(dense.holonomic_max)) {
        EXPECT_LT(dense.holonomic_max, 1e-13);
      }
    }
  }
}

// A disk that falls flat: the equations of motion are singular there.
TEST(ExplicitPairs, SayWhereNoStepMeetsTheTolerance) {
  const Result r = simulate("falling_disk")
                       .start({.velocity = {0, 0, 0, 0, 0, 0}})
                       .scheme("dopri5")
                       .tolerance({.relative = 1e-8})
                       .until(2)
                       .run();
  EXPECT_FALSE(r);
  EXPECT_NEAR(r.status.time, 0.63, 0.02);
  EXPECT_NE(r.status.reason.find("tolerance"), std::string::npos) << r.status.reason;
  EXPECT_GT(r.trajectory.rows(), 10u);
  EXPECT_GT(r.stats.rejected, 0);
}

}  // namespace
}  // namespace hamel
