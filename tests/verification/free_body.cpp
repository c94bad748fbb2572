// Without constraints every scheme is an integrator of the free body, unadapted too: a symmetric
// top against its closed form,
//   R(t) = R0 exp(t L^/I1) exp(t (1 - I3/I1) w3 e3^),  L = I Omega0.
#include <gtest/gtest.h>

#include <hamel/framework/check/scheme_laws.hpp>
#include <hamel/framework/check/system_laws.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace {

using namespace hamel;

struct SymmetricTop {
  using Group = SO3;
  double transverse = 2, axial = 3.1;
  static std::string name() { return "symmetric_top"; }
  Mat<3, 3> inertia() const { return Vec<3>(transverse, transverse, axial).asDiagonal(); }
  Start start() const {
    return {.configuration = {}, .velocity = {0.9, -0.4, 0.7}, .momentum = {}};
  }
  auto exact(const SO3::Element<double>& r0, const Vec<3>& omega0) const {
    const Vec<3> first = inertia() * omega0 / transverse,
                 second(0, 0, (1 - axial / transverse) * omega0[2]);
    return [=](double t) {
      const Mat<3, 3> spin = Exp<SO3>::tau(Vec<3>(t * second));
      const Mat<3, 3> r = r0 * Exp<SO3>::tau(Vec<3>(t * first)) * spin;
      const Vec<3> omega = spin.transpose() * first + second;
      return std::pair{r, omega};
    };
  }
};

TEST(FreeBody, ExactMotionIsRight) {
  for (const LawResult& law : check_system<SymmetricTop, Exp<SO3>>(SymmetricTop{}))
    EXPECT_TRUE(law.passed()) << law;
}

TEST(FreeBody, EveryAdaptedOrUnadaptedSchemeHasItsOrder) {
  for (const char* scheme : {"lift", "unadapted", "balance", "boxed"}) {
    const SchemeInfo& info = *registry().scheme(scheme);
    for (const std::string& retraction : registry().retractions("so3")) {
      const bool symmetric = registry().retraction("so3", retraction)->symmetric;
      for (const double s : {0.0, 0.25, 0.5, 1.0}) {
        const ClaimedOrder claim = info.claim(s, symmetric, true);
        // A symmetric top is a special motion: orders are checked from below only.
        const Simulation run = simulate(SymmetricTop{}).scheme(scheme).s(s).retraction(retraction);
        const double step = claim.order == 1 ? 0.01 : 0.05;
        for (const LawResult& law : check_scheme(run, claim, info.adapted, step, 2, false)) {
          EXPECT_TRUE(law.passed())
              << scheme << ", " << retraction << ", s = " << s << "\n  " << law;
        }
      }
    }
  }
}

/// Unadapted has order 2 and no more.
TEST(FreeBody, UnadaptedHasOrderTwo) {
  for (const char* retraction : {"exp", "cayley", "polar"}) {
    Simulation run = simulate(SymmetricTop{}).scheme("unadapted").retraction(retraction);
    EXPECT_NEAR(measure_order(run, 0.05, 2).order(), 2, 0.05) << retraction;
  }
}

}  // namespace
