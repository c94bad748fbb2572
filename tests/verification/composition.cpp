// Every composition table reaches its order on Suslov with full inertia, with lift and with balance
// at s = 1/2, exp and cayley; its coefficients are symmetric and sum to one.
#include <gtest/gtest.h>

#include <hamel/framework/schemes/composition.hpp>

#include "cases.hpp"

namespace {

using namespace hamel;
using namespace hamel::verification;

TEST(Composition, CoefficientsAreSymmetricAndSumToOne) {
  for (const Composition& c : compositions()) {
    double sum = 0;
    for (size_t i = 0; i < c.coefficients.size(); ++i) {
      sum += c.coefficients[i];
      EXPECT_EQ(c.coefficients[i], c.coefficients[c.coefficients.size() - 1 - i]) << c.name;
    }
    EXPECT_NEAR(sum, 1, 2e-15) << c.name;
    // The next moments vanish: sum c^3 = 0 from order 4 on, sum c^5 = 0 from order 6, sum c^7
    // from 8.
    for (int power = 3; power < c.order; power += 2) {
      double moment = 0, size = 0;
      for (const double x : c.coefficients) {
        moment += std::pow(x, power);
        size += std::abs(std::pow(x, power));
      }
      EXPECT_NEAR(moment / size, 0, 1e-14) << c.name << " sum of powers " << power;
    }
  }
}

/// The finest pair must lie above the floor of the accumulated solves (1e-12) and in the asymptotic
/// regime: steps 0.2/0.1 for order 4, larger for 6 and 8. 0.05 for order 4, and 0.15 and 0.3 of the
/// order for 6 and 8, whose asymptotic window is one halving wide.
struct Window {
  double step;
  int halvings;
  double tolerance;
};
Window window(int order) {
  switch (order) {
    case 2: return {0.05, 3, 0.05};
    case 4: return {0.1, 3, 0.05};
    case 6: return {0.2, 2, 0.15};
    default: return {0.4, 1, 0.4};
  }
}

TEST(Composition, ReachesItsOrder) {
  for (const Composition& c : compositions()) {
    for (const std::string scheme : {"lift", "balance"}) {
      for (const std::string retraction : {"exp", "cayley"}) {
        SchemeCase base = motions()[0].base;
        base.scheme = scheme;
        base.retraction = retraction;
        Simulation simulation = simulation_of(registry(), base);
        simulation.compose(c.name).solver("newton", {.tolerance = 1e-15});
        const Window w = window(c.order);
        const OrderMeasurement m = measure_order(simulation, w.step, 2, w.halvings);
        std::string errors;
        for (const double e : m.configuration) errors += " " + std::to_string(std::log10(e));
        // The pair that counts is the finest above the floor.
        size_t last = m.configuration.size() - 1;
        while (last > 1 && m.configuration[last] < 1e-12) --last;
        const double order = std::log2(m.configuration[last - 1] / m.configuration[last]);
        EXPECT_NEAR(order, c.order, w.tolerance)
            << c.name << " " << scheme << " " << retraction << ", log10 of the errors:" << errors;
        EXPECT_GE(m.velocity_order(), c.order - w.tolerance)
            << c.name << " " << scheme << " " << retraction;
      }
    }
  }
}

/// At every s and with every symmetric retraction that commutes with itself, tau(a xi) tau(b xi) =
/// tau(b xi) tau(a xi), lift composes too (M30).
TEST(Composition, OfLiftAtEveryS) {
  for (const double s : {0.0, 0.25, 1.0}) {
    SchemeCase base = motions()[0].base;
    base.s = s;
    Simulation simulation = simulation_of(registry(), base);
    simulation.compose("suzuki4");
    EXPECT_NEAR(measure_order(simulation, 0.1, 2, 3).configuration_order(), 4, 0.05) << s;
  }
}

}  // namespace
