// AutoRetraction: a map given by tau alone equals the same map with closed forms; and a user's own
// group (Heisenberg) with a retraction, complete in 30 lines, obeys every law.
#include <gtest/gtest.h>

#include <hamel/framework/check/retraction_laws.hpp>
#include <hamel/framework/lie/autodiff.hpp>
#include <hamel/framework/lie/group_defaults.hpp>
#include <hamel/groups/second_kind.hpp>

namespace {

using namespace hamel;

// ---- A group and its retraction, as a user writes them (also in groups/README.md). ----
struct Heisenberg : GroupDefaults<Heisenberg, 3> {
  static std::string name() { return "my_heisenberg"; }
  template <class T>
  using Element = VecT<T, 3>;
  template <class T = double>
  static VecT<T, 3> identity() {
    return VecT<T, 3>::Zero();
  }
  template <class T>
  static VecT<T, 3> compose(const VecT<T, 3>& g, const VecT<T, 3>& h) {
    return {g[0] + h[0], g[1] + h[1], g[2] + h[2] + 0.5 * (g[0] * h[1] - g[1] * h[0])};
  }
  template <class T>
  static VecT<T, 3> inverse(const VecT<T, 3>& g) {
    return -g;
  }
  template <class T>
  static MatT<T, 3, 3> ad(const VecT<T, 3>& xi) {
    return MatT<T, 3, 3>{
        {T(0.0), T(0.0), T(0.0)}, {T(0.0), T(0.0), T(0.0)}, {-xi[1], xi[0], T(0.0)}};
  }
  template <class T>
  static MatT<T, 3, 3> Ad(const VecT<T, 3>& g) {
    return MatT<T, 3, 3>::Identity() + ad(g);
  }
};
struct HeisenbergExp : AutoRetraction<HeisenbergExp, Heisenberg> {
  static std::string name() { return "exp"; }
  static constexpr bool symmetric = true, one_parameter = true;
  template <class T>
  static VecT<T, 3> tau(const VecT<T, 3>& xi) {
    return xi;
  }
};
// ---- end ----

TEST(OwnGroup, ObeysTheLaws) {
  static_assert(Group<Heisenberg> && Retraction<HeisenbergExp>);
  for (const LawResult& law : check_group<Heisenberg, HeisenbergExp>(1)) {
    EXPECT_TRUE(law.passed()) << law;
  }
  for (const LawResult& law : check_retraction<HeisenbergExp>(1)) EXPECT_TRUE(law.passed()) << law;
}

/// A non-symmetric map on SO(3), by automatic differentiation: Rx Ry Rz from tau alone.
struct EulerAngles : AutoRetraction<EulerAngles, SO3> {
  static std::string name() { return "euler_angles"; }
  static constexpr bool symmetric = false;
  template <class T>
  static MatT<T, 3, 3> tau(const VecT<T, 3>& xi) {
    return SecondKind<SO3>::tau(xi);
  }
  template <class T>
  static bool in_domain(const VecT<T, 3>& xi) {
    return SecondKind<SO3>::in_domain(VecT<T, 3>(2.0 * xi));
  }
};

TEST(AutoRetraction, ObeysTheLaws) {
  for (const LawResult& law : check_retraction<EulerAngles>(1)) EXPECT_TRUE(law.passed()) << law;
}

/// Jets are exact, so only round-off separates the two; Newton's derivative carries that of its
/// differences, 1e-12.
TEST(AutoRetraction, EqualsTheClosedForms) {
  std::mt19937_64 random(4);
  using Closed = SecondKind<SO3>;
  for (const double size : {1e-9, 0.1, 0.7, 1.2}) {
    const Vec<3> xi = check::random_vector<3>(random, size), p = check::random_vector<3>(random);
    EXPECT_LT((EulerAngles::dtau_right(xi) - Closed::dtau_right(xi)).norm(), 1e-14);
    EXPECT_LT((EulerAngles::dtau_left_inverse(xi) - Closed::dtau_left_inverse(xi)).norm(), 1e-13);
    EXPECT_LT((EulerAngles::dtau_right_inverse_transpose_derivative(xi, p) -
               Closed::dtau_right_inverse_transpose_derivative(xi, p))
                  .norm(),
              1e-10);
    EXPECT_LT((EulerAngles::tau_inverse(Closed::tau(xi)) - xi).norm(), 1e-14);
  }
}

/// tau reaches rotations by less than about 1 rad only: Newton must report it instead of returning
/// a value.
struct Bounded : AutoRetraction<Bounded, SO2> {
  static std::string name() { return "bounded"; }
  template <class T>
  static SO2Element<T> tau(const VecT<T, 1>& xi) {
    using std::atan;
    return SO2::from_angle(T(0.5 * atan(T(2.0 * xi[0]))));  // |angle| < pi/4
  }
};
TEST(AutoRetraction, InverseOutsideTheRangeIsADomainError) {
  EXPECT_NEAR(Bounded::tau_inverse(SO2::from_angle(0.5))[0], std::tan(1.0) / 2, 1e-14);
  EXPECT_THROW((void)Bounded::tau_inverse(SO2::from_angle(1.5)), DomainError);
}

}  // namespace
