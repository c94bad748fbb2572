// The motions of a fit: segment after segment of each recording.
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/inverse/fit_problem.hpp>
#include <hamel/framework/io/errors.hpp>

namespace hamel {

// The motion from a node on, by parameters and inputs and by the displacements of the node; the
// first one by all variables.
std::unique_ptr<TangentMotion> FitProblem::motion_of(const FitPoint& at, size_t r, size_t segment,
                                                     TangentMotion::Carries carries) const {
  const Eigen::VectorXd values = values_of(at.x, static_cast<int>(r));
  if (segment == 0) return std::make_unique<TangentMotion>("fit", *variables_, values, carries);
  const FitNode& node = at.nodes[r][segment - 1];
  const MotionVariables there = variables_->from(node.time, node.start, node.directions);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(there.size()));
  Eigen::Index next = 0;
  for (size_t i = 0; i < variables_->size(); ++i)
    if (variables_->all()[i].of_system()) all[next++] = values[static_cast<Eigen::Index>(i)];
  return std::make_unique<TangentMotion>("fit", there, all, carries);
}

// row(series, segment, number of the row, motion, of the observed quantities): at each row of each
// recording. joint(series, segment, motion that ends, motion that begins).
template <class Row, class Joint>
bool FitProblem::follow(const FitPoint& at, TangentMotion::Carries carries, const Row& row,
                        const Joint& joint) {
  for (size_t r = 0; r < series_.size(); ++r) {
    ++runs_;
    try {
      if (!follow_recording(at, r, carries, row, joint)) return false;
    } catch (const ConfigError& error) {
      failure_ = error.mistakes().front();
      return false;
    }
  }
  return true;
}

template <class Row, class Joint>
bool FitProblem::follow_recording(const FitPoint& at, size_t r, TangentMotion::Carries carries,
                                  const Row& row, const Joint& joint) {
  Series& series = series_[r];
  const std::vector<FitNode>& nodes = at.nodes[r];
  const std::vector<double>& t = series.recording->t;
  std::unique_ptr<TangentMotion> motion, last;
  const auto advance = [&](double to) {
    const Status status = motion->advance_to(to);
    if (!status.ok) failure_ = fmt::format("t = {:.6g}: {}", status.time, status.reason);
    return status.ok;
  };
  size_t k = 0;
  for (size_t j = 0; j <= nodes.size(); ++j) {
    last = std::move(motion);
    series.observed.clear();
    motion = motion_of(at, r, j, carries);
    if (j > 0 && !joint(r, j, *last, *motion)) return false;
    const auto& inputs = motion->motion().plan().setup.inputs;
    if (inputs != nullptr && !inputs->covers(t.back()))
      throw ConfigError({fmt::format("input: the table does not cover t = {}", t.back())});
    const double end = j < nodes.size() ? nodes[j].time : HUGE_VAL;
    for (; k < t.size() && t[k] < end; ++k)
      if (!advance(t[k]) || !row(r, j, k, *motion)) return false;
    if (j < nodes.size() && !advance(end)) return false;
  }
  return true;
}

namespace {

// (eta, dy) from the end of a segment to the node.
bool gap_between(TangentMotion& ends, const TangentMotion& begins, Eigen::VectorXd& out) {
  return ends.motion().map().difference(ends.now().state, begins.now().state, out);
}

}  // namespace

bool FitProblem::residuals(const FitPoint& at, Eigen::VectorXd& out, Eigen::VectorXd& c) {
  out.resize(data());
  c.resize(at.size() - at.x.size());
  Eigen::Index next = 0, joined = 0;
  Eigen::VectorXd values;
  const auto row = [&](size_t r, size_t, size_t k, TangentMotion& motion) {
    Series& series = series_[r];
    series.observed(motion.motion(), motion.now().state, values);
    for (size_t i = 0; i < series.columns.size(); ++i) {
      const double datum = series.recording->values[series.columns[i]][k];
      if (std::isfinite(datum)) out[next++] = values[static_cast<Eigen::Index>(i)] - datum;
    }
    return values.allFinite();
  };
  const auto joint = [&](size_t, size_t, TangentMotion& ends, TangentMotion& begins) {
    Eigen::VectorXd gap;
    if (!gap_between(ends, begins, gap)) return false;
    c.segment(joined, gap.size()) = gap;
    joined += gap.size();
    return true;
  };
  return follow(at, TangentMotion::Carries::values, row, joint);
}

