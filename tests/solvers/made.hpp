// Equations made for the tests of solvers, seen through framework/loop/solver.hpp.
#pragma once

#include <functional>
#include <vector>

#include <Eigen/LU>

#include <hamel/framework/loop/solver.hpp>

namespace hamel::test {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

inline std::span<double> span_of(Vector& v) { return {v.data(), static_cast<size_t>(v.size())}; }

/// F and dF/dx from two functions; counts its evaluations.
struct Made final : Equation {
  int n;
  std::function<Vector(const Vector&)> f;
  std::function<Matrix(const Vector&)> j;
  double size_of_terms = 1;
  mutable int evaluations = 0;

  Made(int dimension, std::function<Vector(const Vector&)> value,
       std::function<Matrix(const Vector&)> jacobian, double scale_of_terms = 1)
      : n(dimension), f(std::move(value)), j(std::move(jacobian)), size_of_terms(scale_of_terms) {}

  int size() const override { return n; }
  double scale() const override { return size_of_terms; }
  void evaluate(std::span<const double> x, std::span<double> value,
                std::span<double> jacobian) const override {
    ++evaluations;
    const Vector at = Eigen::Map<const Vector>(x.data(), n);
    Eigen::Map<Vector>(value.data(), n) = f(at);
    if (!jacobian.empty()) Eigen::Map<Matrix>(jacobian.data(), n, n) = j(at);
  }
  double residual(const Vector& x) const { return f(x).norm() / size_of_terms; }
};

/// x + h (x_i x_{i+1})_i = b, multiplied by `unit`: of the form of a step, in other units.
inline Made like_a_step(int n, double h, double unit = 1) {
  Vector b(n);
  for (int i = 0; i < n; ++i) b[i] = 1 + 0.3 * i;
  const auto f = [=](const Vector& x) {
    Vector out = x - b;
    for (int i = 0; i < n; ++i) out[i] += h * x[i] * x[(i + 1) % n];
    return Vector(unit * out);
  };
  const auto j = [=](const Vector& x) {
    Matrix out = Matrix::Identity(n, n);
    for (int i = 0; i < n; ++i) {
      out(i, i) += h * x[(i + 1) % n];
      out(i, (i + 1) % n) += h * x[i];
    }
    return Matrix(unit * out);
  };
  return {n, f, j, unit * 2 * b.norm()};
}

}  // namespace hamel::test
