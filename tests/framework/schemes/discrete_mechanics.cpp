// lift is the discrete Lagrange-d'Alembert scheme (M15): an independent implementation, by
// numerical differentiation of L_d(g0, g1) = h l(tau_s^-1(g0^-1 g1)/h), takes the same steps.
//
//   < mu_k, eta >     = -d/de L_d(g_k tau(e eta), g_{k+1}),
//   < mu_{k+1}, eta > =  d/de L_d(g_k, g_{k+1} tau(e eta)),
// both on d only, with g_{k+1} = g_k tau_s(h E y). No dtau, no Ad*, no Jacobian of the library
// enters.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include <hamel/framework/check/group_laws.hpp>
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

template <class Tau>
class DiscreteMechanics {
  using G = typename Tau::Group;
  using Element = typename G::template Element<double>;
  static constexpr int n = G::dim;
  using Vector = Eigen::VectorXd;

 public:
  DiscreteMechanics(const Mat<n, n>& inertia, const Eigen::MatrixXd& frame, double s, double h)
      : inertia_(inertia), frame_(frame), s_(s), h_(h) {}

  /// From (g, mu_bar) to the next node.
  void step(Element& g, Vector& mu) const {
    Vector y = mu;
    for (int k = 0; k < 8; ++k) {
      const auto f = [&](const Vector& at) -> Vector {
        return momentum_before(g, next(g, at)) - mu;
      };
      Eigen::MatrixXd slope(y.size(), y.size());
      for (int j = 0; j < y.size(); ++j) {
        slope.col(j) =
            (f(y + 1e-4 * Vector::Unit(y.size(), j)) - f(y - 1e-4 * Vector::Unit(y.size(), j))) /
            2e-4;
      }
      y -= slope.lu().solve(f(y));
    }
    const Element g1 = next(g, y);
    mu = momentum_after(g, g1);
    g = g1;
  }

 private:
  Element tau_s(const Vec<n>& xi) const {
    return G::compose(G::inverse(Tau::tau(Vec<n>(-s_ * xi))), Tau::tau(Vec<n>((1 - s_) * xi)));
  }
  Element next(const Element& g, const Vector& y) const {
    return G::compose(g, tau_s(h_ * (frame_ * y)));
  }
  /// L_d, with tau_s inverted by fixed-point iteration: tau_s(xi) = tau(xi) up to O(xi^2).
  double lagrangian(const Element& g0, const Element& g1) const {
    const Element delta = G::compose(G::inverse(g0), g1);
    Vec<n> xi = Tau::tau_inverse(delta);
    for (int k = 0; k < 60; ++k) {
      const Vec<n> change = Tau::tau_inverse(G::compose(G::inverse(tau_s(xi)), delta));
      xi += change;
      if (change.norm() < 1e-16) break;
    }
    const Vec<n> velocity = xi / h_;
    return 0.5 * h_ * velocity.dot(inertia_ * velocity);
  }
  template <class Function>
  Vector on_frame(Function&& along) const {
    Vector out(frame_.cols());
    for (int j = 0; j < frame_.cols(); ++j) {
      const Vec<n> direction = frame_.col(j);
      out[j] = check::derivative(
          [&](double t) -> Vec<1> { return Vec<1>(along(Vec<n>(t * direction))); }, step_)[0];
    }
    return out;
  }
  Vector momentum_before(const Element& g0, const Element& g1) const {
    return -on_frame([&](const Vec<n>& d) { return lagrangian(G::compose(g0, Tau::tau(d)), g1); });
  }
  Vector momentum_after(const Element& g0, const Element& g1) const {
    return on_frame([&](const Vec<n>& d) { return lagrangian(g0, G::compose(g1, Tau::tau(d))); });
  }

  static constexpr double step_ = 2e-3;
  Mat<n, n> inertia_;
  Eigen::MatrixXd frame_;
  double s_, h_;
};

/// The differences of order 6 with step 2e-3 carry 1e-16 |L_d|/2e-3, 1e-12 with L_d near 1, and a
/// truncation of (2e-3)^6 L_d^(7)/140 below 1e-12; eight steps add up to some 1e-11. h = 0.2 makes
/// a wrong term of order h^2 visible as 1e-2.
constexpr double bound = 1e-9;

template <class Tau, int K>
void expect_same_steps() {
  using G = typename Tau::Group;
  const test::Body<G, K> body;
  const double h = 0.2;
  for (const double s : {0.0, 0.3, 0.5, 1.0}) {
    hamel::Run run = simulate(body).scheme("lift").s(s).retraction(Tau::name()).step(h).build();
    const Snapshot start = run.state();
    const Eigen::MatrixXd frame = hamel_frame(body.inertia(), Eigen::MatrixXd(body.constraints()));
    const DiscreteMechanics<Tau> mechanics(body.inertia(), frame, s, h);
    auto g = G::from_coordinates(start.coordinates);
    Eigen::VectorXd mu =
        frame.transpose() * Eigen::Map<const Eigen::VectorXd>(start.momentum.data(), G::dim);
    for (int k = 0; k < 8; ++k) {
      ASSERT_TRUE(run.step().ok);
      mechanics.step(g, mu);
    }
    const Snapshot& end = run.state();
    const Eigen::VectorXd momentum =
        frame.transpose() * Eigen::Map<const Eigen::VectorXd>(end.momentum.data(), G::dim);
    EXPECT_LE(check::distance<G>(G::from_coordinates(end.coordinates), g), bound)
        << G::name() << " " << Tau::name() << " s = " << s;
    EXPECT_LE((momentum - mu).norm(), bound) << G::name() << " " << Tau::name() << " s = " << s;
  }
}

TEST(DiscreteMechanics, LiftOnSO3) {
  expect_same_steps<Exp<SO3>, 1>();
  expect_same_steps<Cayley<SO3>, 1>();
  expect_same_steps<SecondKind<SO3>, 1>();
}
TEST(DiscreteMechanics, LiftOnSE2) {
  expect_same_steps<Exp<SE2>, 1>();
  expect_same_steps<Cayley<SE2>, 1>();
  expect_same_steps<SecondKind<SE2>, 1>();
}

}  // namespace
