// Factors of the general schemes (framework/metric/metric.hpp, stated_frame.hpp) against their
// definition, on random full inertias and rows, for sizes known at compile time and at run time.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <utility>

#include <Eigen/LU>
#include <Eigen/QR>

#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/metric/metric.hpp>
#include <hamel/framework/metric/run_time_frame.hpp>
#include <hamel/framework/metric/stated_frame.hpp>

namespace hamel {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// A system that is the same at every (t, g).
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

// A system that states its frame, of k rows without a drift.
template <int K>
struct GivenWithFrame : Given {
  explicit GivenWithFrame(const Given& given) : Given(given) { b.setZero(); }
  auto frame(const double* /*g*/) const {
    return Eigen::MatrixXd(-a.rightCols<K>().inverse() * a.leftCols(a.cols() - K));
  }
};

template <class T>
T random_vector(std::mt19937& random, int size) {
  std::normal_distribution<double> normal;
  T out(size);
  for (double& x : out) x = normal(random);
  return out;
}

// A xi = b, and I xi - mu is a reaction, whose multipliers are found.
template <class Place, class System>
void expect_projection(Place& place, const System& system, const typename Place::Vector& mu) {
  typename Place::Vector xi(mu.size());
  place.admissible(mu, xi);
  EXPECT_LT((system.a * xi - system.b).norm(), 1e-13 * (1 + system.a.norm() * xi.norm()));
  const Vector reaction = system.i * xi - mu;
  typename Place::Multipliers lambda = system.a.transpose().fullPivHouseholderQr().solve(reaction);
  if constexpr (requires { place.multipliers(mu, xi); }) lambda = place.multipliers(mu, xi);
  EXPECT_LT((reaction - system.a.transpose() * lambda).norm(),
            1e-13 * (1 + system.i.norm() * xi.norm() + system.a.norm() * lambda.norm()));
}

// Without a basis.
template <class Place>
void expect_metric(const Given& system, std::mt19937& random) {
  const int n = system.dim(), k = system.constraint_count();
  using V = typename Place::Vector;
  using C = typename Place::Multipliers;
  Place place(system);
  place.set(system, 0, nullptr);
  const V mu = random_vector<V>(random, n);
  expect_projection(place, system, mu);
  EXPECT_NEAR(place.size(mu), std::sqrt(mu.dot(Vector(system.i.lu().solve(Vector(mu))))), 1e-11);

  // F is 0 for reactions alone, and otherwise as long as the velocity of (mu, c) in the metric.
  const C c = random_vector<C>(random, k), none = C::Zero(k);
  V f(n), xi(n);
  place.assemble(V(system.a.transpose() * c), none, f);
  EXPECT_LT(f.norm(), 1e-11);
  place.assemble(mu, c, f);
  place.solve(mu, c, xi);
  EXPECT_NEAR(f.squaredNorm(), xi.dot(Vector(system.i * xi)), 1e-10 * f.squaredNorm());
  EXPECT_LT((system.a * xi - c).norm(), 1e-12 * (1 + system.a.norm() * xi.norm()));
  place.assemble(V::Zero(n), c, f);
  const double smallest = place.smallest(c, xi);
  EXPECT_NEAR(f.squaredNorm(), smallest, 1e-10 * smallest);
  EXPECT_NEAR(xi.dot(Vector(system.i * xi)), smallest, 1e-10 * smallest);

  // A correction of z moves F by z, also where the last rows move by h times a velocity.
  const double h = 0.01;
  for (int places = 0; places <= k; ++places) {
    const V z = random_vector<V>(random, n);
    V moved = z;
    place.expand(moved, h, places);
    C rows = system.a * moved;
    rows.tail(places) *= h;
    place.assemble(V(system.i * moved), rows, f);
    EXPECT_LT((f - z).norm(), 1e-9 * moved.norm()) << places;
  }
}

// In a basis. metric: E^T metric E = 1, where it is given.
template <class Frame, class System>
void expect_frame(const System& system, const Matrix& metric, std::mt19937& random) {
  const int n = system.dim(), k = system.constraint_count();
  Frame place(system);
  place.set(system, 0, nullptr);
  const auto mu = random_vector<typename Frame::Vector>(random, n);
  expect_projection(place, system, mu);

  // (*) is c_i / |D^-1/2 a_i| and E^T r, E of n - k columns: zero for reactions alone, unit in the
  // metric.
  const auto c = random_vector<typename Frame::Multipliers>(random, k);
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
  const auto z = random_vector<typename Frame::Vector>(random, n);
  typename Frame::Vector moved = z;
  place.expand(moved);
  EXPECT_LT((e.transpose() * system.i * moved - z.tail(n - k)).norm(), 1e-11);
  r = Vector::Zero(n);
  place.assemble(r, typename Frame::Multipliers(system.a * moved), r);
  EXPECT_LT((r.head(k) - z.head(k)).norm(), 1e-11);

  // Sizes.
  EXPECT_NEAR(place.size(mu), (mu.array() / root.array()).matrix().norm(), 1e-12);
}

TEST(Metric, IsItsDefinition) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    for (const bool diagonal : {false, true})
      expect_metric<Metric<6, 3>>(random_system(random, 6, 3, diagonal), random);
    for (const auto& [n, k] : {std::pair{1, 0}, {3, 1}, {5, 4}, {6, 3}, {6, 6}, {12, 9}})
      expect_metric<Metric<>>(random_system(random, n, k), random);
    // More velocities have their basis.
    for (const int k : {0, 9, 17})
      expect_frame<Metric<>>(random_system(random, 20, k), Matrix(), random);
  }
}

