// Identities between runs: tau_s of polar at s = 1/2 is Cayley, exp does not depend on s, the named
// and the typed path agree, and a run with a fixed m agrees with one with m chosen at run time.
#include <gtest/gtest.h>

#include <string>

#include <hamel/groups/cayley.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/so3.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/simulate_typed.hpp>
#include <hamel/systems/suslov.hpp>

#include "bodies.hpp"

namespace {

using namespace hamel;

/// max over the rows of |coordinates| and |velocity| differences after 200 steps of 0.05.
double apart(Simulation a, Simulation b) {
  a.step(0.05).until(10).solver("newton", {.tolerance = 1e-15});
  b.step(0.05).until(10).solver("newton", {.tolerance = 1e-15});
  const Result x = a.run(), y = b.run();
  EXPECT_TRUE(x.status.ok && y.status.ok) << x.status.reason << y.status.reason;
  double worst = 0;
  const size_t columns =
      1 + x.system->group.columns.size() + static_cast<size_t>(x.system->group.dim);
  for (size_t i = 0; i < x.trajectory.rows(); ++i) {
    for (size_t j = 0; j < columns; ++j) {
      worst = std::max(worst, std::abs(x.trajectory.at(i, j) - y.trajectory.at(i, j)));
    }
  }
  return worst;
}
/// 200 steps with a few eps of round-off each, on a bounded or contracting motion.
constexpr double bound = 2e-12;
/// boxed_literal turns by v, not by h v, in each step: an error of the start grows 80-fold in
/// these 200 steps, 7-fold with the other schemes.
constexpr double bound_of_literal = 10 * bound;

Suslov full() {
  Suslov body;
  body.moments = {2, .3, .5, 3, .4, 4};
  return body;
}

TEST(Identities, PolarAtOneHalfIsCayleyAtZero) {
  const Start start{.configuration = {}, .velocity = {1, 0.5, 0}, .momentum = {}};
  const Simulation polar = simulate(full()).start(start).retraction("polar").s(0.5);
  EXPECT_LE(apart(polar, simulate(full()).start(start).retraction("cayley").s(0)), bound);
  // They are two maps: at another s they differ by the O(h^2) of their steps.
  EXPECT_GE(apart(polar, simulate(full()).start(start).retraction("cayley").s(0.5)), 1e-5);
}

/// Exp without the flag one_parameter: lift takes the general path.
template <class G>
struct GeneralExp : Exp<G> {
  static constexpr bool one_parameter = false;
};

template <class S>
void expect_independent_of_s(const S& system) {
  const Simulation reference = simulate<Lift, Exp>(system).s(0);
  for (const double s : {0.1, 0.25, 0.5, 0.8, 1.0}) {
    EXPECT_LE(apart(reference, simulate<Lift, Exp>(system).s(s)), bound) << "short cut, s = " << s;
    EXPECT_LE(apart(reference, simulate<Lift, GeneralExp>(system).s(s)), bound)
        << "general, s = " << s;
  }
}
TEST(Identities, ExpIsIndependentOfSOnSO3) { expect_independent_of_s(full()); }
TEST(Identities, ExpIsIndependentOfSOnSE2) { expect_independent_of_s(ChaplyginSleigh{}); }

TEST(Identities, TypedAndNamedPathsAgree) {
  EXPECT_LE(apart(simulate<Lift, Cayley>(full()), simulate(full())), 1e-14);
  EXPECT_LE(apart(simulate<Balance, Exp>(ChaplyginSleigh{}),
                  simulate("chaplygin_sleigh").scheme("balance").retraction("exp")),
            1e-14);
}

/// What is compiled for a problem's types and the erased kernel of the same scheme.
TEST(Identities, CompiledAndErasedProblemsAgree) {
  for (const char* scheme : {"lift", "balance", "boxed", "boxed_literal", "unadapted", "rkmk4"}) {
    for (const char* retraction : {"cayley", "exp"}) {
      const Simulation erased(registry(), "suslov",
                              OwnSystem{.make = maker(full()),
                                        .kernel = registry().scheme(scheme)->erased,
                                        .scheme = *registry().scheme(scheme),
                                        .retraction = *registry().retraction("so3", retraction)});
      EXPECT_LE(apart(erased, simulate(full()).retraction(retraction).scheme(scheme)),
                std::string(scheme) == "boxed_literal" ? bound_of_literal : bound)
          << scheme << ", " << retraction;
    }
  }
}

/// Lift and unadapted are one integrator on the free body.
TEST(Identities, UnadaptedIsLiftOnTheFreeBody) {
  for (const char* retraction : {"exp", "cayley", "second_kind"}) {
    EXPECT_LE(apart(simulate(test::FreeBody<SO3>{}).scheme("unadapted").retraction(retraction),
                    simulate(test::FreeBody<SO3>{}).scheme("lift").retraction(retraction)),
              bound)
        << retraction;
  }
}

/// The motion does not depend on the configuration at the start.
TEST(Identities, LeftInvariance) {
  const Mat<3, 3> r = Exp<SO3>::tau(Vec<3>(0.3, -1.1, 0.7));
  Start turned;
  turned.configuration = SO3::coordinates(r);
  const Result moved = simulate(full()).start(turned).until(5).run(),
               plain = simulate(full()).until(5).run();
  const Mat<3, 3> end = SO3::from_coordinates(moved.last.coordinates),
                  reference = SO3::from_coordinates(plain.last.coordinates);
  EXPECT_LE((end - r * reference).norm(), 1e-12);
  EXPECT_EQ(moved.last.velocity, plain.last.velocity);
}

}  // namespace