// Columns of the unknowns of a segment: those of its motion, in their order.
std::vector<Eigen::Index> FitProblem::columns_of(const FitPoint& at, size_t r,
                                                 size_t segment) const {
  std::vector<Eigen::Index> out;
  for (size_t v = 0; v < variables_->size(); ++v) {
    if (segment > 0 && !variables_->all()[v].of_system()) continue;
    for (size_t i = 0; i < unknowns_.size(); ++i)
      if (unknowns_[i].variable == v &&
          (unknowns_[i].recording < 0 || unknowns_[i].recording == static_cast<int>(r)))
        out.push_back(static_cast<Eigen::Index>(i));
  }
  if (segment == 0) return out;
  Eigen::Index begin = at.x.size();
  for (size_t other = 0; other < r; ++other)
    for (const FitNode& node : at.nodes[other]) begin += node.directions.cols();
  for (size_t j = 0; j + 1 < segment; ++j) begin += at.nodes[r][j].directions.cols();
  for (Eigen::Index i = 0; i < at.nodes[r][segment - 1].directions.cols(); ++i)
    out.push_back(begin + i);
  return out;
}

bool FitProblem::jacobian(const FitPoint& at, TangentMotion::Carries digits, FitLinear& out) {
  const Eigen::Index all = at.size(), numbers = at.x.size();
  out.r.resize(data());
  out.c.resize(all - numbers);
  out.J.setZero(data(), all);
  out.C.setZero(all - numbers, all);
  out.sizes.setOnes(all);
  Eigen::Index next = 0, joined = 0;
  Eigen::VectorXd here;
  Eigen::MatrixXd slopes;
  const auto take_sizes = [&](const std::vector<Eigen::Index>& columns, TangentMotion& motion) {
    for (size_t v = 0; v < columns.size(); ++v)
      out.sizes[columns[v]] = motion.sizes()[static_cast<Eigen::Index>(v)];
  };
  const auto row = [&](size_t r, size_t j, size_t k, TangentMotion& motion) {
    Series& series = series_[r];
    const auto observed = [&](MovedMotion& of, const MotionState& state, Eigen::VectorXd& values) {
      series.observed(of, state, values);
    };
    if (!motion.derivative(motion.now(), observed, here, slopes) || !here.allFinite()) return false;
    const std::vector<Eigen::Index> columns = columns_of(at, r, j);
    if (j == 0) take_sizes(columns, motion);
    for (size_t i = 0; i < series.columns.size(); ++i) {
      const double datum = series.recording->values[series.columns[i]][k];
      if (!std::isfinite(datum)) continue;
      const auto value = static_cast<Eigen::Index>(i);
      out.r[next] = here[value] - datum;
      for (size_t v = 0; v < columns.size(); ++v)
        out.J(next, columns[v]) = slopes(value, static_cast<Eigen::Index>(v));
      ++next;
    }
    return true;
  };
  // By both sides to first order in the gap.
  const auto joint = [&](size_t r, size_t j, TangentMotion& ends, TangentMotion& begins) {
    Eigen::VectorXd gap;
    if (!gap_between(ends, begins, gap)) return false;
    StepMap& map = ends.motion().map();
    const Eigen::Index n = map.velocities(), count = gap.size();
    const Eigen::MatrixXd& inverse = map.left_inverse(ends.now().state);
    const auto add = [&](const Eigen::MatrixXd& moved, size_t segment, double sign) {
      const std::vector<Eigen::Index> columns = columns_of(at, r, segment);
      for (size_t v = 0; v < columns.size(); ++v) {
        const auto column = moved.col(static_cast<Eigen::Index>(v));
        out.C.block(joined, columns[v], n, 1) += sign * column.head(n);
        out.C.block(joined + n, columns[v], count - n, 1) += sign * (inverse * column.tail(n));
      }
    };
    take_sizes(columns_of(at, r, j), begins);
    add(begins.now().columns, j, 1);
    add(ends.now().columns, j - 1, -1);
    out.c.segment(joined, count) = gap;
    joined += count;
    return true;
  };
  return follow(at, digits, row, joint);
}

}  // namespace hamel
