// Laws of every registered solver: the certificate, the floor, the same trajectory.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>

#include <hamel/systems/simulate_typed.hpp>

#include "made.hpp"

namespace {

using namespace hamel;
using test::Made;
using test::Vector;

/// All that cross framework/loop/solver.hpp; Newton is compiled into the kernels.
std::vector<std::string> foreign() {
  std::vector<std::string> out;
  for (const std::string& name : registry().solvers()) {
    if (registry().solver(name)->make) out.push_back(name);
  }
  return out;
}
// Minimises |F|^2/2: near the floor its differences are round-off, and it may have to refuse.
bool minimises(const std::string& name) {
  return name.starts_with("nlopt:") && name != "nlopt:slsqp";
}
// Left-invariant systems on a registered group run whole, others a few steps.
bool left_invariant(const std::string& system) {
  return registry().system(system)->make({}).mechanics->left_invariant();
}
bool compiled(const std::string& system) {  // on a registered group: at most six unknowns
  return left_invariant(system) &&
         registry().group(registry().system(system)->group.name) != nullptr;
}
bool defined(const std::string& scheme, const std::string& system) {
  return registry().scheme(scheme)->defined(left_invariant(system));
}

TEST(EverySolver, IsDescribed) {
  EXPECT_GE(foreign().size(), 1u);
  for (const std::string& name : registry().solvers()) {
    const SolverInfo& info = *registry().solver(name);
    for (const std::string& words : {info.summary, info.method, info.stops, info.source}) {
      EXPECT_FALSE(words.empty()) << name;
    }
  }
}

/// The report is that of the x left behind, whatever the size and the units.
TEST(EverySolver, ReachesTheFloorAndCertifiesIt) {
  for (const std::string& name : foreign()) {
    const auto solver = registry().solver(name)->make();
    for (const int n : {1, 2, 3, 4, 6, 2}) {
      for (const double unit : {1.0, 1e-6, 1e6}) {
        const Made equation = test::like_a_step(n, 0.1, unit);
        Vector x = Vector::Constant(n, 1);
        const SolveReport report = solver->solve(equation, test::span_of(x), 1e-13);
        EXPECT_TRUE(report.ok()) << name << " " << n << " " << unit << ": "
                                 << to_string(report.reason) << " " << report.residual;
        EXPECT_LE(report.residual, 1e-13) << name << " " << n << " " << unit;
        EXPECT_NEAR(report.residual, equation.residual(x), 1e-18) << name;
        EXPECT_EQ(report.evaluations, equation.evaluations) << name;
      }
    }
  }
}

/// A guess that already meets the tolerance is improved too: its error is of one sign.
TEST(EverySolver, CorrectsAGoodGuess) {
  for (const std::string& name : foreign()) {
    const auto solver = registry().solver(name)->make();
    const Made equation = test::like_a_step(2, 0.1);
    Vector root = Vector::Constant(2, 1);
    ASSERT_TRUE(solver->solve(equation, test::span_of(root), 1e-13).ok()) << name;
    Vector x = root * (1 + 5e-14);  // within 1e-13
    ASSERT_LE(equation.residual(x), 1e-13);
    ASSERT_TRUE(solver->solve(equation, test::span_of(x), 1e-13).ok()) << name;
    EXPECT_LE(equation.residual(x), 5e-15) << name;
  }
}

TEST(EverySolver, SaysWhyItCannot) {
  // x^2 + 1 = 0, and a value that is no number.
  const Made none(
      1, [](const Vector& x) { return Vector(Vector::Constant(1, 1 + x[0] * x[0])); },
      [](const Vector& x) { return test::Matrix(test::Matrix::Constant(1, 1, 2 * x[0] + 1e-9)); });
  const Made undefined(
      1, [](const Vector& x) { return Vector(Vector::Constant(1, std::sqrt(x[0] - 5))); },
      [](const Vector&) { return test::Matrix(test::Matrix::Constant(1, 1, 1)); });
  for (const std::string& name : foreign()) {
    const auto solver = registry().solver(name)->make();
    Vector x = Vector::Constant(1, 1);
    const SolveReport report = solver->solve(none, test::span_of(x), 1e-13);
    EXPECT_TRUE(report.reason == Reason::stagnated || report.reason == Reason::max_iterations)
        << name << ": " << to_string(report.reason);
    EXPECT_NEAR(report.residual, none.residual(x), 1e-15) << name;
    EXPECT_GE(report.residual, 0.99) << name;
    x[0] = 0;
    EXPECT_EQ(solver->solve(undefined, test::span_of(x), 1e-13).reason, Reason::not_finite) << name;
    // A later solve succeeds.
    const Made good = test::like_a_step(1, 0.1);
    x[0] = 1;
    EXPECT_TRUE(solver->solve(good, test::span_of(x), 1e-13).ok()) << name;
  }
}

TEST(EverySolver, RestIsAccepted) {
  for (const std::string& name : registry().solvers()) {
    const Result r =
        simulate("suslov").start({.velocity = {0, 0, 0}}).solver(name).until(0.1).run();
    EXPECT_TRUE(r.status.ok) << name << ": " << r.status.reason;
    EXPECT_EQ(r.stats.residual_max, 0) << name;
  }
}

Simulation moderate(const std::string& system, const std::string& scheme,
                    const std::string& retraction, const std::string& solver) {
  return simulate(system).scheme(scheme).s(0.3).retraction(retraction).solver(solver).step(0.02);
}

/// Registered means solved: every system, scheme and retraction. Only a minimiser may refuse, with
/// a reason. boxed_literal takes O(1) steps whatever h is: it may leave the domain.
TEST(EverySolver, SolvesEveryStep) {
  long refused = 0, all = 0;
  std::map<std::string, long> refusals;
  for (const std::string& system : registry().systems()) {
    const std::string group = registry().system(system)->group.name;
    for (const std::string& scheme : registry().schemes()) {
      if (!defined(scheme, system)) continue;
      for (const std::string& retraction : registry().retractions_or_common(group)) {
        for (const std::string& solver : registry().solvers()) {
          // The general loop is slow under a minimiser of a dozen unknowns: a few steps, and not
          // those.
          if (!compiled(system) && (minimises(solver) || retraction.starts_with("second")))
            continue;
          const double until = compiled(system) ? 0.6 : 0.1;
          const Result r = moderate(system, scheme, retraction, solver).until(until).run();
          ++all;
          const std::string where = solver + " " + system + " " + scheme + " " + retraction;
          if (r.status.ok) continue;
          ++refused;
          ++refusals[solver];
          EXPECT_FALSE(r.status.reason.empty()) << where;
          EXPECT_TRUE(scheme == "boxed_literal" || minimises(solver))
              << where << ": " << r.status.reason << " in step " << r.status.step << ", "
              << r.status.residual;
        }
      }
    }
  }
  for (const auto& [solver, count] : refusals) {
    std::printf("%-18s refused %ld of %ld runs of all solvers\n", solver.c_str(), count, all);
  }
  EXPECT_LE(refused, all / 10);
}

/// At the same residual all solvers give the same trajectory.
TEST(EverySolver, SameResidualSameTrajectory) {
  for (const std::string& system : registry().systems()) {
    if (!compiled(system)) continue;
    for (const char* scheme : {"lift", "balance", "boxed", "unadapted"}) {
      if (!defined(scheme, system)) continue;
      for (const char* retraction : {"exp", "cayley"}) {
        const Result newton = moderate(system, scheme, retraction, "newton").until(2).run();
        ASSERT_TRUE(newton.status.ok);
        for (const std::string& solver : foreign()) {
          const Result other = moderate(system, scheme, retraction, solver).until(2).run();
          const std::string where = solver + " " + system + " " + scheme + " " + retraction;
          ASSERT_TRUE(other.status.ok) << where << ": " << other.status.reason;
          for (size_t i = 0; i < other.last.coordinates.size(); ++i) {
            EXPECT_NEAR(other.last.coordinates[i], newton.last.coordinates[i], 1e-10) << where;
          }
          for (size_t i = 0; i < other.last.velocity.size(); ++i) {
            EXPECT_NEAR(other.last.velocity[i], newton.last.velocity[i], 1e-10) << where;
          }
        }
      }
    }
  }
}

}  // namespace
