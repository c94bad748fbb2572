// The equation of a step behind virtual functions. Its rare uses (a second
// correction, a Jacobian, the search for the principal root, a solver from outside) is compiled
// once for its unknowns, not once for each step.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <Eigen/Core>

#include <hamel/framework/loop/solver.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

/// Work space of StepEquation::linearise.
template <class Unknown>
struct Differences {
  Unknown direction, shifted, shifted_f;
};

/// F: R^n -> R^n of a step that has begun.
template <class Unknown>
class StepEquation {
 public:
  static constexpr int n = Unknown::RowsAtCompileTime;
  using Jacobian = Eigen::Matrix<double, n, n>;
  /// The squared size of the terms that F balances.
  virtual double scale_squared() const = 0;
  virtual void residual(const Unknown& x, Unknown& f) const = 0;
  /// Does the step state its Jacobian?
  virtual bool exact() const = 0;

  /// F and dF/dx, or dF/dz with x + expand(z) (in_frame). The step's own Jacobian, else central
  /// differences, error about 1e-10: a Jacobian only steers the solver. Returns how often F was
  /// evaluated.
  int linearise(const Unknown& x, Unknown& f, Jacobian& j, Differences<Unknown>& work,
                bool in_frame) const {
    if (exact()) {
      exact_linearise(x, f, j);
      return 1;
    }
    // By a part of x; of a step of almost nothing, from rest, what the round-off of a place does
    // not hide.
    const double size = std::max(x.template lpNorm<Eigen::Infinity>(), 1e-3);
    const double shift = std::cbrt(std::numeric_limits<double>::epsilon()) * size;
    const Eigen::Index count = x.size();
    work.direction.resize(count);
    work.shifted.resize(count);
    work.shifted_f.resize(count);
    f.resize(count);
    j.resize(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      work.direction.setZero();
      work.direction[i] = 1;
      if (in_frame) expand(work.direction);
      const double length = shift / work.direction.template lpNorm<Eigen::Infinity>();
      work.shifted = x + length * work.direction;
      residual(work.shifted, work.shifted_f);
      work.shifted = x - length * work.direction;
      residual(work.shifted, f);
      j.col(i) = (work.shifted_f - f) / (2 * length);
    }
    residual(x, f);
    return 2 * static_cast<int>(count) + 1;
  }
  /// z -> dx, in place.
  virtual void expand(Unknown& z) const = 0;

 protected:
  ~StepEquation() = default;
  virtual void exact_linearise(const Unknown& x, Unknown& f, Jacobian& j) const = 0;
};

/// Equation of a compiled step.
template <class Step>
class ErasedStep final : public StepEquation<typename Step::Unknown> {
 public:
  using Unknown = typename Step::Unknown;
  using Jacobian = typename StepEquation<Unknown>::Jacobian;
  explicit ErasedStep(const Step& step) : step_(step) {}
  double scale_squared() const override { return step_.scale_squared(); }
  void residual(const Unknown& x, Unknown& f) const override { step_.residual(x, f); }
  bool exact() const override { return HasJacobian<Step>; }
  void expand([[maybe_unused]] Unknown& z) const override {
    if constexpr (HasFrame<Step>) step_.expand(z);
  }

 private:
  void exact_linearise([[maybe_unused]] const Unknown& x, [[maybe_unused]] Unknown& f,
                       [[maybe_unused]] Jacobian& j) const override {
    if constexpr (HasJacobian<Step>) step_.linearise(x, f, j);
  }

  const Step& step_;
};

/// As a solver from outside sees it.
template <class Unknown>
class SolverEquation final : public Equation {
 public:
  /// x: of its size.
  SolverEquation(const StepEquation<Unknown>& equation, const Unknown& x)
      : equation_(equation), x_(x), f_(x), work_{x, x, x} {
    jacobian_.resize(x.size(), x.size());
  }
  int size() const override { return static_cast<int>(x_.size()); }
  double scale() const override {
    const double squared = equation_.scale_squared();
    return squared > 0 ? std::sqrt(squared) : 1.0;
  }
  int jacobian_cost() const override { return equation_.exact() ? 1 : 2 * size() + 1; }
  void evaluate(std::span<const double> x, std::span<double> f,
                std::span<double> jacobian) const override {
    x_ = Eigen::Map<const Unknown>(x.data(), size());
    if (jacobian.empty()) {
      equation_.residual(x_, f_);
    } else {
      equation_.linearise(x_, f_, jacobian_, work_, /*in_frame=*/false);
      Eigen::Map<Jacobian>(jacobian.data(), size(), size()) = jacobian_;
    }
    Eigen::Map<Unknown>(f.data(), size()) = f_;
  }

 private:
  using Jacobian = typename StepEquation<Unknown>::Jacobian;
  const StepEquation<Unknown>& equation_;
  mutable Unknown x_, f_;
  mutable Jacobian jacobian_;
  mutable Differences<Unknown> work_;
};

}  // namespace hamel
