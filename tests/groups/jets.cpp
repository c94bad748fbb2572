// Automatic differentiation goes through every group and retraction: the Jet of tau is dR tau, the
// Jet of a composition is Ad. Bound 1e-14: the same formulas in double, differentiated exactly.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <random>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/product_retraction.hpp>
#include <hamel/groups/radial.hpp>
#include <hamel/groups/second_kind.hpp>

namespace {

using namespace hamel;

template <class R>
class Jets : public testing::Test {};
using Retractions = testing::Types<Exp<SO2>, Exp<SO3>, Exp<SE2>, Exp<SE3>, Cayley<SO3>, Cayley<SE3>,
                                   Polar<SO3>, SecondKindSymmetric<SE2>, Exp<Product<SE2, SO2>>>;
TYPED_TEST_SUITE(Jets, Retractions);

TYPED_TEST(Jets, PassThroughTauAndCompose) {
  using R = TypeParam;
  using G = typename R::Group;
  constexpr int n = G::dim;
  using Jet = ceres::Jet<double, n>;
  std::mt19937_64 random(3);
  for (const double size : {1e-6, 0.3, 0.9, 2.0}) {
    const Vec<n> xi = size * check::random_vector<n>(random);
    VecT<Jet, n> jet;
    for (int i = 0; i < n; ++i) jet[i] = Jet(xi[i], i);
    const auto moving = R::tau(jet);
    const auto fixed = R::tau(VecT<Jet, n>(xi.template cast<Jet>()));
    // tau(xi + d) tau(xi)^-1 = e + hat(dR d) + ...: its tau^-1 has the value 0 and the gradient dR.
    const auto back = G::compose(G::normalise(moving), G::inverse(fixed));
    const VecT<Jet, n> small = R::tau_inverse(back);
    const Mat<n, n> dR = R::dtau_right(xi);
    for (int i = 0; i < n; ++i) {
      EXPECT_NEAR(small[i].a, 0, 1e-14);
      EXPECT_LT((small[i].v.transpose() - dR.row(i)).norm(), 1e-14 * (1 + dR.norm())) << size;
    }
    EXPECT_LT(std::abs(G::coordinates(moving).front().a - G::coordinates(R::tau(xi)).front()),
              1e-14);
  }
}

}  // namespace
