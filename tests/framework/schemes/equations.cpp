// One step of balance, boxed and boxed_literal satisfies (M20), (M21) and (M22), written here with
// differences of tau alone: xi recovered from the two configurations, dL and dR by numerical
// differentiation, Ad by conjugation.
#include <gtest/gtest.h>

#include <hamel/framework/check/algebra.hpp>
#include <hamel/framework/lie/recover_step.hpp>
#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/second_kind.hpp>
#include <hamel/groups/so3.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "bodies.hpp"

namespace {

using namespace hamel;

/// Differences of order 6 carry 1e-11; a step of h = 0.2 with |xi| near 0.3 shows a wrong weight,
/// sign or transposition as 1e-2 and more.
constexpr double bound = 1e-9;

template <class Tau>
struct OneStep {
  using G = typename Tau::Group;
  static constexpr int n = G::dim;
  using V = Vec<n>;
  using M = Mat<n, n>;
  const test::Body<G, 1> body{};
  const Eigen::MatrixXd e = hamel_frame(body.inertia(), Eigen::MatrixXd(body.constraints()));
  const TypedGeometry<Tau> geometry{};
  const check::NumericalDerivative numerical{geometry};
  double s, h = 0.2;
  V mu0, mu1, xi;

  OneStep(const std::string& scheme, double parameter) : s(parameter) {
    Start start = body.start();
    for (double& v : start.velocity) v *= 0.7;
    hamel::Run run =
        simulate(body).start(start).scheme(scheme).s(s).retraction(Tau::name()).step(h).build();
    const Snapshot before = run.state();
    EXPECT_TRUE(run.step().ok);
    const Snapshot& after = run.state();
    mu0 = Eigen::Map<const V>(before.momentum.data());
    mu1 = Eigen::Map<const V>(after.momentum.data());
    const auto g0 = G::from_coordinates(before.coordinates),
               g1 = G::from_coordinates(after.coordinates);
    xi = recover_step<Tau>(G::compose(G::inverse(g0), g1), s);
    EXPECT_GT(xi.norm(), 0.05);
  }
  M left(const V& z) const { return numerical.left(z); }
  M right(const V& z) const { return numerical.right(z); }
  double reduced(const V& covector) const { return (e.transpose() * covector).norm(); }
};

template <class Tau>
void expect_equations() {
  using V = typename OneStep<Tau>::V;
  using G = typename Tau::Group;
  const std::string where = G::name() + " " + Tau::name();
  for (const double s : {0.0, 0.3, 0.5, 1.0}) {
    const OneStep<Tau> o("balance", s);
    const V z0 = -s * o.xi, z1 = (1 - s) * o.xi;
    const V average = s * o.left(z0).transpose() * o.mu0 + (1 - s) * o.left(z1).transpose() * o.mu1;
    EXPECT_LE(o.reduced(average - o.body.inertia() * o.xi / o.h), bound)
        << where << " balance (1), s = " << s;
    const V carried = G::Ad(G::inverse(Tau::tau(z1))).transpose() * o.mu1 -
                      G::Ad(G::inverse(Tau::tau(z0))).transpose() * o.mu0;
    EXPECT_LE(o.reduced(carried), bound) << where << " balance (2), s = " << s;
  }
  {
    const OneStep<Tau> o("boxed", 0);
    EXPECT_LE(o.reduced(o.right(o.xi).transpose() * o.mu0 - o.body.inertia() * o.xi / o.h), bound)
        << where;
    EXPECT_LE(o.reduced(G::Ad(Tau::tau(o.xi)).transpose() * o.mu0 - o.mu1), bound)
        << where << " boxed, update";
  }
  {
    const OneStep<Tau> o("boxed_literal", 0);
    // mu_k has no part along the Euclidean complement of d and the same values on d.
    const auto embedded = [&](const V& mu) -> V {
      return o.e * (o.e.transpose() * o.e).inverse() * (o.e.transpose() * mu);
    };
    EXPECT_LE(o.reduced(o.right(o.xi).transpose() * embedded(o.mu0) - o.body.inertia() * o.xi),
              bound)
        << where;
    EXPECT_LE(o.reduced(G::Ad(G::inverse(Tau::tau(o.xi))).transpose() * embedded(o.mu0) - o.mu1),
              bound)
        << where << " boxed_literal, update";
  }
}

TEST(Equations, OnSO3) {
  expect_equations<Exp<SO3>>();
  expect_equations<Cayley<SO3>>();
  expect_equations<SecondKind<SO3>>();
}
TEST(Equations, OnSE2) {
  expect_equations<Exp<SE2>>();
  expect_equations<Cayley<SE2>>();
  expect_equations<SecondKind<SE2>>();
}

}  // namespace
