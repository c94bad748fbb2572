// Every system's exact() against an integration of Newton's equations with multipliers, written
// here from the physics and in other coordinates: rotation matrix and Cartesian positions, no
// group, no frame, no reduction. Gragg's extrapolated midpoint rule of order 16 is the integrator.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/rolling_disk.hpp>
#include <hamel/systems/suslov.hpp>

namespace {

using namespace hamel;
using Vector = Eigen::VectorXd;
using Motion = std::function<Vector(const Vector&)>;

/// One step of length h: modified midpoint with 2, 4, ..., 16 substeps, extrapolated (Hairer,
/// Norsett, Wanner, Solving Ordinary Differential Equations I, section II.9).
Vector extrapolated_step(const Motion& f, const Vector& y, double h) {
  std::vector<Vector> above, row;
  for (int j = 1; j <= 8; ++j) {
    const int n = 2 * j;
    const double d = h / n;
    Vector a = y, b = y + d * f(y);
    for (int i = 1; i < n; ++i) {
      const Vector c = a + 2 * d * f(b);
      a = b;
      b = c;
    }
    row = {Vector(0.5 * (a + b + d * f(b)))};
    for (int k = 1; k < j; ++k) {
      const double ratio = static_cast<double>(j) / (j - k);
      const Vector next =
          row.back() + (row.back() - above[static_cast<size_t>(k - 1)]) / (ratio * ratio - 1);
      row.push_back(next);
    }
    above = row;
  }
  return row.back();
}

/// The integrator itself: y' = (y2, -y1) is a rotation.
TEST(Reference, IntegratorIsAccurate) {
  const Motion circle = [](const Vector& y) -> Vector { return Vector{{y[1], -y[0]}}; };
  Vector y{{1.0, 0.0}};
  for (int i = 0; i < 100; ++i) y = extrapolated_step(circle, y, 0.05);
  EXPECT_NEAR(y[0], std::cos(5.0), 1e-12);   // round-off of the extrapolation: 2e-15 a step
  EXPECT_NEAR(y[1], -std::sin(5.0), 1e-12);  // round-off of the extrapolation: 2e-15 a step
}

/// Steps of 0.05 with rates up to 3: local error (0.15/16)^16, so round-off, 1e-15 a step, grown by
/// the motion. exact() promises 1e-9; 1e-12 is measured.
constexpr double bound = 1e-9;
constexpr int steps = 100;
constexpr double h = 0.05;

/// compare(reference state, coordinates of g, xi) -> error.
template <class S, class Compare>
void expect_agreement(const S& system, const Start& start, const Motion& f, const Vector& y0,
                      Compare&& compare, const std::string& what) {
  const SystemModel model = erase(system);
  for (const double sign : {1.0, -1.0}) {
    const ExactFlow flow = model.exact(start);
    Vector y = y0;
    double worst = 0;
    for (int k = 0; k <= steps; ++k) {
      const auto [g, xi] = flow(sign * k * h);
      worst = std::max(worst, compare(y, g, xi));
      y = extrapolated_step(f, y, sign * h);
    }
    EXPECT_LE(worst, bound) << what << (sign > 0 ? " forwards" : " backwards");
  }
}

double difference(const Vector& a, const std::vector<double>& b) {
  return (a - Eigen::Map<const Vector>(b.data(), static_cast<Eigen::Index>(b.size()))).norm();
}

/// y = (R row by row, Omega): I Omega' = I Omega x Omega + lambda n, R' = R Omega^.
void suslov(const std::vector<double>& moments, Vec<3> normal, Vec<3> omega) {
  Suslov body;
  body.moments = moments;
  body.normal = normal;
  normal.normalize();
  omega -= normal.dot(omega) * normal;
  const Mat<3, 3> inertia = body.inertia(), inverse = inertia.inverse();
  const Motion f = [=](const Vector& y) -> Vector {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> r(y.data());
    const Vec<3> w = y.tail<3>(), gyro = Vec<3>(inertia * w).cross(w);
    const double lambda = -normal.dot(inverse * gyro) / normal.dot(inverse * normal);
    Vector out(12);
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> r_dot(out.data());
    for (int i = 0; i < 3; ++i) r_dot.row(i) = r.row(i).transpose().cross(w).transpose();
    out.tail<3>() = inverse * (gyro + lambda * normal);
    return out;
  };
  const Mat<3, 3> r0 = Eigen::AngleAxisd(0.7, Vec<3>(1, -2, 0.5).normalized()).toRotationMatrix();
  Vector y0(12);
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(y0.data()) = r0;
  y0.tail<3>() = omega;
  const Start start{.configuration = SO3::coordinates(r0),
                    .velocity = {omega.begin(), omega.end()},
                    .momentum = {}};
  expect_agreement(
      body, start, f, y0,
      [](const Vector& y, const std::vector<double>& g, const std::vector<double>& xi) {
        return difference(y.head(9), g) + difference(y.tail(3), xi);
      },
      "suslov");
}
TEST(Reference, SuslovFullInertia) { suslov({2, .3, .5, 3, .4, 4}, {0, 0, 1}, {1, 0.5, 0}); }
TEST(Reference, SuslovTheOtherSide) { suslov({2, .3, .5, 3, .4, 4}, {0, 0, 1}, {-1, 0.5, 0}); }
TEST(Reference, SuslovTiltedAxis) {
  suslov({2, .3, .5, 3, .4, 4}, {0.3, -0.5, 0.8}, {1, 0.9, -0.3});
}
TEST(Reference, SuslovDiagonal) { suslov({1, 10, 100}, {0, 0, 1}, {1, 0.1, 0}); }
TEST(Reference, SuslovDiagonalTilted) { suslov({1, 2, 3}, {1, 1, 1}, {1, -0.3, 0}); }
/// On the line p = k.Omega = 0, k = (0.5, 0.4), Omega is constant: an equilibrium of either
/// stability.
TEST(Reference, SuslovOnTheLine) { suslov({2, .3, .5, 3, .4, 4}, {0, 0, 1}, {0.8, -1, 0}); }
TEST(Reference, SuslovNearTheLine) {
  suslov({2, .3, .5, 3, .4, 4}, {0, 0, 1}, {0.8, -1 + 1e-7, 0});
}

/// y = (theta, X, Y of the mass centre, and their rates); blade force lambda across the blade.
void sleigh(double mass, double moment, double offset, Vec<3> xi0) {
  ChaplyginSleigh body{.mass = mass, .moment = moment, .offset = offset};
  const Motion f = [=](const Vector& y) -> Vector {
    const Vec<2> e1(std::cos(y[0]), std::sin(y[0])), e2(-e1[1], e1[0]), v(y[4], y[5]);
    const double lambda = y[3] * v.dot(e1) / (1 / mass + offset * offset / moment);
    Vector out(6);
    out << y[3], y[4], y[5], -offset * lambda / moment, lambda / mass * e2[0],
        lambda / mass * e2[1];
    return out;
  };
  const double theta = 0.4, x = -0.3, y = 0.8;
  const Vec<2> e1(std::cos(theta), std::sin(theta)), e2(-e1[1], e1[0]);
  const Vec<2> centre = Vec<2>(x, y) + offset * e1, v = xi0[1] * e1 + offset * xi0[0] * e2;
  Vector y0(6);
  y0 << theta, centre, xi0[0], v;
  const Start start{
      .configuration = {theta, x, y}, .velocity = {xi0.begin(), xi0.end()}, .momentum = {}};
  expect_agreement(
      body, start, f, y0,
      [=](const Vector& s, const std::vector<double>& g, const std::vector<double>& xi) {
        const Vec<2> a(std::cos(s[0]), std::sin(s[0])), rate(s[4], s[5]);
        const Vec<2> blade = Vec<2>(s[1], s[2]) - offset * a;
        return difference(Vector{{s[0], blade[0], blade[1]}}, g) +
               difference(Vector{{s[3], rate.dot(a), 0.0}}, xi);
      },
      "sleigh");
}
TEST(Reference, Sleigh) { sleigh(1, 0.1, 0.2, {0.9, -1, 0}); }
TEST(Reference, SleighForwards) { sleigh(2, 0.5, 0.6, {-1.3, 0.4, 0}); }
TEST(Reference, SleighBladeInFront) { sleigh(1, 0.3, -0.4, {0.9, 1, 0}); }
TEST(Reference, SleighWithoutOffset) { sleigh(1, 0.3, 0, {0.9, 1, 0}); }
TEST(Reference, SleighStraight) { sleigh(1, 0.3, 0.4, {0, 1, 0}); }

/// y = (theta, x, y, phi, and their rates); contact force lambda1 e1 + lambda2 e2.
TEST(Reference, RollingDisk) {
  RollingDisk body{.mass = 1.3, .radius = 0.4, .spin_inertia = 0.2, .yaw_inertia = 0.07};
  const Motion f = [=](const Vector& y) -> Vector {
    const Vec<2> e1(std::cos(y[0]), std::sin(y[0])), e2(-e1[1], e1[0]), v(y[5], y[6]);
    const double l1 =
        -y[4] * v.dot(e2) / (1 / body.mass + body.radius * body.radius / body.spin_inertia);
    const double l2 = body.mass * y[4] * v.dot(e1);
    const Vec<2> a = (l1 * e1 + l2 * e2) / body.mass;
    Vector out(8);
    out << y.tail<4>(), 0, a, -body.radius * l1 / body.spin_inertia;
    return out;
  };
  const double omega = -0.8, spin = 2.1;
  const Vec<2> v0 = body.radius * spin * Vec<2>(std::cos(0.3), std::sin(0.3));
  Vector y0(8);
  y0 << 0.3, 1.1, -0.2, 0.5, omega, v0, spin;
  const Start start{.configuration = {0.3, 1.1, -0.2, 0.5},
                    .velocity = {omega, body.radius * spin, 0, spin},
                    .momentum = {}};
  expect_agreement(
      body, start, f, y0,
      [](const Vector& s, const std::vector<double>& g, const std::vector<double>& xi) {
        const Vec<2> e1(std::cos(s[0]), std::sin(s[0])), e2(-e1[1], e1[0]), v(s[5], s[6]);
        return difference(s.head(4), g) +
               difference(Vector{{s[4], v.dot(e1), v.dot(e2), s[7]}}, xi);
      },
      "disk");
}

}  // namespace
