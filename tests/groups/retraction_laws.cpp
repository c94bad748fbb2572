// Every registered retraction of every registered group obeys the laws
// (framework/check/retraction_laws.hpp, where the bounds are): by type, Newton's derivative
// included, and by name as a run sees it.
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/framework/check/retraction_laws.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "all_groups.hpp"

namespace {

using namespace hamel;
using testing::HasSubstr;

template <class R>
void expect_laws() {
  for (const LawResult& law : check_retraction<R>(1)) {
    EXPECT_TRUE(law.passed()) << R::Group::name() << " " << R::name() << ": " << law;
  }
}

TEST(RetractionLaws, HoldByType) {
  test::AllGroups::for_each([]<class G>(std::type_identity<G>) {
    RetractionsOf<G>::type::for_each([]<class R>(std::type_identity<R>) { expect_laws<R>(); });
  });
  expect_laws<Cayley<Product<SO3, Rn<2>>>>();
  expect_laws<ProductRetraction<Exp<SE2>, Cayley<SO2>>>();
}

TEST(RetractionLaws, HoldByName) {
  std::vector<std::string> groups = registry().groups();
  groups.insert(groups.end(), {"so3*r2", "se2*so2^3", "heisenberg*se3", "r6", "so3*r4"});
  for (const std::string& group : groups) {
    for (const std::string& retraction : registry().retractions_or_common(group)) {
      for (const LawResult& law : check_retraction(registry(), group, retraction)) {
        EXPECT_TRUE(law.passed()) << group << " " << retraction << ": " << law;
      }
    }
  }
}

TEST(ProductRetractions, AreThoseOfAllFactors) {
  using Disk = Product<SE2, SO2>;
  static_assert(has_retraction<Disk, Exp<Disk>> && has_retraction<Disk, Cayley<Disk>>);
  static_assert(has_retraction<Disk, SecondKind<Disk>> && !has_retraction<Disk, Polar<Disk>>);
  using Pair = Product<SO3, SO3>;
  static_assert(has_retraction<Pair, Polar<Pair>>);
  EXPECT_EQ(Exp<Disk>::name(), "exp");
  EXPECT_EQ((ProductRetraction<Exp<SE2>, Cayley<SO2>>::name()), "exp*cayley");
  EXPECT_EQ(Exp<Disk>::domain(), "1: |omega| < pi; 2: all finite xi");
  static_assert(has_retraction<Disk, CayleyLiteral<Disk>> &&
                !has_retraction<Pair, CayleyLiteral<Pair>>);
  EXPECT_EQ(CayleyLiteral<Disk>::name(), "cayley_literal");
}

/// An angle of ten turns by any retraction but the literal one, by type and by name; the other
/// factors keep theirs.
TEST(ProductRetractions, AddOnCommutativeFactors) {
  const Vec<4> xi(0.3, 1, 2, 63);
  const auto turns = [&]<class R>(std::type_identity<R>) {
    const auto g = R::tau(xi);
    const bool literal = R::name() == "cayley_literal";
    EXPECT_NEAR(g.template part<1>().angle(), literal ? 2 * std::atan(31.5) : 63, 1e-13)
        << R::name();
    EXPECT_TRUE(R::in_domain(xi));
    if (!literal) {
      EXPECT_NEAR(R::tau_inverse(g)[3], 63, 1e-13) << R::name();
    }
    const auto geometry = registry().geometry("se2*so2^1", R::name());
    ASSERT_NE(geometry, nullptr) << R::name();
    std::vector<double> out(static_cast<size_t>(geometry->size())), coordinates(4);
    geometry->tau(xi.data(), out.data());
    geometry->coordinates(out.data(), coordinates.data());
    const auto typed = Product<SE2, SO2>::coordinates(g);
    for (size_t i = 0; i < 4; ++i) EXPECT_EQ(coordinates[i], typed.begin()[i]) << R::name();
  };
  Product<SE2, SO2>::Retractions::for_each(turns);
  EXPECT_NEAR(Cayley<SE2>::tau(Vec<3>(0.3, 1, 2)).rotation.angle(), 2 * std::atan(0.15), 1e-15);
  EXPECT_EQ(registry().geometry("so3^2", "cayley_literal"), nullptr);
}

/// The laws must be able to fail: each retraction has one mistake.
struct LeftForRight : Exp<SE2> {
  static Mat<3, 3> dtau_right(const Vec<3>& xi) { return Exp<SE2>::dtau_left(xi); }
};
struct WrongSlope : Cayley<SO3> {
  static Mat<3, 3> dtau_right_inverse_transpose_derivative(const Vec<3>& xi, const Vec<3>& p) {
    return 1.01 * Cayley<SO3>::dtau_right_inverse_transpose_derivative(xi, p);
  }
};
struct WrongInverse : Exp<SO3> {
  static Vec<3> tau_inverse(const Mat<3, 3>& g) { return (1 + 1e-10) * Exp<SO3>::tau_inverse(g); }
};
struct WrongFlag : SecondKind<SO3> {
  static constexpr bool symmetric = true;
};
struct TooLarge : SecondKind<SO3> {  // its inverse has |xi_2| < pi/2
  static bool in_domain(const Vec<3>& xi) { return xi.norm() < 3; }
};
/// tau is wrong by 1e-13: off the group; as one of another xi, with the right inverse and
/// derivatives, or with an inverse of its own.
struct OffTheGroup : Exp<SO3> {
  static Mat<3, 3> tau(const Vec<3>& xi) {
    Mat<3, 3> g = Exp<SO3>::tau(xi);
    g(0, 0) += 1e-13 * xi.squaredNorm();
    return g;
  }
};
struct OfAnother : Exp<SO3> {
  static Mat<3, 3> tau(const Vec<3>& xi) { return Exp<SO3>::tau(Vec<3>((1 + 1e-13) * xi)); }
};
struct OfAnotherWithItsInverse : OfAnother {
  static Vec<3> tau_inverse(const Mat<3, 3>& g) { return Exp<SO3>::tau_inverse(g) / (1 + 1e-13); }
};
struct Turned : Cayley<SE2> {
  static auto tau(const Vec<3>& xi) {
    const Vec<3> turn(1e-13 * xi.norm(), 0, 0);
    return SE2::compose(Cayley<SE2>::tau(xi), Cayley<SE2>::tau(turn));
  }
};
struct Modest : Cayley<SO3> {
  static constexpr bool symmetric = false;
};
std::string failing(const LawReport& report) {
  std::string out;
  for (const LawResult& law : report)
    if (!law.passed()) out += law.law + "; ";
  return out;
}
int failures(const LawReport& report) {
  int out = 0;
  for (const LawResult& law : report) out += law.passed() ? 0 : 1;
  return out;
}
TEST(RetractionLaws, NameATauThatIsWrongBy1em13) {
  EXPECT_THAT(failing(check_retraction<OffTheGroup>()), HasSubstr("tau(xi) is an element; "));
  EXPECT_THAT(failing(check_retraction<OfAnother>()), HasSubstr("tau^-1(tau(xi)) = xi "));
  EXPECT_THAT(failing(check_retraction<OfAnotherWithItsInverse>()),
              HasSubstr("dR tau = Ad(tau) dL tau; "));
  EXPECT_THAT(failing(check_retraction<Turned>()), HasSubstr("tau^-1(tau(xi)) = xi "));
}

/// The printed value is the measured one, with what was expected of it.
TEST(RetractionLaws, PrintWhatIsMeasured) {
  const auto printed = [](const LawReport& report) {
    std::ostringstream out;
    for (const LawResult& law : report) out << law << "\n";
    return out.str();
  };
  EXPECT_THAT(printed({{"a law", 1e-13, 1e-14}}),
              HasSubstr("FAILS  a law: 1e-13, expected at most 1e-14"));
  EXPECT_THAT(printed({{"yes", 0, 0}, {"no", 2, 0}}), "holds  yes\nFAILS  no: 2, expected 0\n");
  EXPECT_THAT(printed(check_retraction<WrongFlag>()),
              HasSubstr("flag symmetric is right: tau(-xi) = tau(xi)^-1: "));
  EXPECT_THAT(printed(check_retraction<Modest>()),
              testing::ContainsRegex("FAILS  flag symmetric .*: not claimed, and violated by "
                                     "[0-9.e-]+, expected more than 1e-09"));
}

TEST(RetractionLaws, SeePlantedMistakes) {
  EXPECT_GE(failures(check_retraction<LeftForRight>()), 2);
  EXPECT_EQ(failures(check_retraction<WrongSlope>()), 1);
  EXPECT_EQ(failures(check_retraction<WrongInverse>()), 2);  // steps are recovered by it, too
  EXPECT_EQ(failures(check_retraction<WrongFlag>()), 1);
  EXPECT_GE(failures(check_retraction<TooLarge>()), 1);
  EXPECT_THROW(check_retraction(registry(), "se3", "polar"), ConfigError);
}

}  // namespace
