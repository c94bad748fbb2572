// Nodes of multiple shooting: how many, and their first states.
#include <algorithm>
#include <cmath>

#include <hamel/framework/inverse/fit_problem.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/tangent/displacement_units.hpp>

namespace hamel {
namespace {

constexpr double kGrowth = 50;     // of a displacement within a segment
constexpr double kSomeGrowth = 2;  // where the motion has left the data
constexpr double kMemory = 1e-2;   // residuals of a natural displacement from the segment before
constexpr int kLocalIterations = 20;

// E at an admissible state, as directions (eta; dxi).
FitNode node_at(MovedMotion& motion, const MotionState& state) {
  const Eigen::MatrixXd& basis = motion.map().basis(state);
  const Eigen::Index n = state.xi.size(), m = basis.cols();
  FitNode out{state.time,
              {motion.map().coordinates(state), {state.xi.begin(), state.xi.end()}, {}},
              Eigen::MatrixXd::Zero(2 * n, n + m)};
  out.directions.topLeftCorner(n, n).setIdentity();
  out.directions.bottomRightCorner(n, m) = basis;
  return out;
}

}  // namespace

bool FitProblem::move_nodes(const FitPoint& from, const Eigen::VectorXd& increment, FitPoint& to) {
  to.nodes = from.nodes;
  Eigen::Index at = from.x.size();
  for (size_t r = 0; r < to.nodes.size(); ++r) {
    if (to.nodes[r].empty()) continue;
    try {
      MovedMotion motion("fit", *variables_, values_of(to.x, static_cast<int>(r)));
      for (FitNode& node : to.nodes[r]) {
        const Eigen::Index count = node.directions.cols();
        const MotionState before =
            motion.map().state_of(node.time, node.start.configuration, node.start.velocity);
        MotionState state;
        displace(motion.geometry(), before, node.directions * increment.segment(at, count), 1,
                 state);
        at += count;
        if (!state.xi.allFinite() || !motion.map().make_admissible(state)) return false;
        node = node_at(motion, state);
      }
    } catch (const ConfigError& error) {
      failure_ = error.mistakes().front();
      return false;
    }
  }
  return true;
}

// The nodes of one recording, one after the other.
class FitProblem::NodeChoice {
 public:
  NodeChoice(FitProblem& problem, const std::vector<double>& sigma,
             const std::vector<double>& scales, const FitPoint& at, size_t r)
      : problem_(problem),
        sigma_(sigma),
        scales_(scales),
        series_(problem.series_[r]),
        values_(problem.values_of(at.x, static_cast<int>(r))),
        at_theta_("fit", *problem.variables_, values_),
        duration_(std::max(series_.recording->t.back() - at_theta_.plan().config.from, 1e-300)) {
    const Run run = at_theta_.run_of(*problem.variables_, values_);
    units_ = displacement_units(at_theta_.map(), at_theta_.start(), run.driver().next_step());
  }

  std::vector<FitNode> choose(const std::optional<int>& segments) {
    std::vector<FitNode> out;
    MotionState state = at_theta_.start();
    size_t row = 0;
    for (int j = 1;; ++j) {
      size_t end = series_.recording->t.size();
      if (segments) end = end * static_cast<size_t>(j) / static_cast<size_t>(*segments);
      MotionState last = state;
      end = follow(state, row, end, !segments, last);
      if (j > 1) {
        LocalFit fit(*this, state, row, end);
        fit.descend(kLocalIterations);
        state = fit.state();
        out.push_back(node_at(at_theta_, state));
        last = state;
        follow(state, row, end, false, last);
      }
      if (end >= series_.recording->t.size()) return out;
      row = end;
      state = last;
    }
  }

 private:
  // The state alone, from the data of a segment.
  class LocalFit final : public FitDescent {
   public:
    LocalFit(NodeChoice& of, const MotionState& state, size_t row, size_t end)
        : of_(of), row_(row), end_(end), first_(state), now_(state), next_(state) {}
    const MotionState& state() const { return now_; }

