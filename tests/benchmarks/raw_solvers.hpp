// Each library called by hand on the 2 x 2 equation of a step, for comparison in
// benchmarks/solvers.cpp. The residual |F|/scale is driven to the target that hamel aims for, no
// further.
#pragma once

#include <array>
#include <cmath>
#include <memory>

#include <Eigen/LU>
#include <unsupported/Eigen/NonLinearOptimization>

#ifdef HAMEL_HAS_CERES
#include <ceres/ceres.h>
#include <ceres/tiny_solver.h>
#endif
#ifdef HAMEL_HAS_NLOPT
#include <nlopt.h>
#endif

#include <hamel/framework/schemes/left_invariant.hpp>
#include <hamel/framework/schemes/lift.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/so3.hpp>

namespace hamel::benchmarks {

using Problem = LeftInvariant<SO3, 2, Cayley<SO3>>;
using Step = Lift::Step<Problem>;
using Unknown = Step::Unknown;
inline constexpr double kTarget = 8 * 2.220446049250313e-16;

/// F/scale of one step.
struct Scaled {
  const Step* step = nullptr;
  double inverse = 1;
  void set(const Step& s) {
    step = &s;
    inverse = 1 / std::sqrt(s.scale_squared());
  }
  void value(const double* x, double* f) const {
    Unknown out;
    step->residual(Eigen::Map<const Unknown>(x), out);
    Eigen::Map<Unknown> mapped(f);
    mapped = inverse * out;
  }
  void value(const double* x, double* f, double* jacobian) const {
    Unknown out;
    Step::Jacobian j;
    step->linearise(Eigen::Map<const Unknown>(x), out, j);
    Eigen::Map<Unknown> mapped(f);
    mapped = inverse * out;
    Eigen::Map<Step::Jacobian> matrix(jacobian);
    matrix = inverse * j;
  }
  double residual(const double* x) const {
    Unknown f;
    value(x, f.data());
    return f.norm();
  }
};

/// Newton with a fresh Jacobian in every iteration.
struct RawNewton {
  bool solve(const Step& step, Unknown& y) {
    Scaled scaled;
    scaled.set(step);
    Unknown f;
    Step::Jacobian j;
    for (int k = 0; k < 20; ++k) {
      scaled.value(y.data(), f.data(), j.data());
      if (k > 0 && f.squaredNorm() <= kTarget * kTarget) return true;
      y -= j.inverse() * f;
    }
    return false;
  }
};

class RawHybrid {
 public:
  bool solve(const Step& step, Unknown& y) {
    functor_.scaled.set(step);
    x_ = y;
    hybrid_.parameters.xtol = 0;
    hybrid_.solve(x_);
    y = functor_.best;
    return functor_.done;
  }

 private:
  struct Functor {
    Scaled scaled;
    mutable Unknown best;
    mutable Unknown f;
    mutable bool done = false;
    int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& value) const {
      scaled.value(x.data(), value.data());
      done = value.squaredNorm() <= kTarget * kTarget;
      best = x;
      return done ? -1 : 0;
    }
    int df(const Eigen::VectorXd& x, Eigen::MatrixXd& j) const {
      scaled.value(x.data(), f.data(), j.data());
      return 0;
    }
  };
  Functor functor_;
  Eigen::HybridNonLinearSolver<Functor> hybrid_{functor_};
  Eigen::VectorXd x_;
};

#ifdef HAMEL_HAS_CERES
class RawTiny {
 public:
  RawTiny() {
    tiny_.options.function_tolerance = tiny_.options.gradient_tolerance = 0;
    tiny_.options.parameter_tolerance = 2.2e-16;
    tiny_.options.cost_threshold = 0.5 * kTarget * kTarget;
    tiny_.options.initial_trust_region_radius = 1e16;
  }
  bool solve(const Step& step, Unknown& y) {
    function_.scaled.set(step);
    return tiny_.Solve(function_, &y).final_cost <= 1e-26;
  }

 private:
  struct Function {
    using Scalar = double;
    enum { NUM_RESIDUALS = 2, NUM_PARAMETERS = 2 };
    Scaled scaled;
    bool operator()(const double* x, double* f, double* jacobian) const {
      if (jacobian == nullptr) scaled.value(x, f);
      else scaled.value(x, f, jacobian);
      return true;
    }
  };
  Function function_;
  ceres::TinySolver<Function> tiny_;
};

class RawCeres : ceres::IterationCallback {
 public:
  RawCeres() {
    problem_.AddResidualBlock(new Cost(scaled_), nullptr, x_.data());
    options_.linear_solver_type = ceres::DENSE_QR;
    options_.function_tolerance = options_.gradient_tolerance = options_.parameter_tolerance = 0;
    options_.initial_trust_region_radius = options_.max_trust_region_radius = 1e16;
    options_.logging_type = ceres::SILENT;
    options_.callbacks.push_back(this);
  }
  bool solve(const Step& step, Unknown& y) {
    scaled_.set(step);
    x_ = y;
    ceres::Solver::Summary summary;
    ceres::Solve(options_, &problem_, &summary);
    y = x_;
    return summary.final_cost <= 1e-26;
  }

