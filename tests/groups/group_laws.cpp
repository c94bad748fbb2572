// Every registered group obeys the group axioms (framework/check/group_laws.hpp, where the bounds
// are): by type, and by name as a run sees it, products put together at run time included.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <set>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "all_groups.hpp"

namespace {

using namespace hamel;

template <class G>
void expect_laws() {
  for (const unsigned seed : {1u, 2u, 3u}) {
    for (const LawResult& law : check_group<G>(seed)) {
      EXPECT_TRUE(law.passed()) << G::name() << ": " << law;
    }
  }
}

TEST(GroupLaws, HoldByType) {
  test::AllGroups::for_each([]<class G>(std::type_identity<G>) { expect_laws<G>(); });
  expect_laws<Product<SO3, Rn<2>>>();
  expect_laws<Product<SE2, SO2, SO2>>();
}

TEST(GroupLaws, HoldByName) {
  std::vector<std::string> names = registry().groups();
  names.insert(names.end(), {"so3*r2", "se2*so2^3", "heisenberg*se3", "r6", "so3*r4"});
  for (const std::string& name : names) {
    for (const unsigned seed : {1u, 2u, 3u}) {
      for (const LawResult& law : check_group(registry(), name, seed)) {
        EXPECT_TRUE(law.passed()) << name << ": " << law;
      }
    }
  }
}

// A group may leave its rates to differences; those of the library state them.
TEST(GroupLaws, EveryGroupOfTheLibraryStatesItsRates) {
  for (const char* name : {"heisenberg", "r1", "r2", "r3", "se2", "se2*so2", "se3", "so2", "so3"}) {
    const LawReport report = check_group(registry(), name);
    const auto rates = [](const LawResult& law) { return law.law.find("C(g) xi") != law.law.npos; };
    EXPECT_EQ(std::count_if(report.begin(), report.end(), rates), 2) << name;
  }
}

// The bytes of an element that is made on memory filled with one byte.
template <class G>
std::vector<double> element_on(unsigned char filling) {
  using Element = typename G::template Element<double>;
  const Vec<G::dim> xi = Vec<G::dim>::LinSpaced(0.3, 0.7);
  alignas(Element) std::array<unsigned char, sizeof(Element)> memory;
  memory.fill(filling);
  const auto* g = new (memory.data()) Element(Exp<G>::tau(xi));
  std::vector<double> out(static_cast<size_t>(Packing<G>::size));
  Packing<G>::store(*g, out.data());
  return out;
}

/// Elements are compared and written to files by their bytes (Packing): one that is unused has no
/// value (valgrind: a jump that depends on it), and the files of two equal runs differ by it.
TEST(GroupLaws, NoByteOfAnElementIsUnused) {
  const auto expect = []<class G>(std::type_identity<G>) {
    const auto one = element_on<G>(0x55), other = element_on<G>(0xaa);
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(double)), 0) << G::name();
  };
  test::AllGroups::for_each(expect);
  expect(std::type_identity<Product<SE2, SO2, Rn<3>>>());
}

/// What is registered is in the list of types, with the retractions of the type.
TEST(Groups, AreThoseOfTheRegistry) {
  using Pair = std::pair<std::string, std::string>;
  std::set<Pair> typed, named;
  test::AllGroups::for_each([&]<class G>(std::type_identity<G>) {
    RetractionsOf<G>::type::for_each([&]<class R>(std::type_identity<R>) {
      typed.insert({G::name(), R::name()});
    });
  });
  for (const std::string& group : registry().groups()) {
    for (const std::string& retraction : registry().retractions(group)) {
      named.insert({group, retraction});
      EXPECT_TRUE(typed.contains({group, retraction}))
          << group << ", " << retraction << ": add the group to tests/groups/all_groups.hpp";
    }
  }
  EXPECT_GE(named.size(), 29u);
}

TEST(Groups, HaveTheNamesOfTheRegistry) {
  EXPECT_EQ(SO2::name(), "so2");
  EXPECT_EQ(Rn<2>::name(), "r2");
  EXPECT_EQ((Product<SE2, SO2, Rn<1>>::name()), "se2*so2*r1");
  EXPECT_EQ((Product<SE2, SO2>::columns()),
            (std::vector<std::string>{"1_theta", "x", "y", "2_theta"}));
}

/// The laws must be able to fail: each group has one mistake.
struct WrongAd : SE2 {
  static Mat<3, 3> Ad(const SE2::Element<double>& g) { return SE2::Ad(SE2::inverse(g)); }
};
struct WrongCoad : SO3 {
  static Mat<3, 3> coad(const Vec<3>& mu) { return -SO3::coad(mu); }
};
struct WrongInverse : SO2 {
  static auto inverse(const SO2::Element<double>& g) { return SO2::compose(g, g); }
};
struct WrongRates : SE2 {  // v2 to the right
  static void coordinate_rates(std::span<const double> x, std::span<const double> xi,
                               std::span<double> out) {
    const double mirrored[] = {xi[0], xi[1], -xi[2]};
    SE2::coordinate_rates(x, mirrored, out);
  }
};
template <class G, class R>
struct OnGroup : R {  // R, as a retraction of G
  using Group = G;
};
int failures(const LawReport& report) {
  int out = 0;
  for (const LawResult& law : report) out += law.passed() ? 0 : 1;
  return out;
}
TEST(GroupLaws, SeePlantedMistakes) {
  EXPECT_GE((failures(check_group<WrongAd, OnGroup<WrongAd, Exp<SE2>>>())), 3);
  EXPECT_GE((failures(check_group<WrongCoad, OnGroup<WrongCoad, Exp<SO3>>>())), 2);
  EXPECT_GE((failures(check_group<WrongInverse, OnGroup<WrongInverse, Exp<SO2>>>())), 2);
  EXPECT_GE((failures(check_group<WrongRates, OnGroup<WrongRates, Exp<SE2>>>())), 2);
  EXPECT_THROW(check_group(registry(), "so4"), ConfigError);
}

}  // namespace
