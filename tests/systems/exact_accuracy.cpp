// Exact motions in closed form where a rate in their denominators goes to zero, against 80 digits
// of the textbook formulas, which divide by it.
//
// Bound: 1e-14 of the size of the motion, a few units of round-off for each of the dozen
// operations.
#include <gtest/gtest.h>

#include <mpreal.h>

#include <cmath>

#include <hamel/groups/exp.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/product_retraction.hpp>
#include <hamel/systems/ball_on_turntable.hpp>
#include <hamel/systems/knife_edge_on_incline.hpp>
#include <hamel/systems/nonholonomic_particle.hpp>

namespace {

using namespace hamel;
using mpfr::mpreal;

constexpr double bound = 1e-14;
const std::vector<double> times = {-7, 0.01, 1, 13};

// 0 and 1e-12 to 10, of both signs.
std::vector<double> rates() {
  std::vector<double> out = {0, 5e-324, 1e-200};
  for (double rate = 1e-12; rate < 11; rate *= std::sqrt(10)) {
    out.push_back(rate);
    out.push_back(-1.7 * rate);
  }
  return out;
}
// The textbook formulas have no value at 0; 1e-30 is 0 to more digits than a double has.
mpreal rate_of(double rate) { return mpreal(std::abs(rate) < 1e-30 ? 1e-30 : rate); }

class ExactAccuracy : public testing::Test {
 protected:
  ExactAccuracy() { mpreal::set_default_prec(mpfr::digits2bits(120)); }
  static double error(double value, const mpreal& exact, double size) {
    return mpreal(abs(value - exact)).toDouble() / size;
  }
};

/// x0 + [c sin + a sin^2/(2 w)]/w |, y0 + [-c cos + a (theta/2 - sin(2 theta)/4)/w]/w |.
TEST_F(ExactAccuracy, KnifeEdgeAtEveryTurningRate) {
  const KnifeEdgeOnIncline system;
  const mpreal a = system.gravity * std::sin(system.slope);
  for (const double theta0 : {0.0, 0.7, 2.5}) {
    const KnifeEdgeOnIncline::Element start{SO2::from_angle(theta0), {0.2, -0.3}};
    for (const double w0 : rates()) {
      const auto flow = system.exact(start, Vec<3>(w0, 1.3, 0));
      const mpreal w = rate_of(w0), angle0 = start.angle();
      const mpreal c = mpreal(1.3) - a * sin(angle0) / w;
      for (const double t : times) {
        const auto [g, xi] = flow(t);
        const mpreal angle = angle0 + w * t;
        const auto x = [&](const mpreal& at) {
          const mpreal s = sin(at);
          return mpreal((c * s + a * s * s / (2 * w)) / w);
        };
        const auto y = [&](const mpreal& at) {
          return mpreal((-c * cos(at) + a * (at / 2 - sin(2 * at) / 4) / w) / w);
        };
        const double size = 1 + std::abs(t) + 1.5 * t * t + std::abs(w0 * t);
        EXPECT_LT(error(g.translation[0], 0.2 + x(angle) - x(angle0), size), bound)
            << w0 << " " << t;
        EXPECT_LT(error(g.translation[1], -0.3 + y(angle) - y(angle0), size), bound)
            << w0 << " " << t;
        EXPECT_LT(error(xi[1], c + a * sin(angle) / w, 1 + 3 * std::abs(t) + std::abs(w0 * t)),
                  bound)
            << w0 << " " << t;
      }
    }
  }
}

/// x0 + (c/v) asinh(y) |, z0 + (c/v) sqrt(1 + y^2) |.
TEST_F(ExactAccuracy, ParticleAtEverySpeed) {
  const NonholonomicParticle system;
  for (const double y0 : {0.0, 0.5, -3.0, 1000.0}) {
    for (const double v0 : rates()) {
      const auto flow = system.exact(Vec<3>(0.1, y0, 0.2), Vec<3>(1.3, v0, 1.3 * y0));
      const mpreal v = rate_of(v0), c = mpreal(1.3) * sqrt(1 + mpreal(y0) * y0);
      for (const double t : times) {
        const auto [g, xi] = flow(t);
        const mpreal y = y0 + v * t;
        const mpreal x = mpreal(0.1) + c / v * (asinh(y) - asinh(mpreal(y0)));
        const mpreal z = mpreal(0.2) + c / v * (sqrt(1 + y * y) - sqrt(1 + mpreal(y0) * y0));
        const double along = c.toDouble() * std::abs(t);
        EXPECT_LT(error(g[0], x, 1 + along / std::hypot(1, std::min(std::abs(y0), 1.0))), bound)
            << y0 << " " << v0 << " " << t;
        EXPECT_LT(error(g[2], z, 1 + along), bound) << y0 << " " << v0 << " " << t;
        EXPECT_LT(error(xi[0], c / sqrt(1 + y * y), c.toDouble()), bound) << v0 << " " << t;
      }
    }
  }
}

/// x_c + R(k t) (x0 - x_c), x' = k e_z x (x - x_c).
TEST_F(ExactAccuracy, BallAtEveryRateOfTheTable) {
  for (const double rate : rates()) {
    BallOnTurntable system;
    system.table_rate = rate;
    const BallOnTurntable::Centre centre{{0.8, 0.1}, {1.1, -0.4},   rate * 2 / 7,
                                         rate,       system.radius, 0};
    const mpreal k = rate_of(centre.k);
    for (const double t : times) {
      const Vec<2> at = centre.position(t);
      const mpreal vx = cos(k * t) * 1.1 + sin(k * t) * 0.4,
                   vy = sin(k * t) * 1.1 - cos(k * t) * 0.4;
      const double size = 1 + 1.2 * std::abs(t) * (1 + std::abs(rate));
      EXPECT_LT(error(at[0], mpreal(0.8) + (vy + 0.4) / k, size), bound) << rate << " " << t;
      EXPECT_LT(error(at[1], mpreal(0.1) - (vx - 1.1) / k, size), bound) << rate << " " << t;
    }
  }
}

}  // namespace
