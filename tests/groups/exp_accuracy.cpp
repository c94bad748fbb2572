// exp, log, dR exp, its inverse and the Newton derivative against 80 digits, |omega| from 1e-12 to
// pi - 1e-6.
//
// Bounds are in units of round-off u = 2^-52, twice what is measured (0.4 to 1.9, printed by the
// test). log is compared for the rotation rounded to double, so its condition (1 on SO(3)) is
// included.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/groups/exp.hpp>

#include "reference.hpp"

namespace {

using namespace hamel;
using namespace reference;

constexpr double u = 2.220446049250313e-16;

template <int N>
Big big_ad(const std::vector<mpreal>& xi) {  // ad on so(3), se(2), se(3), as stated in the headers
  Big m(N, N);
  const auto cross = [&](int row, int column, int from) {
    const auto& w = xi;
    const std::size_t f = static_cast<std::size_t>(from);
    m(row, column + 1) = -w[f + 2], m(row, column + 2) = w[f + 1];
    m(row + 1, column) = w[f + 2], m(row + 1, column + 2) = -w[f];
    m(row + 2, column) = -w[f + 1], m(row + 2, column + 1) = w[f];
  };
  if constexpr (N == 6) {
    cross(0, 0, 0), cross(3, 3, 0), cross(3, 0, 3);
  } else {
    cross(0, 0, 0);
  }
  return m;
}
Big big_ad_se2(const std::vector<mpreal>& xi) {
  Big m(3, 3);
  m(1, 0) = xi[2], m(1, 2) = -xi[0], m(2, 0) = -xi[1], m(2, 1) = xi[0];
  return m;
}
template <class G>
Big algebra_matrix(const std::vector<mpreal>& xi) {
  if constexpr (std::is_same_v<G, SE2>) {
    return big_ad_se2(xi);
  } else {
    return big_ad<G::dim>(xi);
  }
}
template <int N>
std::vector<mpreal> widen(const Vec<N>& xi) {
  return std::vector<mpreal>(xi.data(), xi.data() + N);
}

template <class G>
class ExpAccuracy : public testing::Test {};
using Groups = testing::Types<SO3, SE2, SE3>;
TYPED_TEST_SUITE(ExpAccuracy, Groups);

TYPED_TEST(ExpAccuracy, AgainstEightyDigits) {
  using G = TypeParam;
  using R = Exp<G>;
  constexpr int n = G::dim, turning = n == 6 ? 3 : (std::is_same_v<G, SE2> ? 1 : 3);
  use_80_digits();
  std::mt19937_64 random(11);
  double tau = 0, tangent = 0, forward = 0, inverse = 0, newton = 0, log = 0, stage = 0;
  for (const double theta :
       {1e-12, 1e-10, 1e-8, 1e-6,   1e-4,   1e-3, 1e-2, 0.1,  0.3,     0.4999,   0.5001,
        1.0,   1.7,   2.5,  2.8283, 2.8286, 3.0,  3.1,  3.14, 3.14159, 3.1415916}) {
    Vec<n> xi = check::random_vector<n>(random), p = check::random_vector<n>(random);
    xi.template head<turning>() *= theta / xi.template head<turning>().norm();
    if (theta < 0.05 && n != turning) xi.template tail<n - turning>() *= theta;
    const Big exact_tau = series(big(G::hat(xi)), 0);
    const auto g = R::tau(xi);
    tau = std::max(tau, error(G::matrix(g), exact_tau));
    // The part of size |xi| relative to |xi|: exp(xi) - exp(-xi) over 2 has no 1 to hide behind.
    const Big odd = add(exact_tau, series(big(G::hat(Vec<n>(-xi))), 0), mpreal(-1));
    const auto m = G::matrix(g);
    const auto m_back = G::matrix(R::tau(Vec<n>(-xi)));
    if (theta < 1) tangent = std::max(tangent, error((m - m_back).eval(), odd));

    const auto inverse_at = [](const std::vector<mpreal>& at) {
      return invert(series(algebra_matrix<G>(at), 1));
    };
    const std::vector<mpreal> wide = widen<n>(xi);
    const Big exact_inverse = inverse_at(wide);
    inverse = std::max(inverse, error(R::dtau_right_inverse(xi), exact_inverse));
    // What a stage of an explicit scheme evaluates: tau, and dL^-1 p, dL_xi = dR_{-xi}.
    Vec<n> rate;
    stage = std::max(stage, error(G::matrix(R::tau_with_rate(xi, p, rate)), exact_tau));
    const Big exact_rate = multiply(inverse_at(widen<n>(Vec<n>(-xi))), big(p));
    stage = std::max(stage, error(rate, exact_rate));
    stage = std::max(stage, error(R::dtau_left_inverse(xi, p), exact_rate));
    forward = std::max(forward, error(R::dtau_right(xi), invert(exact_inverse)));
    Big slope(n, n);
    const mpreal h("1e-25");  // central difference: truncation 1e-50, round-off 1e-55
    for (int j = 0; j < n; ++j) {
      auto up = wide, down = wide;
      up[static_cast<std::size_t>(j)] += h;
      down[static_cast<std::size_t>(j)] -= h;
      const Big change = add(inverse_at(up), inverse_at(down), mpreal(-1));
      const Big column = multiply(transpose(change), big(p));
      for (int i = 0; i < n; ++i) slope(i, j) = column(i, 0) / (2 * h);
    }
    newton = std::max(newton, error(R::dtau_right_inverse_transpose_derivative(xi, p), slope));
    // Round the exact element to double, take its logarithm.
    typename G::template Element<double> rounded = g;
    if constexpr (n == 6) {
      for (int i = 0; i < 9; ++i)
        rounded.rotation(i / 3, i % 3) = exact_tau(i / 3, i % 3).toDouble();
      for (int i = 0; i < 3; ++i) rounded.translation[i] = exact_tau(i, 3).toDouble();
    } else if constexpr (std::is_same_v<G, SE2>) {
      rounded.rotation = {exact_tau(0, 0).toDouble(), exact_tau(1, 0).toDouble(), 0};
      for (int i = 0; i < 2; ++i) rounded.translation[i] = exact_tau(i, 2).toDouble();
    } else {
      for (int i = 0; i < 9; ++i) rounded(i / 3, i % 3) = exact_tau(i / 3, i % 3).toDouble();
    }
    log = std::max(log, (R::tau_inverse(rounded) - xi).norm() / xi.norm());
  }
  std::printf(
      "%s exp, errors in units of 2^-52: tau %.1f, odd part %.1f, dR %.1f, dR^-1 %.1f, Newton "
      "%.1f, log %.1f, of a stage %.1f\n",
      G::name().c_str(), tau / u, tangent / u, forward / u, inverse / u, newton / u, log / u,
      stage / u);
  EXPECT_LT(tau, 4 * u);
  EXPECT_LT(tangent, 4 * u);
  EXPECT_LT(forward, 4 * u);
  EXPECT_LT(inverse, 4 * u);
  EXPECT_LT(newton, 4 * u);
  EXPECT_LT(log, 4 * u);
  EXPECT_LT(stage, 4 * u);
}

/// The coefficient functions alone, over the joints of their pieces.
TEST(Coefficients, AgainstEightyDigits) {
  use_80_digits();
  double worst[7] = {};
  for (double theta = 1e-8; theta < 3.1416; theta = theta < 0.4 ? theta * 1.5 : theta + 0.0137) {
    const double x = theta * theta;
    const mpreal X(x), t = sqrt(X), s = sin(t), c = cos(t);
    const mpreal gamma = t / 2 / tan(t / 2), cot = (1 - gamma) / X;
    const mpreal dcot = (mpreal(1) / 8 - gamma * cot / 2 - cot) / X;
    const mpreal d2cot =
        -(((gamma * cot / 2 - mpreal(1) / 8) * cot + gamma * dcot) / 2 + 2 * dcot) / X;
    const mpreal sine = s / t, cosine = (1 - c) / X, third = (t - s) / (X * t);
    const mpreal exact[7] = {sine, cosine, third, (sine - 2 * cosine) / (2 * X), cot, dcot, d2cot};
    const double values[7] = {sinc(x),
                              cosc(x),
                              sinc3(x),
                              cosc_derivative(x),
                              cotc(x),
                              cotc_derivative(x),
                              cotc_second_derivative(x)};
    for (int i = 0; i < 7; ++i) {
      const mpreal size = i == 0 ? mpreal(1) : abs(exact[i]);  // sinc vanishes at pi
      worst[i] = std::max(worst[i], (abs(values[i] - exact[i]) / size).toDouble());
    }
  }
  const double bounds[7] = {2, 3,  4, 6,
                            6, 16, 64};  // the derivatives of cotc cancel beyond theta = 2.83
  for (int i = 0; i < 7; ++i) {
    std::printf("coefficient %d: %.1f\n", i, worst[i] / u);
    EXPECT_LT(worst[i], bounds[i] * u) << i;
  }
}

TEST(Logarithm, RefusesAHalfTurnAndSaysSo) {
  const double pi = 3.14159265358979323846;
  try {
    (void)Exp<SO3>::tau_inverse(Mat<3, 3>(Vec<3>(1, -1, -1).asDiagonal()));
    FAIL();
  } catch (const DomainError& error) {
    EXPECT_NE(std::string(error.what()).find("3.14159"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("so3 exp^-1"), std::string::npos) << error.what();
  }
  EXPECT_THROW((void)Exp<SE2>::tau_inverse(Exp<SE2>::tau(Vec<3>(pi, 1, 2))), DomainError);
  EXPECT_NEAR(Exp<SO2>::tau_inverse(Exp<SO2>::tau(Vec<1>(-7 * pi)))[0], -7 * pi, 1e-14);
  const SE3Element<double> half_turn{Vec<3>(-1, 1, -1).asDiagonal(), Vec<3>(1, 2, 3)};
  EXPECT_THROW((void)Exp<SE3>::tau_inverse(half_turn), DomainError);
}

}  // namespace
