// Cayley and polar maps against 80 digits: from |omega| = 1e-12 to rotations within 1e-6 of the
// edge of their range.
//
// Bounds in units of round-off u = 2^-52, about twice what is measured. The inverses are compared
// relative to their condition, |dL^-1|, which grows as |omega|^2 towards a rotation by pi (Cayley)
// or pi/2 (polar).
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/radial.hpp>

#include "reference.hpp"

namespace {

using namespace hamel;
using namespace reference;

constexpr double u = 2.220446049250313e-16;

template <class G>
class CayleyAccuracy : public testing::Test {};
using Groups = testing::Types<SO3, SE2, SE3>;
TYPED_TEST_SUITE(CayleyAccuracy, Groups);

TYPED_TEST(CayleyAccuracy, AgainstEightyDigits) {
  using G = TypeParam;
  using R = Cayley<G>;
  constexpr int n = G::dim, turning = std::is_same_v<G, SE2> ? 1 : 3;
  use_80_digits();
  std::mt19937_64 random(12);
  double tau = 0, inverse = 0, back = 0;
  for (const double size :
       {1e-12, 1e-9, 1e-6, 1e-3, 1e-2, 0.1, 0.5, 1.0, 2.0, 3.0, 10.0, 1e3, 1e5, 1e6}) {
    Vec<n> xi = check::random_vector<n>(random);
    xi.template head<turning>() *= size / xi.template head<turning>().norm();
    if (size < 0.05 && n != turning) xi.template tail<n - turning>() *= size;
    const Big hat = big(G::hat(xi)), one = identity(hat.rows);
    const Big minus = add(one, hat, mpreal(-0.5)), plus = add(one, hat, mpreal(0.5));
    const Big exact = multiply(invert(minus), plus);
    const auto g = R::tau(xi);
    tau = std::max(tau, error(G::matrix(g), exact));
    Big dR_inverse(n, n);  // column j: vee((I - hat/2) hat(e_j) (I + hat/2))
    for (int j = 0; j < n; ++j) {
      const Big m = multiply(multiply(minus, big(G::hat(Vec<n>(Vec<n>::Unit(j))))), plus);
      if constexpr (turning == 1) {
        dR_inverse(0, j) = m(1, 0), dR_inverse(1, j) = m(0, 2), dR_inverse(2, j) = m(1, 2);
      } else {
        dR_inverse(0, j) = m(2, 1), dR_inverse(1, j) = m(0, 2), dR_inverse(2, j) = m(1, 0);
        for (int i = 3; i < n; ++i) dR_inverse(i, j) = m(i - 3, 3);
      }
    }
    inverse = std::max(inverse, error(R::dtau_right_inverse(xi), dR_inverse));
    const double condition = 1 + R::dtau_left_inverse(xi).norm() / std::max(1.0, xi.norm());
    back = std::max(back, (R::tau_inverse(g) - xi).norm() / (xi.norm() * condition));
  }
  std::printf("%s cayley, errors in units of 2^-52: tau %.1f, dR^-1 %.1f, inverse/condition %.1f\n",
              G::name().c_str(), tau / u, inverse / u, back / u);
  EXPECT_LT(tau, 4 * u);
  EXPECT_LT(inverse, 4 * u);
  EXPECT_LT(back, 8 * u);
}

TEST(PolarAccuracy, AgainstEightyDigits) {
  use_80_digits();
  std::mt19937_64 random(13);
  double tau = 0, back = 0, inverse = 0;
  for (const double size : {1e-12, 1e-9, 1e-6, 1e-3, 1e-2, 0.1, 0.5, 1.0, 2.0, 10.0, 1e3, 1e6}) {
    const Vec<3> xi = size * check::random_vector<3>(random).normalized();
    // exp(atan(theta) n) from its series; atan(theta)/theta in 80 digits.
    const Big hat = big(SO3::hat(xi));
    mpreal x = 0;
    for (int i = 0; i < 3; ++i) x += mpreal(xi[i]) * mpreal(xi[i]);
    const mpreal theta = sqrt(x), ratio = atan(theta) / theta;
    Big scaled(3, 3);
    for (std::size_t i = 0; i < 9; ++i) scaled.a[i] = ratio * hat.a[i];
    const Mat<3, 3> g = Polar<SO3>::tau(xi);
    tau = std::max(tau, error(g, series(scaled, 0)));
    // dR^-1 = (1/f') n n^T + (theta/2) cot(f/2) (I - n n^T) - omega^/2.
    const mpreal alpha = theta / 2 / tan(atan(theta) / 2);
    Big exact(3, 3);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        exact(i, j) = (i == j ? alpha : mpreal(0)) - hat(i, j) / 2 +
                      (1 + x - alpha) * mpreal(xi[i]) * mpreal(xi[j]) / x;
      }
    }
    inverse = std::max(inverse, error(Polar<SO3>::dtau_right_inverse(xi), exact));
    back = std::max(back, (Polar<SO3>::tau_inverse(g) - xi).norm() / (size * (1 + size)));
  }
  std::printf("so3 polar, errors in units of 2^-52: tau %.1f, dR^-1 %.1f, inverse/condition %.1f\n",
              tau / u, inverse / u, back / u);
  EXPECT_LT(tau, 4 * u);
  EXPECT_LT(inverse, 4 * u);
  EXPECT_LT(back, 8 * u);
}

TEST(CayleyInverse, RefusesAHalfTurnAndSaysSo) {
  const Mat<3, 3> half_turn = Vec<3>(-1, -1, 1).asDiagonal();
  try {
    (void)Cayley<SO3>::tau_inverse(half_turn);
    FAIL();
  } catch (const DomainError& error) {
    EXPECT_NE(std::string(error.what()).find("so3 cayley^-1"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("3.14159"), std::string::npos) << error.what();
  }
  EXPECT_THROW((void)CayleyLiteral<SO2>::tau_inverse(SO2Element<double>{-1, 0, 0}), DomainError);
}

}  // namespace
