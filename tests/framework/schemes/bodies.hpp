// User systems for the tests: any group, any inertia, any constant constraint rows.
#pragma once

#include <random>

#include <hamel/framework/mechanics/system.hpp>

namespace hamel::test {

/// A symmetric positive definite matrix with no special structure, condition about 5.
template <int N>
Mat<N, N> full_inertia(unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-0.35, 0.35);
  Mat<N, N> b;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) b(i, j) = uniform(random);
  }
  Mat<N, N> out = b * b.transpose();
  for (int i = 0; i < N; ++i) out(i, i) += 0.6 + 0.2 * i;
  return out;
}

/// K random constraint rows on G with a full inertia.
template <class G, int K>
struct Body {
  using Group = G;
  static constexpr int n = G::dim;
  Mat<n, n> matrix = full_inertia<n>(7);
  unsigned seed = 11;

  Mat<n, n> inertia() const { return matrix; }
  Eigen::Matrix<double, K, n> constraints() const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Eigen::Matrix<double, K, n> rows;
    for (int i = 0; i < K; ++i) {
      for (int j = 0; j < n; ++j) rows(i, j) = normal(random);
    }
    return rows;
  }
  Start start() const {
    Start out;
    for (int i = 0; i < n; ++i) out.velocity.push_back(0.9 - 0.31 * i + 0.1 * (i % 2));
    return out;
  }
};

/// The free body.
template <class G>
struct FreeBody {
  using Group = G;
  static constexpr int n = G::dim;
  Mat<n, n> inertia() const { return full_inertia<n>(3); }
  Start start() const { return Body<G, 1>{}.start(); }
};

}  // namespace hamel::test
