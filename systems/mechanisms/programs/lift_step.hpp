// A step of lift on programs (lift_programs.hpp), for the one loop (framework/loop/loop.hpp).
//
// F has the scale of the scheme for any problem: momenta in square roots of an energy, E^T r over
// the root of the diagonal of E^T I E, rows by the smallest velocity that has them (metric.hpp),
// both where the programs were recorded.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include <hamel/framework/metric/held_rows.hpp>
#include <hamel/framework/schemes/lift.hpp>
#include <hamel/systems/mechanisms/multibody.hpp>
#include <hamel/systems/mechanisms/programs/lift_problem.hpp>

namespace hamel::mechanisms {

/// Part of a step that does not depend on the number of unknowns.
class LiftWork {
 public:
  using Node = hamel::Node<LiftProblem>;

  LiftWork(LiftProblem problem, std::shared_ptr<const Multibody> system,
           std::shared_ptr<const LiftPrograms> programs);
  /// Called where the unknowns change.
  void when_changed(std::function<void()> changed) { changed_ = std::move(changed); }

 protected:
  void take_up(const Node& node, double h);
  /// Residuals at the unknowns, into residuals().
  void evaluate(const double* x) const;
  /// Residuals of all lanes, the last one at the unknowns, the others with one of them shifted.
  const double* shift(const double* x, Eigen::Index first, Eigen::Index count,
                      double* shifts) const;
  bool reach(Node& next) const;
  const double* residuals() const { return block_.data(); }
  const double* weights() const { return now_.weights.data(); }
  /// |row of phi|, sum of its coefficients at the node.
  double row_size(size_t i) const;
  double scale_of_step() const;
  /// Nodes know no longer what they carry.
  void forget_forces() { known_ += 1; }

  LiftProblem problem_;
  std::shared_ptr<const LiftPrograms> programs_;
  const Node* from_ = nullptr;
  double h_ = 0;

 private:
  const LiftSizes& sizes() const { return programs_->sizes(); }
  // Programs with the scales of their residuals, and their pivots where they were recorded.
  struct Recorded {
    std::shared_ptr<const LiftPrograms> programs;
    std::vector<double> weights, middle_pivots, node_pivots;
  };
  void use(Recorded recorded);
  void change_programs(const Node& node);
  void measure(const Node& node, double h);
  void put_in(const Node& node, const double* carried, double h);
  void find_held(const Node& node);
  const double* node_pivots() const;
  const double* middle_pivots() const;
  void find_carried(const Node& node) const;
  void find_weights(const Node& node);
  void find_inputs(double t, double h);

  std::shared_ptr<const Multibody> system_;
  std::function<void()> changed_;
  // residuals, pivots, what the end begins with; from given_ on its inputs; from element_ on those
  // of the residual.
  mutable std::vector<double> block_, out_, work_, start_;
  size_t given_ = 0, element_ = 0, moving_ = 0, target_ = 0, middle_rates_ = 0, held_ = 0, v_ = 0;
  mutable std::vector<double> carried_;  // where the node has none
  Recorded now_;
  std::vector<Recorded> before_;  // of this run, in their order
  mutable std::vector<double> lanes_in_, lanes_out_, lanes_work_;
  mutable bool lost_ = false;
  bool fresh_ = true, constant_inputs_;
  double known_ = 1;  // marks nodes that carry what belongs to these programs and forces
  mutable Eigen::MatrixXd a_;
  mutable Eigen::VectorXd b_;
  double two_energy_ = 0, force_size_ = 0;
};

/// K unknowns; Eigen::Dynamic: any number.
template <int K>
class LiftStep : public LiftWork {
 public:
  using Problem = LiftProblem;
  using Unknown = Eigen::Matrix<double, K, 1>;
  using Jacobian = Eigen::Matrix<double, K, K>;
  using LiftWork::LiftWork;

  int size() const { return static_cast<int>(programs_->unknowns().size()); }
  void begin(const Node& node, double h) {
    take_up(node, h);
    scale_squared_ = scale_of_step();
    seen_.setConstant(size(), std::numeric_limits<double>::quiet_NaN());
  }
  void clear_history() { forget_forces(); }
  void guess(Unknown& x) const {
    const std::vector<int>& unknowns = programs_->unknowns();
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = from_->x[unknowns[static_cast<size_t>(i)]];
  }
  double scale_squared() const { return scale_squared_; }
  void residual(const Unknown& x, Unknown& f) const {
    see(x);
    for (Eigen::Index i = 0; i < x.size(); ++i) f[i] = residuals()[i] * weights()[i];
  }
  /// By forward differences, a direction in each lane: it only steers.
  void linearise(const Unknown& x, Unknown& f, Jacobian& j) const {
    const Eigen::Index n = x.size();
    f.resize(n);
    j.resize(n, n);
    double shifts[LiftPrograms::kLanes];
    constexpr Eigen::Index at_once = LiftPrograms::kLanes - 1;
    for (Eigen::Index first = 0; first < n; first += at_once) {
      const Eigen::Index count = std::min(at_once, n - first);
      const double* out = shift(x.data(), first, count, shifts);
      for (Eigen::Index i = 0; i < n; ++i) {
        const double *row = out + LiftPrograms::kLanes * i, here = row[at_once];
        f[i] = here * weights()[i];
        for (Eigen::Index k = 0; k < count; ++k)
          j(i, first + k) = (row[k] - here) * weights()[i] / shifts[k];
      }
    }
  }
  /// F but for what the round-off of a configuration does to its rows (held_rows.hpp).
  void residual_of_places(const Unknown& x, Unknown& f) const {
    residual(x, f);
    const LiftSizes& sizes = programs_->sizes();
    for (size_t i = 0; i < sizes.holonomic; ++i) {
      const auto at = static_cast<Eigen::Index>(sizes.independent + sizes.rows + i);
      const double own = kPlaceRoundOff * row_size(i), size = std::abs(residuals()[at]);
      f[at] *= size <= own ? 0 : 1 - own / size;
    }
  }
  bool finish(const Unknown& x, Node& next) const {
    if ((seen_.array() != x.array()).any()) see(x);
    return reach(next);
  }

 private:
  void see(const Unknown& x) const {
    seen_ = x;
    evaluate(x.data());
  }
  double scale_squared_ = 0;
  mutable Unknown seen_;
};

/// Descriptor of its loop.
template <int K>
struct ProgramLift : SchemeDefaults {
  static constexpr std::optional<double> fixed_s = 0.5;
  static ClaimedOrder claim(double s, TauTraits tau, bool left_invariant) {
    return Lift::claim(s, tau, left_invariant);
  }
  template <class P>
  using Step = LiftStep<K>;
};

}  // namespace hamel::mechanisms
