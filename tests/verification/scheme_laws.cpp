// Every registered system x scheme x retraction x s obeys what its scheme claims
// (framework/check/scheme_laws.hpp, where the bounds are): order against the exact motion,
// reversal, constraint, group. Claims are read from the registry, so that a new scheme or
// retraction is measured without a line here.
#include <gtest/gtest.h>

#include <set>

#include "cases.hpp"

namespace {

using namespace hamel;
using namespace hamel::verification;

class SchemeLaws : public testing::TestWithParam<Motion> {};

TEST_P(SchemeLaws, Hold) {
  const Registry& all = registry();
  const std::string group = all.system(GetParam().base.system)->group.name;
  int measured = 0;
  for (const std::string& scheme : all.schemes()) {
    for (const std::string& retraction : all.retractions(group)) {
      for (const double s : values_of_s(*all.scheme(scheme))) {
        SchemeCase c = GetParam().base;
        c.scheme = scheme;
        c.retraction = retraction;
        c.s = s;
        // Order 1 shows within 0.1 from h = 0.01 on: at 0.05 the next term is a tenth of the first.
        const bool symmetric = all.retraction(group, retraction)->symmetric;
        if (all.scheme(scheme)->claim(s, symmetric, true).order == 1) c.step /= 5;
        // A steady motion leaves a baseline nothing to err on.
        const bool baseline = std::set<std::string>{"energy_preserving", "gni", "reversible",
                                                    "rk4_projected", "rkmk4"}
                                  .contains(scheme);
        if (baseline) c.generic = c.system != "rolling_disk";
        for (const LawResult& law : check_scheme(all, c)) {
          EXPECT_TRUE(law.passed()) << GetParam().name << ", " << scheme << ", " << retraction
                                    << ", s = " << s << "\n  " << law;
          ++measured;
        }
      }
    }
  }
  EXPECT_GT(measured, 100);
}

INSTANTIATE_TEST_SUITE_P(Motions, SchemeLaws, testing::ValuesIn(motions()), [](const auto& motion) {
  return "Motion" + std::to_string(motion.index);
});

/// The laws must be able to fail: a wrong claim is seen.
TEST(SchemeLaws, SeeAWrongClaim) {
  const SchemeCase c = motions()[0].base;
  Registry boastful = registry();
  SchemeInfo info = *boastful.scheme("boxed");
  info.claims = [](double, TauTraits, bool) { return ClaimedOrder{2, true}; };
  boastful.add(info);
  SchemeCase boxed = c;
  boxed.scheme = "boxed";
  int failed = 0;
  for (const LawResult& law : check_scheme(boastful, boxed)) failed += law.passed() ? 0 : 1;
  EXPECT_EQ(failed, 2) << "order and reversal";

  const Simulation unadapted = simulate("suslov").scheme("unadapted");
  failed = 0;
  for (const LawResult& law : check_scheme(unadapted, {2, true}, true, 0.05, 2)) {
    failed += law.passed() ? 0 : 1;
  }
  EXPECT_GE(failed, 2) << "constraint and order";
}

}  // namespace