    bool linearise(FitLinear& out) override {
      out.C.resize(0, 0);
      out.c.resize(0);
      return of_.residuals(now_, row_, end_, out.r, &out) && remember(now_, out.r, &out.J);
    }
    bool try_increment(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::VectorXd& c) override {
      c.resize(0);
      const FitNode here = node_at(of_.at_theta_, now_);
      displace(of_.at_theta_.geometry(), now_, here.directions * x, 1, next_);
      return next_.xi.allFinite() && of_.at_theta_.map().make_admissible(next_) &&
             of_.residuals(next_, row_, end_, r, nullptr) && remember(next_, r, nullptr);
    }
    void accept() override { now_ = next_; }

   private:
    bool remember(const MotionState& state, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
      Eigen::VectorXd gap;
      if (!displacement(of_.at_theta_.geometry(), first_, state, gap)) return false;
      const Eigen::Index rows = r.size(), count = gap.size();
      r.conservativeResize(rows + count);
      r.tail(count) = kMemory * of_.natural(gap);
      if (J == nullptr) return true;
      J->conservativeResize(rows + count, Eigen::NoChange);
      J->bottomRows(count) = kMemory * of_.natural(node_at(of_.at_theta_, state).directions);
      return true;
    }
    NodeChoice& of_;
    size_t row_, end_;
    MotionState first_, now_, next_;
  };

  // The motion from a state on, by displacements of it alone.
  TangentMotion motion(const MotionState& state, const Eigen::MatrixXd& directions,
                       TangentMotion::Carries carries) const {
    const MotionVariables none("fit", problem_.variables_->with(values_), {});
    const Start start{at_theta_.map().coordinates(state), {state.xi.begin(), state.xi.end()}, {}};
    const MotionVariables there = none.from(state.time, start, directions);
    return {"fit", there, Eigen::VectorXd::Zero(directions.cols()), carries};
  }

  // A node no later than a row; of steps of one size, where they end.
  double time_before(size_t row) const {
    const double t = series_.recording->t[row];
    const Config& config = at_theta_.plan().config;
    if (config.chooses_steps() || !config.step) return t;
    const double h = *config.step;
    return config.from + std::floor((t - config.from) / h + 1e-9) * h;
  }

  // Displacements (eta; dxi), columns, in natural units: rates over the whole duration, so that
  // what grows with time alone does not count.
  Eigen::MatrixXd natural(const Eigen::MatrixXd& columns) const {
    Eigen::MatrixXd out(columns.rows(), columns.cols());
    const Eigen::Index n = units_.size();
    out.topRows(n) = units_.cwiseInverse().asDiagonal() * columns.topRows(n);
    out.bottomRows(n) = (duration_ * units_.cwiseInverse()).asDiagonal() * columns.bottomRows(n);
    return out;
  }
  // A displacement of 1 in all of them, as far as the constraints allow.
  Eigen::MatrixXd displacement_of_all(const MotionState& state) const {
    StepMap& map = at_theta_.map();
    Eigen::MatrixXd out(2 * units_.size(), 1);
    out << units_, map.basis(state) * (map.left_inverse(state) * units_) / duration_;
    return out;
  }

  // To the rows before `end`, or until a displacement has grown: the row behind; last: the state
  // at the node before it.
  size_t follow(const MotionState& state, size_t row, size_t end, bool grows, MotionState& last) {
    const std::vector<double>& t = series_.recording->t;
    Eigen::MatrixXd directions(2 * state.xi.size(), 0);
    if (grows) directions = displacement_of_all(state);
    TangentMotion now =
        motion(state, directions,
               grows ? TangentMotion::Carries::ten_digits : TangentMotion::Carries::values);
    const auto length = [&] { return natural(now.now().columns.col(0)).norm(); };
    const double first = grows ? length() : 0;
    for (size_t k = row; k < end; ++k) {
      const bool failed = !now.advance_to(time_before(k)).ok;
      if (!grows) {
        if (failed) return end;
        last = now.now().state;
        continue;
      }
      const double grown = failed ? HUGE_VAL : length() / first;
      if (grown <= (grown > kSomeGrowth && leaves_data(now, k) ? kSomeGrowth : kGrowth)) {
        last = now.now().state;
        continue;
      }
      if (time_before(k) <= state.time || k == row) continue;
      if (!failed) last = now.now().state;
      return failed && k > row + 1 ? k - 1 : k;
    }
    if (end < t.size() && now.advance_to(time_before(end)).ok) last = now.now().state;
    return end;
  }

