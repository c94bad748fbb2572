// Large steps: no solver returns a root other than the principal one.
//
// One step from random starts, |xi| to 4, h = 0.2 ... 2, compared with the principal root (M40),
// found here independently by continuation from a small h: small fixed steps of h, plain Newton, no
// step control. A result of the library must be that root or be refused. The solver "wild" starts
// from a random point instead of the guess and finds roots that no other finds.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/schemes/balance.hpp>
#include <hamel/framework/schemes/boxed.hpp>
#include <hamel/framework/schemes/unadapted.hpp>
#include <hamel/hamel.hpp>

#include "../framework/schemes/dynamic_problem.hpp"
#include "made.hpp"

namespace {

using namespace hamel;

/// The momentum after one step along the branch that begins at h = 0; empty when the branch ends,
/// or the root leaves the domain, or passes so close to a fold that the two cannot be told apart.
template <class Step>
std::vector<double> by_continuation(Step& step, const Node<typename Step::Problem>& node,
                                    double h) {
  step.begin(node, 0);
  typename Step::Unknown y, f;
  step.guess(y);
  typename Step::Jacobian j;
  const double size = y.norm();
  constexpr int parts = 1000;
  for (int i = 1; i <= parts; ++i) {
    step.begin(node, h * i / parts);
    const typename Step::Unknown before = y;
    for (int k = 0; k < 6; ++k) {
      step.linearise(y, f, j);
      y -= Eigen::MatrixXd(j).partialPivLu().solve(Eigen::VectorXd(f));
    }
    step.residual(y, f);
    if (!(f.norm() <= 1e-12 * size) || (y - before).norm() > 0.02 * size) return {};
  }
  Node<typename Step::Problem> next = node;
  if (!step.finish(y, next)) return {};  // outside the domain
  return {next.x.begin(), next.x.end()};
}

struct Count {
  int right = 0, refused = 0, wrong = 0, refused_though_there = 0;
};

/// A Newton that starts from a random point.
void add_wild(Registry& registry) {
  auto random = std::make_shared<std::mt19937>(5);
  registry.add_solver(
      "wild", "Newton from a random point",
      [random](const Equation& equation, std::span<double> x, double tolerance) {
        const int n = equation.size();
        std::normal_distribution<double> normal;
        Eigen::Map<Eigen::VectorXd> at(x.data(), n);
        const double size = at.norm();
        Eigen::VectorXd f(n);
        Eigen::MatrixXd j(n, n);
        for (int k = 0; k < n; ++k) at[k] += 0.5 * size * normal(*random);
        for (int k = 0; k < 30; ++k) {
          equation.evaluate(x, test::span_of(f), {j.data(), static_cast<size_t>(j.size())});
          if (f.norm() <= tolerance) return;
          at -= j.partialPivLu().solve(f);
        }
      });
}

/// The loop that solves the step: compiled for the system, or the erased one.
enum class On { compiled, general };

template <class S>
OwnSystem::Maker maker_on(On loop, const S& system) {
  if (loop == On::compiled) return maker(system);
  return [make = maker(system)](const Parameters& given) { return test::erased(make(given)); };
}

template <class Scheme, template <class> class T, class S>
void expect_no_spurious_root(const S& system, double s, std::map<std::string, Count>& counts,
                             On loop = On::compiled) {
  using G = typename S::Group;
  using Tau = T<G>;
  constexpr int n = G::dim, m = n - constraint_count<S>();
  using Whole = LeftInvariant<G, m, Tau>;
  using Step = typename Scheme::template Step<Whole>;
  const Mat<n, n> inertia = system.inertia();
  const Eigen::MatrixXd admissible = hamel_frame(inertia, Eigen::MatrixXd(system.constraints()));
  const Whole whole(inertia, system.constraints());
  Step step(whole, s);
  const auto problem = [&] {  // the step's own: without rows for unadapted
    if constexpr (Scheme::constraint_kept != ConstraintKept::nowhere) return whole;
    else return whole.unconstrained();
  }();
  Registry mine = registry();
  add_wild(mine);

  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> size(0.25, 4);
  for (const double h : {0.2, 0.5, 1.0, 2.0}) {
    for (int start = 0; start < 12; ++start) {
      Eigen::VectorXd y(admissible.cols());
      for (double& value : y) value = normal(random);
      Eigen::VectorXd xi = admissible * y;
      xi *= size(random) / xi.norm();
      Node<typename Step::Problem> node(problem);
      problem.to_state(xi, node.x);
      const typename Step::Problem::State mu = node.x;
      const std::vector<double> expected = by_continuation(step, node, h);
      const auto solvers = loop == On::compiled
                               ? mine.solvers()
                               : std::vector<std::string>{"newton", "hybrid", "wild"};
      for (const std::string& solver : solvers) {
        Simulation simulation(mine, "given", OwnSystem{maker_on(loop, system)});
        simulation.start({.velocity = {xi.begin(), xi.end()}})
            .scheme(Scheme::name())
            .s(s)
            .retraction(Tau::name())
            .solver(solver)
            .step(h)
            .until(h);
        hamel::Run run = simulation.build();
        Count& count = counts[solver];
        if (!run.step()) {
          ++count.refused;
          if (!expected.empty()) ++count.refused_though_there;
          continue;
        }
        const Eigen::VectorXd velocity =
            Eigen::Map<const Eigen::VectorXd>(run.state().velocity.data(), n);
        const Eigen::VectorXd got = problem.reduce(inertia * Vec<n>(velocity));
        double apart = expected.empty() ? 1 : 0;
        for (size_t i = 0; i < expected.size(); ++i) {
          apart = std::max(apart, std::abs(got[static_cast<int>(i)] - expected[i]) / mu.norm());
        }
        if (apart <= 1e-8) ++count.right;
        else ++count.wrong;
        EXPECT_LE(apart, 1e-8) << solver << " " << Scheme::name() << " " << Tau::name()
                               << " h = " << h << ", start " << xi.transpose()
                               << (expected.empty() ? ": the branch ends before h" : "");
      }
    }
  }
}

Suslov body(std::vector<double> moments) {
  Suslov suslov;
  suslov.moments = std::move(moments);
  return suslov;
}

void report(const std::map<std::string, Count>& counts) {
  for (const auto& [solver, count] : counts) {
    std::printf("%-18s right %d, refused %d (%d of them though the branch is there), wrong %d\n",
                solver.c_str(), count.right, count.refused, count.refused_though_there,
                count.wrong);
    EXPECT_GE(count.right, 5 * count.refused_though_there) << solver;  // refusing all is no answer
  }
}

template <class S>
void all_schemes(const S& system) {
  std::map<std::string, Count> counts;
  expect_no_spurious_root<Lift, Exp>(system, 0, counts);
  expect_no_spurious_root<Lift, Cayley>(system, 0.5, counts);
  expect_no_spurious_root<Balance, Exp>(system, 0.5, counts);
  expect_no_spurious_root<Balance, Cayley>(system, 0.5, counts);
  expect_no_spurious_root<Boxed, Exp>(system, 0, counts);
  expect_no_spurious_root<Unadapted, Cayley>(system, 0.5, counts);
  report(counts);
  std::map<std::string, Count> general;
  expect_no_spurious_root<Lift, Exp>(system, 0, general, On::general);
  expect_no_spurious_root<Lift, Cayley>(system, 0.5, general, On::general);
  expect_no_spurious_root<Balance, Exp>(system, 0.5, general, On::general);
  expect_no_spurious_root<Balance, Cayley>(system, 0.5, general, On::general);
  report(general);
}

TEST(LargeSteps, SuslovWithFullInertia) { all_schemes(body({2, .3, .5, 3, .4, 4})); }
TEST(LargeSteps, SuslovWithVeryUnequalMoments) { all_schemes(body({1, 10, 100})); }
TEST(LargeSteps, Sleigh) { all_schemes(ChaplyginSleigh{}); }

}  // namespace
