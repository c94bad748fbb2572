// Problems over stages by formulas: second derivatives by nested dual numbers.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <type_traits>

#include <Eigen/Dense>

#include <ceres/jet.h>

#include <hamel/framework/stages/stage_problem.hpp>
#include <hamel/framework/stages/stage_solver.hpp>

namespace stages_test {

/// A constant of a nested dual number too.
template <class T>
T num(double x) {
  if constexpr (std::is_same_v<T, double>) return x;
  else return T(num<typename T::Scalar>(x));
}

/// Model: constants n (state), m (inputs), paths; templates step(z, u, out), cost(k, z, u),
/// path(z, u, out), last(z). Bounds |u| <= bound; goal(z)_i = z_i - target_i of the first `goals`
/// components.
template <class Model>
class FormulaProblem : public hamel::StageProblem {
 public:
  static constexpr int n = Model::n, m = Model::m, all = n + m;
  using Jet = ceres::Jet<double, all>;
  using Jet2 = ceres::Jet<Jet, all>;

  FormulaProblem(Model given, int count) : model(given), count_(count) {}

  int stages() const override { return count_; }
  hamel::StageSizes sizes(int k) const override {
    if (k == count_) return {.state = n, .inputs = 0, .path = 0};
    return {.state = n, .inputs = m, .path = Model::paths};
  }
  void bounds(int, Eigen::VectorXd& low, Eigen::VectorXd& high) const override {
    low.setConstant(-bound);
    high.setConstant(bound);
  }
  bool values(int k, const Eigen::VectorXd& z, const Eigen::VectorXd& u,
              const Eigen::VectorXd* next, hamel::StageValues& out) override {
    if (k == count_) {
      out.cost = model.template last<double>(z.data());
      return true;
    }
    out.cost = model.template cost<double>(z.data(), u.data());
    model.template step<double>(z.data(), u.data(), out.defect.data());
    out.defect -= *next;
    model.template path<double>(z.data(), u.data(), out.path.data());
    return true;
  }
  bool derivatives(int k, const Eigen::VectorXd& z, const Eigen::VectorXd& u,
                   const Eigen::VectorXd*, const Eigen::VectorXd& lambda, const Eigen::VectorXd& y,
                   hamel::StageDerivatives& out) override {
    Jet2 x[all], s[n], c[Model::paths + 1], l;
    const bool end = k == count_;
    for (int i = 0; i < all; ++i) {
      const double value = i < n ? z[i] : end ? 0 : u[i - n];
      x[i] = Jet2(Jet(value, i), i);
    }
    if (end) {
      l = model.template last<Jet2>(x);
    } else {
      l = model.template cost<Jet2>(x, x + n);
      model.template step<Jet2>(x, x + n, s);
      model.template path<Jet2>(x, x + n, c);
    }
    const int size = end ? n : all;
    for (int i = 0; i < size; ++i) {
      out.cost_gradient[i] = l.a.v[i];
      for (int j = 0; j < size; ++j) out.hessian(i, j) = l.v[i].v[j];
    }
    if (end) return true;
    for (int r = 0; r < n; ++r) {
      for (int i = 0; i < all; ++i) {
        (i < n ? out.F(r, i) : out.B(r, i - n)) = s[r].a.v[i];
        for (int j = 0; j < all; ++j) out.hessian(i, j) += lambda[r] * s[r].v[i].v[j];
      }
    }
    for (int r = 0; r < Model::paths; ++r) {
      for (int i = 0; i < all; ++i) {
        out.path_jacobian(r, i) = c[r].a.v[i];
        for (int j = 0; j < all; ++j) out.hessian(i, j) -= y[r] * c[r].v[i].v[j];
      }
    }
    return true;
  }
  int goals() const override { return static_cast<int>(target.size()); }
  void goal(const Eigen::VectorXd& last, Eigen::VectorXd& value) override {
    value = last.head(goals()) - target;
  }
  void goal_derivatives(const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& jacobian,
                        Eigen::MatrixXd&) override {
    jacobian.leftCols(goals()).setIdentity();
  }
  Eigen::MatrixXd start_directions() const override { return free_start; }