  // Is one of its quantities beside the data by as much as they are?
  bool leaves_data(TangentMotion& now, size_t k) {
    series_.observed.clear();
    Eigen::VectorXd here;
    series_.observed(now.motion(), now.now().state, here);
    for (size_t i = 0; i < series_.columns.size(); ++i) {
      const double off =
          here[static_cast<Eigen::Index>(i)] - series_.recording->values[series_.columns[i]][k];
      if (std::abs(off) > scales_[series_.names[i]]) return true;
    }
    return false;
  }

  // linear: J and sizes of its increments, where they are wanted.
  bool residuals(const MotionState& state, size_t row, size_t end, Eigen::VectorXd& r,
                 FitLinear* linear) {
    Eigen::MatrixXd* J = linear == nullptr ? nullptr : &linear->J;
    std::vector<double> found;
    std::vector<Eigen::VectorXd> slopes_found;
    try {
      const Eigen::MatrixXd directions = node_at(at_theta_, state).directions;
      TangentMotion now = motion(
          state, directions,
          J != nullptr ? TangentMotion::Carries::ten_digits : TangentMotion::Carries::values);
      if (linear != nullptr) linear->sizes = now.sizes();
      series_.observed.clear();
      const auto observed = [&](MovedMotion& of, const MotionState& at, Eigen::VectorXd& values) {
        series_.observed(of, at, values);
      };
      Eigen::VectorXd here;
      Eigen::MatrixXd slopes;
      for (size_t k = row; k < end; ++k) {
        if (!now.advance_to(series_.recording->t[k]).ok) return false;
        if (J == nullptr) observed(now.motion(), now.now().state, here);
        else if (!now.derivative(now.now(), observed, here, slopes)) return false;
        if (!here.allFinite()) return false;
        for (size_t i = 0; i < series_.columns.size(); ++i) {
          const double datum = series_.recording->values[series_.columns[i]][k];
          if (!std::isfinite(datum)) continue;
          const double sigma = sigma_[series_.names[i]];
          const auto value = static_cast<Eigen::Index>(i);
          found.push_back((here[value] - datum) / sigma);
          if (J != nullptr) slopes_found.emplace_back(slopes.row(value).transpose() / sigma);
        }
      }
    } catch (const ConfigError&) {
      return false;
    }
    const auto count = static_cast<Eigen::Index>(found.size());
    r = Eigen::Map<const Eigen::VectorXd>(found.data(), count);
    if (J == nullptr) return true;
    J->resize(count, node_at(at_theta_, state).directions.cols());
    for (Eigen::Index i = 0; i < count; ++i)
      J->row(i) = slopes_found[static_cast<size_t>(i)].transpose();
    return true;
  }

  FitProblem& problem_;
  const std::vector<double>&sigma_, &scales_;
  Series& series_;
  Eigen::VectorXd values_;
  mutable MovedMotion at_theta_;
  double duration_;
  Eigen::VectorXd units_;
};

void FitProblem::choose_nodes(const std::vector<double>& sigma, const std::vector<double>& scales,
                              std::optional<int> segments, FitPoint& out) {
  out.nodes.clear();
  for (size_t r = 0; r < series_.size(); ++r)
    out.nodes.push_back(NodeChoice(*this, sigma, scales, out, r).choose(segments));
}

}  // namespace hamel
