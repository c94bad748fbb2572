// The frame of the general schemes (framework/mechanics/admissible_frame.hpp) against its
// definition, on random full inertias and rows, for sizes known at compile time and at run time.
#include <gtest/gtest.h>

#include <random>

#include <hamel/framework/mechanics/admissible_frame.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>

namespace hamel {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// The same system at every (t, g).
struct Given final : Mechanics {
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

template <int N, int K>
void expect_definition(const Given& system, std::mt19937& random) {
  const int n = system.dim(), k = system.constraint_count();
  AdmissibleFrame<N, K> place(system);
  place.set(system, 0, nullptr);
  std::normal_distribution<double> normal;
  typename AdmissibleFrame<N, K>::Vector mu(n), xi(n);
  for (double& x : mu) x = normal(random);

  // A xi = b, and I xi - mu is a reaction, whose multipliers are found.
  place.admissible(mu, xi);
  EXPECT_LT((system.a * xi - system.b).norm(), 1e-13 * (1 + system.a.norm() * xi.norm()));
  typename AdmissibleFrame<N, K>::Multipliers lambda(k);
  const Vector reaction = system.i * xi - mu;
  place.multipliers(reaction, lambda);
  EXPECT_LT((reaction - system.a.transpose() * lambda).norm(),
            1e-13 * (1 + system.i.norm() * xi.norm() + system.a.norm() * lambda.norm()));

  // (*) is c_i / |D^-1/2 a_i| and E^T r, E of n - k columns: zero for reactions alone, unit in the
  // metric D.
  typename AdmissibleFrame<N, K>::Multipliers c(k);
  for (double& x : c) x = normal(random);
  const Vector root = system.i.diagonal().cwiseSqrt();
  typename AdmissibleFrame<N, K>::Vector r = system.a.transpose() * c;
  place.assemble(r, c);
  for (int j = 0; j < k; ++j) {
    const double size = (system.a.row(j).transpose().array() / root.array()).matrix().norm();
    EXPECT_NEAR(r[j], c[j] / size, 1e-12);
  }
  EXPECT_LT(r.tail(n - k).norm(), 1e-11);
  Matrix e(n, n - k);
  for (int i = 0; i < n; ++i) {
    r = Vector::Unit(n, i);
    place.assemble(r, c);
    e.row(i) = r.tail(n - k).transpose();
  }
  EXPECT_LT((e.transpose() * system.i.diagonal().asDiagonal() * e - Matrix::Identity(n - k, n - k))
                .norm(),
            1e-11);

  // expand: A dxi and E^T I dxi have the values given.
  typename AdmissibleFrame<N, K>::Vector z(n);
  for (double& x : z) x = normal(random);
  typename AdmissibleFrame<N, K>::Vector moved = z;
  place.expand(moved.data());
  EXPECT_LT((e.transpose() * system.i * moved - z.tail(n - k)).norm(), 1e-11);
  r = Vector::Zero(n);
  place.assemble(r, typename AdmissibleFrame<N, K>::Multipliers(system.a * moved));
  EXPECT_LT((r.head(k) - z.head(k)).norm(), 1e-11);

  // Sizes.
  EXPECT_NEAR(place.size(mu), (mu.array() / root.array()).matrix().norm(), 1e-12);
}

TEST(AdmissibleFrame, IsItsDefinition) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    expect_definition<6, 3>(random_system(random, 6, 3), random);
    expect_definition<6, 3>(random_system(random, 6, 3, true), random);
    for (const auto& [n, k] : {std::pair{1, 0}, {3, 1}, {5, 4}, {6, 3}, {6, 6}, {20, 17}}) {
      expect_definition<Eigen::Dynamic, Eigen::Dynamic>(random_system(random, n, k), random);
    }
  }
}

/// E moves by as much as A does, all around, also where a reflection would pass through the origin.
TEST(AdmissibleFrame, TurnsWithoutJumpsWithinAStep) {
  std::mt19937 random(2);
  Given system = random_system(random, 4, 1, true);
  AdmissibleFrame<> place(system);
  Vector before, r(4);
  int jumps = 0;
  const int parts = 2000;
  for (int i = 0; i <= parts; ++i) {
    const double angle = 2 * 3.14159265358979 * i / parts;
    system.a << std::cos(angle), std::sin(angle), 0.3, 0;
    place.set(system, 0, nullptr);
    r = Vector::LinSpaced(4, 1, 2);
    place.assemble(r, Vector::Zero(1));
    if (i > 0 && (r - before).norm() > 0.2) ++jumps;
    before = r;
  }
  EXPECT_LE(jumps, 2);  // a change of sign once the entry is a tenth on the other side, and back
}

}  // namespace
}  // namespace hamel
