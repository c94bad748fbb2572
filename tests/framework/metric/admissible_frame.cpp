// The frames of the general schemes (framework/metric/admissible_frame.hpp, stated_frame.hpp)
// against their definition, on random full inertias and rows, for sizes known at compile time and
// at run time.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <utility>

#include <Eigen/QR>

#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/metric/admissible_frame.hpp>
#include <hamel/framework/metric/stated_frame.hpp>

namespace hamel {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// The same system at every (t, g).
struct Given : Mechanics {
  Eigen::MatrixXd i, a;
  Eigen::VectorXd b;
  int dim() const override { return static_cast<int>(i.rows()); }
  int constraint_count() const override { return static_cast<int>(a.rows()); }
  bool constant_inertia() const override { return false; }
  void inertia(const double* /*g*/, Mechanics::Matrix out) const override { out = i; }
  void constraints(double /*t*/, const double* /*g*/, Mechanics::Matrix to_a,
                   Mechanics::Vector to_b) const override {
    to_a = a;
    to_b = b;
  }
};

Given random_system(std::mt19937& random, int n, int k, bool diagonal = false) {
  std::normal_distribution<double> normal;
  const auto make = [&](int rows, int cols) {
    Matrix m(rows, cols);
    for (double& x : m.reshaped()) x = normal(random);
    return m;
  };
  const Matrix root = make(n, n);
  Given out;
  out.i = root * root.transpose() + 0.5 * Matrix::Identity(n, n);
  if (diagonal) out.i = Matrix(out.i.diagonal().asDiagonal());
  out.a = make(k, n);
  out.b = make(k, 1);
  return out;
}

// The same that states its frame, of k rows without a drift.
template <int K>
struct GivenWithFrame : Given {
  explicit GivenWithFrame(const Given& given) : Given(given) { b.setZero(); }
  auto frame(const double* /*g*/) const {
    return Eigen::MatrixXd(-a.rightCols<K>().inverse() * a.leftCols(a.cols() - K));
  }
};

// metric: E^T metric E = 1, where it is given.
template <class Frame, class System>
void expect_definition(const System& system, const Matrix& metric, std::mt19937& random) {
  const int n = system.dim(), k = system.constraint_count();
  Frame place(system);
  place.set(system, 0, nullptr);
  std::normal_distribution<double> normal;
  typename Frame::Vector mu(n), xi(n);
  for (double& x : mu) x = normal(random);

  // A xi = b, and I xi - mu is a reaction, whose multipliers are found.
  place.admissible(mu, xi);
  EXPECT_LT((system.a * xi - system.b).norm(), 1e-13 * (1 + system.a.norm() * xi.norm()));
  const Vector reaction = system.i * xi - mu;
  typename Frame::Multipliers lambda = system.a.transpose().fullPivHouseholderQr().solve(reaction);
  if constexpr (requires { place.multipliers(reaction, lambda); })
    place.multipliers(reaction, lambda);
  EXPECT_LT((reaction - system.a.transpose() * lambda).norm(),
            1e-13 * (1 + system.i.norm() * xi.norm() + system.a.norm() * lambda.norm()));

  // (*) is c_i / |D^-1/2 a_i| and E^T r, E of n - k columns: zero for reactions alone, unit in the
  // metric.
  typename Frame::Multipliers c(k);
  for (double& x : c) x = normal(random);
  const Vector root = system.i.diagonal().cwiseSqrt();
  typename Frame::Vector r = system.a.transpose() * c;
  place.assemble(r, c, r);
  for (int j = 0; j < k; ++j) {
    const double size = (system.a.row(j).transpose().array() / root.array()).matrix().norm();
    EXPECT_NEAR(r[j], c[j] / size, 1e-12);
  }
  EXPECT_LT(r.tail(n - k).norm(), 1e-11);
  Matrix e(n, n - k);
  for (int i = 0; i < n; ++i) {
    r = Vector::Unit(n, i);
    place.assemble(r, c, r);
    e.row(i) = r.tail(n - k).transpose();
  }
  EXPECT_LE((system.a * e).norm(), 1e-11 * system.a.norm() * e.norm());
  EXPECT_EQ(e.fullPivHouseholderQr().rank(), n - k);
  if (metric.size() > 0) {
    EXPECT_LT((e.transpose() * metric * e - Matrix::Identity(n - k, n - k)).norm(), 1e-11);
  }

  // expand: A dxi and E^T I dxi have the values given.
  typename Frame::Vector z(n);
  for (double& x : z) x = normal(random);
  typename Frame::Vector moved = z;
  place.expand(moved.data());
  EXPECT_LT((e.transpose() * system.i * moved - z.tail(n - k)).norm(), 1e-11);
  r = Vector::Zero(n);
  place.assemble(r, typename Frame::Multipliers(system.a * moved), r);
  EXPECT_LT((r.head(k) - z.head(k)).norm(), 1e-11);

  // Sizes.
  EXPECT_NEAR(place.size(mu), (mu.array() / root.array()).matrix().norm(), 1e-12);
}

TEST(AdmissibleFrame, IsItsDefinition) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    for (const bool diagonal : {false, true}) {
      const Given system = random_system(random, 6, 3, diagonal);
      expect_definition<AdmissibleFrame<6, 3>>(system, system.i.diagonal().asDiagonal(), random);
    }
    for (const auto& [n, k] : {std::pair{1, 0}, {3, 1}, {5, 4}, {6, 3}, {6, 6}, {20, 17}}) {
      const Given system = random_system(random, n, k);
      expect_definition<AdmissibleFrame<>>(system, Matrix(), random);
    }
  }
}

