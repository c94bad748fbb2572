#include <hamel/framework/run/run/rows/rows_watch.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/mechanics/implied_rows.hpp>
#include <hamel/framework/run/run/rows/reactions.hpp>

namespace hamel {
namespace {
constexpr double kDependent = 1e10;  // condition
}  // namespace

RowsWatch::RowsWatch(std::shared_ptr<const Geometry> geometry, const SystemModel& system,
                     std::shared_ptr<const Mechanics> mechanics)
    : geometry_(std::move(geometry)),
      system_(system),
      mechanics_(std::move(mechanics)),
      implied_(dynamic_cast<const HasImpliedRows*>(mechanics_.get())),
      g_(geometry_->size()),
      b_(mechanics_->constraint_count()),
      rows_(mechanics_->constraint_count(), mechanics_->dim()),
      inertia_(mechanics_->dim(), mechanics_->dim()),
      frame_(rows_.cols(), rows_.cols() - rows_.rows()),
      whole_(inertia_),
      qr_(rows_.cols(), rows_.rows()),
      lu_(rows_.cols()),
      work_(frame_.cols()) {}

void RowsWatch::set_rows(const Snapshot& state) {
  load_element(*geometry_, state, g_);
  mechanics_->constraints(state.time, g_.data(), rows_, b_);
  mechanics_->inertia(g_.data(), inertia_);
  rows_ = (rows_ * velocity_units(inertia_).asDiagonal()).eval();
  for (Eigen::Index i = 0; i < rows_.rows(); ++i)
    if (const double size = rows_.row(i).norm(); size > 0) rows_.row(i) /= size;
}

dense::Pivots RowsWatch::pivots() {
  whole_.topRows(rows_.rows()) = rows_;
  whole_.bottomRows(frame_.cols()) = frame_.transpose();
  lu_.compute(whole_);
  return dense::pivots_of(lu_);
}

void RowsWatch::set_frame(double t) {
  last_time_ = t;
  columns_ = rows_.transpose();
  qr_.compute(columns_);
  frame_.setZero();
  frame_.bottomRows(frame_.cols()).setIdentity();
  qr_.householderQ().applyThisOnTheLeft(frame_, work_);
  sign_ = pivots().sign;
}

void RowsWatch::begin(const Snapshot& state) {
  set_rows(state);
  set_frame(state.time);
}

std::optional<std::string> RowsWatch::node(const Snapshot& state) {
  set_rows(state);
  const dense::Pivots found = pivots();
  if (found.sign != sign_ || found.ratio > kDependent)
    return fmt::format("the rows become dependent between t = {:.6g} and {:.6g}: {}", last_time_,
                       state.time, names());
  set_frame(state.time);
  if (implied_ != nullptr)
    if (std::string why = implied_->contradiction(state.time, g_.data()); !why.empty()) return why;
  return {};
}

double RowsWatch::condition(const Snapshot& state) {
  set_rows(state);
  const Eigen::VectorXd values = dense::svd(rows_).values;
  return values.size() == 0 ? 1 : values[0] / values[values.size() - 1];
}

std::string RowsWatch::remark(const Snapshot& state) {
  const double found = condition(state);
  if (!(found > kNearlyDependent)) return "";
  return fmt::format("; the rows are nearly dependent there (condition {:.1e}): {}", found,
                     names());
}

// Names of the rows in the combination that is next to zero.
std::string RowsWatch::names() const {
  const dense::Svd svd = dense::svd(rows_, Eigen::ComputeThinU);
  const Eigen::VectorXd parts = svd.u.rightCols<1>().cwiseAbs();
  std::string out;
  for (Eigen::Index i = 0; i < parts.size(); ++i) {
    if (parts[i] < 0.05 * parts.maxCoeff()) continue;
    const auto row = static_cast<size_t>(i);
    const auto& named = system_.reactions;
    out += fmt::format("{}{}", out.empty() ? "" : ", ",
                       row < named.size() ? named[row] : fmt::format("row {}", row + 1));
  }
  return out;
}

}  // namespace hamel