/// I need be definite on ker A only.
TEST(Metric, HoldsMasslessDirections) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    Given system = random_system(random, 5, 2);
    system.i.topRows<1>().setZero();
    system.i.leftCols<1>().setZero();
    const auto expect = [&](auto&& place) {
      place.set(system, 0, nullptr);
      const Vector mu = random_vector<Vector>(random, 5);
      Vector right(7);
      right << mu, system.b;
      Matrix saddle = Matrix::Zero(7, 7);
      saddle << system.i, -system.a.transpose(), system.a, Matrix::Zero(2, 2);
      const Vector exact = saddle.fullPivLu().solve(right);
      typename std::decay_t<decltype(place)>::Vector xi(5);
      place.admissible(mu, xi);
      EXPECT_LT((xi - exact.head(5)).norm(), 1e-10 * exact.norm());
      EXPECT_LT((place.multipliers(mu, xi) - exact.tail(2)).norm(), 1e-10 * exact.norm());
    };
    expect(Metric<5, 2>(system));
    expect(Metric<>(system));
  }
}

TEST(StatedFrame, IsItsDefinition) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    for (const bool diagonal : {false, true}) {
      const GivenWithFrame<3> body(random_system(random, 6, 3, diagonal));
      expect_frame<StatedFrame<6, 3>>(body, body.i, random);
      const GivenWithFrame<1> particle(random_system(random, 3, 1, diagonal));
      expect_frame<StatedFrame<3, 1>>(particle, particle.i, random);
    }
  }
}

/// F moves by as much as A does, all around: there is no sign and no pivot to be chosen.
TEST(Metric, TurnsWithoutJumps) {
  std::mt19937 random(2);
  Given system = random_system(random, 4, 1, true);
  Metric<4, 1> place(system);
  Eigen::Vector4d before = Eigen::Vector4d::Zero(), f = before;
  const int parts = 2000;
  for (int i = 0; i <= parts; ++i) {
    const double angle = 2 * 3.14159265358979 * i / parts;
    system.a << std::cos(angle), std::sin(angle), 0.3, 0;
    place.set(system, 0, nullptr);
    place.assemble(Eigen::Vector4d(Vector::LinSpaced(4, 1, 2)), Metric<4, 1>::Multipliers::Zero(),
                   f);
    if (i > 0) {
      EXPECT_LE((f - before).norm(), 0.02) << angle;
    }
    before = f;
  }
}

/// The basis of long chains.
class ByElimination {
 public:
  explicit ByElimination(const Given& system)
      : system_(system), frame_(system.dim(), system.constraint_count()) {}
  void set(bool same_frame) { frame_.set(system_.i.data(), system_.a.data(), same_frame); }
  void admissible(const Vector& mu, Vector& xi) {
    frame_.velocity(mu.data(), system_.b.data(), xi.data());
  }
  void assemble(const Vector& r, const Vector& c, Vector& f) {
    frame_.assemble(r.data(), c.data(), f.data());
  }

 private:
  const Given& system_;
  RunTimeFrame frame_;
};

/// In it some velocities follow from the others: from which, is chosen anew
/// where the rows turn so far that it has to be, but not within a step.
TEST(RunTimeFrame, ChoosesOtherVelocitiesAsRowsTurn) {
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
    ByElimination place(system);
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
        place.set(/*same_frame=*/true);
        place.admissible(mu, xi);
        EXPECT_FALSE(xi.allFinite());
        system.a = good;
      }
      place.set(/*same_frame=*/false);
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
      place.set(/*same_frame=*/true);
      place.assemble(mu, Vector::Zero(k), after);
      EXPECT_LT((after - before).norm(), 0.1 * before.norm()) << n << " " << angle;
    }
    EXPECT_GE(chosen, 1) << n;
    EXPECT_LE(chosen, 60) << n;
  }
}

}  // namespace
}  // namespace hamel