TEST(StatedFrame, IsItsDefinition) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    for (const bool diagonal : {false, true}) {
      const GivenWithFrame<3> body(random_system(random, 6, 3, diagonal));
      expect_definition<StatedFrame<6, 3>>(body, body.i, random);
      const GivenWithFrame<1> particle(random_system(random, 3, 1, diagonal));
      expect_definition<StatedFrame<3, 1>>(particle, particle.i, random);
    }
  }
}

/// E moves by as much as A does, all around, also where a reflection would pass through the origin.
TEST(AdmissibleFrame, TurnsWithoutJumpsWithinAStep) {
  std::mt19937 random(2);
  Given system = random_system(random, 4, 1, true);
  AdmissibleFrame<4, 1> place(system);
  Eigen::Vector4d before = Eigen::Vector4d::Zero(), r = before;
  int jumps = 0;
  const int parts = 2000;
  for (int i = 0; i <= parts; ++i) {
    const double angle = 2 * 3.14159265358979 * i / parts;
    system.a << std::cos(angle), std::sin(angle), 0.3, 0;
    place.set(system, 0, nullptr);
    r = Vector::LinSpaced(4, 1, 2);
    place.assemble(r, AdmissibleFrame<4, 1>::Multipliers::Zero());
    if (i > 0 && (r - before).norm() > 0.2) ++jumps;
    before = r;
  }
  EXPECT_LE(jumps, 2);  // a change of sign once the entry is a tenth on the other side, and back
}

/// With sizes known at run time some velocities follow from the others: from which, is chosen anew
/// where the rows turn so far that it has to be, but not within a step.
TEST(AdmissibleFrame, ChoosesOtherVelocitiesAsRowsTurn) {
  std::mt19937 random(4);
  for (const std::pair<int, int>& sizes : {std::pair{6, 3}, {9, 6}, {12, 9}}) {
    const int n = sizes.first, k = sizes.second;
    Given system = random_system(random, n, k);
    const Matrix rows = system.a;
    const auto turn = [&](double angle) {
      for (int i = 0; i + 1 < n; i += 2) {
        system.a.col(i) = std::cos(angle) * rows.col(i) + std::sin(angle) * rows.col(i + 1);
        system.a.col(i + 1) = std::cos(angle) * rows.col(i + 1) - std::sin(angle) * rows.col(i);
      }
    };
    AdmissibleFrame<> place(system);
    const Vector mu = Vector::LinSpaced(n, -1, 2);
    Vector xi(n), before(n), after(n), earlier;
    int chosen = 0;
    const int parts = 5000;
    for (int i = 0; i < parts; ++i) {
      const double angle = 2 * 3.14159265358979 * i / parts;
      turn(angle);
      if (i == parts / 3) {  // a place that is none leaves no trace
        const Matrix good = std::exchange(
            system.a, Matrix::Constant(k, n, std::numeric_limits<double>::quiet_NaN()));
        place.set(system, 0, nullptr, /*same_frame=*/true);
        place.admissible(mu, xi);
        EXPECT_FALSE(xi.allFinite());
        system.a = good;
      }
      place.set(system, 0, nullptr);
      place.admissible(mu, xi);
      Matrix saddle = Matrix::Zero(n + k, n + k);
      saddle << system.i, system.a.transpose(), system.a, Matrix::Zero(k, k);
      Vector right(n + k);
      right << mu, system.b;
      const Vector exact = saddle.fullPivLu().solve(right).head(n);
      EXPECT_LT((xi - exact).norm(), 1e-11 * exact.norm()) << n << " " << angle;

      place.assemble(mu, Vector::Zero(k), before);
      if (i > 0 && (before - earlier).norm() > 0.1 * before.norm()) ++chosen;
      earlier = before;
      turn(angle + 0.002);
      place.set(system, 0, nullptr, /*same_frame=*/true);
      place.assemble(mu, Vector::Zero(k), after);
      EXPECT_LT((after - before).norm(), 0.1 * before.norm()) << n << " " << angle;
    }
    EXPECT_GE(chosen, 1) << n;
    EXPECT_LE(chosen, 60) << n;
  }
}

}  // namespace
}  // namespace hamel