 private:
  struct Cost final : ceres::SizedCostFunction<2, 2> {
    const Scaled& scaled;
    explicit Cost(const Scaled& s) : scaled(s) {}
    bool Evaluate(const double* const* x, double* f, double** jacobians) const override {
      if (jacobians == nullptr || jacobians[0] == nullptr) {
        scaled.value(x[0], f);
      } else {
        scaled.value(x[0], f, jacobians[0]);
        std::swap(jacobians[0][1], jacobians[0][2]);
      }
      return true;
    }
  };
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    return summary.cost <= 0.5 * kTarget * kTarget ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                                   : ceres::SOLVER_CONTINUE;
  }
  Scaled scaled_;
  Unknown x_;
  ceres::Problem problem_;
  ceres::Solver::Options options_;
};
#endif

#ifdef HAMEL_HAS_NLOPT
class RawSlsqp {
 public:
  RawSlsqp() {
    const double exactly[] = {0, 0};
    nlopt_set_min_objective(opt_, nothing, nullptr);
    nlopt_add_equality_mconstraint(opt_, 2, equations, this, exactly);
    nlopt_set_maxeval(opt_, 60);
  }
  RawSlsqp(const RawSlsqp&) = delete;
  RawSlsqp& operator=(const RawSlsqp&) = delete;
  ~RawSlsqp() { nlopt_destroy(opt_); }
  bool solve(const Step& step, Unknown& y) {
    scaled_.set(step);
    double value = 0;
    done_ = false;
    nlopt_optimize(opt_, y.data(), &value);
    if (done_) y = best_;
    return done_ || scaled_.residual(y.data()) <= 1e-13;
  }

 private:
  static double nothing(unsigned, const double*, double* gradient, void*) {
    if (gradient != nullptr) gradient[0] = gradient[1] = 0;
    return 0;
  }
  static void equations(unsigned, double* f, unsigned, const double* x, double* gradient,
                        void* data) {
    auto& self = *static_cast<RawSlsqp*>(data);
    if (gradient == nullptr) {
      self.scaled_.value(x, f);
    } else {
      self.scaled_.value(x, f, gradient);
      std::swap(gradient[1], gradient[2]);
    }
    if (f[0] * f[0] + f[1] * f[1] > kTarget * kTarget) return;
    self.done_ = true;
    self.best_ = Eigen::Map<const Unknown>(x);
    nlopt_force_stop(self.opt_);
  }
  nlopt_opt opt_ = nlopt_create(NLOPT_LD_SLSQP, 2);
  Scaled scaled_;
  Unknown best_;
  bool done_ = false;
};

/// 1/2|F|^2, restarted where it stalls, in coordinates of the size of the residual left.
template <nlopt_algorithm algorithm>
class RawMinimiser {
 public:
  static constexpr bool derivatives =
      algorithm != NLOPT_LN_NELDERMEAD && algorithm != NLOPT_LN_SBPLX;
  RawMinimiser() {
    nlopt_set_min_objective(opt_, half_square, this);
    nlopt_set_maxeval(opt_, derivatives ? 200 : 1000);
    nlopt_set_xtol_abs1(opt_, derivatives ? 1e-14 : 1e-9);
    if (!derivatives) nlopt_set_initial_step1(opt_, 1);
  }
  RawMinimiser(const RawMinimiser&) = delete;
  RawMinimiser& operator=(const RawMinimiser&) = delete;
  ~RawMinimiser() { nlopt_destroy(opt_); }
  bool solve(const Step& step, Unknown& y) {
    scaled_.set(step);
    unit_ = scaled_.residual(y.data());
    base_ = y;
    for (int leg = 0; leg < 10 && unit_ > kTarget; ++leg) {
      length_ = unit_ / scaled_.inverse;  // dF/dx is about 1
      Unknown z = Unknown::Zero();
      nlopt_set_stopval(opt_, 0.5 * kTarget * kTarget / (unit_ * unit_));
      double value = 0;
      nlopt_optimize(opt_, z.data(), &value);
      const Unknown next = base_ + length_ * z;
      const double left = scaled_.residual(next.data());
      if (left > 0.5 * unit_) break;
      base_ = next;
      unit_ = left;
    }
    y = base_;
    return unit_ <= 1e-13;
  }

 private:
  static double half_square(unsigned, const double* z, double* gradient, void* data) {
    auto& self = *static_cast<RawMinimiser*>(data);
    const Unknown x = self.base_ + self.length_ * Eigen::Map<const Unknown>(z);
    Unknown f;
    if (gradient == nullptr) {
      self.scaled_.value(x.data(), f.data());
    } else {
      Step::Jacobian j;
      self.scaled_.value(x.data(), f.data(), j.data());
      Eigen::Map<Unknown> slope(gradient);
      slope = self.length_ / (self.unit_ * self.unit_) * (j.transpose() * f);
    }
    return 0.5 * f.squaredNorm() / (self.unit_ * self.unit_);
  }
  nlopt_opt opt_ = nlopt_create(algorithm, 2);
  Scaled scaled_;
  Unknown base_;
  double unit_ = 1, length_ = 1;
};
#endif

}  // namespace hamel::benchmarks
