// The value at which one eigenvalue crosses the imaginary axis. For steady_crossings.cpp, not
// installed.
#pragma once

#include <functional>
#include <optional>

#include <hamel/framework/analysis/matching.hpp>
#include <hamel/framework/analysis/steady_branch.hpp>

namespace hamel::reduced {

/// A node with its motion.
struct BranchMotion {
  BranchNode node;
  SteadyMotion motion;
};

/// A motion and the eigenvalue there that is followed.
struct CurvePoint {
  BranchMotion at;
  Complex eigenvalue;
};

class CrossingRoot {
 public:
  using OnBranch = std::function<std::optional<BranchMotion>(double value)>;
  /// mirrored: each eigenvalue l has a mate -l*, and is on the axis where it does not grow.
  CrossingRoot(OnBranch on_branch, bool mirrored)
      : on_branch_(std::move(on_branch)), mirrored_(mirrored) {}

  struct Found {
    double value, error;
    BranchMotion at;  // nearest to it
    Complex eigenvalue;
    bool pair;
  };
  /// Between two points of the curve, on different sides; the branch is between first and last.
  /// Nothing where a mirrored one only touches the axis.
  std::optional<Found> find(const CurvePoint& a, const CurvePoint& b, double first, double last);

 private:
  struct Sample {
    double x, f, error;
    CurvePoint point;
  };
  void set_rank(const CurvePoint& a, const CurvePoint& b);
  Sample sample(const BranchMotion& at, Complex expected) const;
  std::optional<Sample> sample(double x, Complex expected) const;
  void close_in(Sample& low, Sample& high) const;
  struct Root {
    double value, error;
    double imaginary, imaginary_error;
  };
  std::optional<Root> interpolated(const Sample& near, Complex slope, double h) const;

  OnBranch on_branch_;
  bool mirrored_;
  std::optional<size_t> rank_;  // by real part
};

}  // namespace hamel::reduced
