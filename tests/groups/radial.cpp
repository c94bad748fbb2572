// Radial retractions of SO(3): the polar map, and members given by their angle function alone.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <random>

#include <hamel/framework/check/retraction_laws.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/radial.hpp>

namespace {

using namespace hamel;

/// f = Order atan(theta/Order): 1 is polar, 2 is Cayley, 4 the modified Rodrigues map. phi(x) =
/// atan(u)/u, u^2 = y = x/Order^2, by its series near 0 and by y-derivatives of atan elsewhere.
template <int Order>
struct Arctangent : RadialSO3<Arctangent<Order>> {
  static std::string name() { return "arctangent" + std::to_string(Order); }
  template <class T>
  static RadialProfile<T> profile(const T& x) {
    constexpr double q = 1.0 / (Order * Order);
    const T y = q * x;
    T phi(0.0), d(0.0), d2(0.0);
    if (y < 0.1) {  // sum (-y)^k/(2k + 1): 0.1^24 is far below round-off
      for (int k = 24; k >= 0; --k) {
        const double a = (k % 2 == 0 ? 1.0 : -1.0) / (2 * k + 1);
        phi = phi * y + a;
        if (k >= 1) d = d * y + k * a;
        if (k >= 2) d2 = d2 * y + k * (k - 1) * a;
      }
    } else {
      const T r = 1.0 / (1.0 + y);
      phi = atanc(y);
      d = 0.5 * (r - phi) / y;
      d2 = -(0.5 * r * r + 1.5 * d) / y;
    }
    return {phi, q * d, q * q * d2};
  }
  template <class T>
  static T radius(const T& f) {
    using std::tan;
    return Order * tan(T(f * (1.0 / Order)));
  }
};

template <class R>
class RadialLaws : public testing::Test {};
using Retractions = testing::Types<Polar<SO3>, Arctangent<2>, Arctangent<4>>;
TYPED_TEST_SUITE(RadialLaws, Retractions);

TYPED_TEST(RadialLaws, Hold) {
  for (const LawResult& law : check_retraction<TypeParam>(1)) {
    EXPECT_TRUE(law.passed()) << TypeParam::name() << ": " << law;
  }
}

/// The base class, given the angle function, reproduces closed forms that are derived
/// independently. Measured 1e-15; the bound leaves room for the condition of dR^-1, which grows as
/// |xi|^2.
template <class General, class Closed>
void expect_same() {
  std::mt19937_64 random(5);
  for (const double size : {1e-9, 1e-3, 0.2, 0.31, 0.32, 0.33, 0.6, 0.7, 1.0, 2.0, 2.9}) {
    const Vec<3> xi = size * check::random_vector<3>(random).normalized();
    const Vec<3> p = check::random_vector<3>(random);
    EXPECT_LT((General::tau(xi) - Closed::tau(xi)).norm(), 2e-15) << size;
    EXPECT_LT((General::dtau_right_inverse(xi) - Closed::dtau_right_inverse(xi)).norm(),
              4e-15 * (1 + size * size));
    EXPECT_LT((General::dtau_right_inverse_transpose_derivative(xi, p) -
               Closed::dtau_right_inverse_transpose_derivative(xi, p))
                  .norm(),
              2e-14 * (1 + size * size))
        << size;
  }
}
TEST(Radial, Order1IsPolar) { expect_same<Arctangent<1>, Polar<SO3>>(); }
TEST(Radial, Order2IsCayley) { expect_same<Arctangent<2>, Cayley<SO3>>(); }

/// Polar is the rotation U V^T of the singular value decomposition of I + omega^.
TEST(Polar, IsTheOrthogonalPolarFactor) {
  std::mt19937_64 random(6);
  for (const double size : {1e-3, 0.5, 1.0, 3.0, 10.0}) {
    const Vec<3> xi = size * check::random_vector<3>(random).normalized();
    const Mat<3, 3> m = Mat<3, 3>::Identity() + cross_matrix(xi);
    const Eigen::JacobiSVD<Mat<3, 3>> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Mat<3, 3> rotation = svd.matrixU() * svd.matrixV().transpose();
    EXPECT_LT((Polar<SO3>::tau(xi) - rotation).norm(), 1e-14) << size;
  }
}

TEST(Polar, InverseRefusesAQuarterTurnAndMore) {
  const Mat<3, 3> quarter = Exp<SO3>::tau(Vec<3>(0, 0, 2.0));
  try {
    (void)Polar<SO3>::tau_inverse(quarter);
    FAIL() << "no DomainError";
  } catch (const DomainError& error) {
    EXPECT_NE(std::string(error.what()).find("2"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("pi/2"), std::string::npos) << error.what();
  }
}

}  // namespace