  Model model;
  double bound = std::numeric_limits<double>::infinity();
  Eigen::VectorXd target;
  Eigen::MatrixXd free_start = Eigen::MatrixXd::Zero(n, 0);

 private:
  int count_;
};

/// All states from the start to the target in equal parts, inputs zero.
template <class Problem>
hamel::StagePoint straight_guess(const Problem& problem, const Eigen::VectorXd& start) {
  hamel::StagePoint guess;
  const int count = problem.stages();
  Eigen::VectorXd end = start;
  end.head(problem.goals()) = problem.target;
  for (int k = 0; k <= count; ++k) {
    guess.states.push_back(start + double(k) / count * (end - start));
    guess.inputs.push_back(Eigen::VectorXd::Zero(problem.sizes(k).inputs));
  }
  return guess;
}

/// A mass on a line by lift with forces at the nodes: q+ = q + h v + h^2/2 u/M,
/// v+ = v + h u/M; state (q, v, h), the step free or not. Cost: int (time + u^2/2).
struct Cart {
  static constexpr int n = 3, m = 1, paths = 0;
  double mass = 1, time = 0;
  template <class T>
  void step(const T* z, const T* u, T* out) const {
    const T h = z[2], a = u[0] / num<T>(mass);
    out[0] = z[0] + h * z[1] + num<T>(0.5) * h * h * a;
    out[1] = z[1] + h * a;
    out[2] = h;
  }
  template <class T>
  T cost(const T* z, const T* u) const {
    return z[2] * (num<T>(time) + num<T>(0.5) * u[0] * u[0]);
  }
  template <class T>
  void path(const T*, const T*, T*) const {}
  template <class T>
  T last(const T*) const {
    return num<T>(0);
  }
};

/// With a least step: else the cost of time has no bound.
struct TimedCart : Cart {
  static constexpr int paths = 1;
  template <class T>
  void path(const T* z, const T*, T* out) const {
    out[0] = z[2] - num<T>(0.01);
  }
};

/// The Heisenberg group by exp, speeds as inputs: z+ = z + h/2 (x u_2 - y u_1), exact.
struct Heisenberg {
  static constexpr int n = 3, m = 2, paths = 0;
  double h = 0.1;
  template <class T>
  void step(const T* z, const T* u, T* out) const {
    out[0] = z[0] + num<T>(h) * u[0];
    out[1] = z[1] + num<T>(h) * u[1];
    out[2] = z[2] + num<T>(h / 2) * (z[0] * u[1] - z[1] * u[0]);
  }
  template <class T>
  T cost(const T*, const T* u) const {
    return num<T>(h / 2) * (u[0] * u[0] + u[1] * u[1]);
  }
  template <class T>
  void path(const T*, const T*, T*) const {}
  template <class T>
  T last(const T*) const {
    return num<T>(0);
  }
};

/// A point that moves in the plane by its velocity and keeps away from a disk at the origin.
struct Round {
  static constexpr int n = 2, m = 2, paths = 1;
  double h = 0.1, radius = 0.5;
  template <class T>
  void step(const T* z, const T* u, T* out) const {
    for (int i = 0; i < 2; ++i) out[i] = z[i] + num<T>(h) * u[i];
  }
  template <class T>
  T cost(const T*, const T* u) const {
    return num<T>(h / 2) * (u[0] * u[0] + u[1] * u[1]);
  }
  template <class T>
  void path(const T* z, const T*, T* out) const {
    out[0] = z[0] * z[0] + z[1] * z[1] - num<T>(radius * radius);
  }
  template <class T>
  T last(const T*) const {
    return num<T>(0);
  }
};

}  // namespace stages_test
