#include <hamel/framework/inverse/recorded_path.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/framework/tangent/recorded_geometry.hpp>

namespace hamel {
namespace {

using graph::Number;
using Numbers = std::vector<Number>;

Numbers inputs_of_path(graph::Recording& recording, const char* name, std::size_t count) {
  Numbers out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(recording.input(name + std::to_string(i)));
  return out;
}

// Coordinates of g tau(eta) at eta = 0.
Numbers moved_coordinates(const RecordedGeometry& geometry, const Numbers& from,
                          const Numbers& eta) {
  std::vector<Traced> c, e, way(static_cast<std::size_t>(geometry.size()));
  for (const Number& x : from) c.emplace_back(x, 0);
  for (const Number& x : eta) e.emplace_back(x, 0);
  geometry.tau(e.data(), way.data());
  geometry.coordinates(c.data(), way.data(), c.data());
  Numbers out;
  for (const Traced& x : c) out.push_back(x.number);
  return out;
}

std::unique_ptr<graph::Code> code_of(const graph::Recording& recording, const Numbers& outputs) {
  graph::Program::Outputs named;
  for (const Number& y : outputs) named.emplace_back("y", y);
  return std::make_unique<graph::Code>(std::make_shared<const graph::Program>(recording, named));
}

}  // namespace

std::unique_ptr<RecordedPath> RecordedPath::of(const RunPlan& plan,
                                               const std::vector<RecordedNumber>& formulas) {
  const Mechanics& mechanics = *plan.system->mechanics;
  const auto geometry = recorded_geometry(plan.system->group, plan.config.retraction);
  if (geometry == nullptr ||
      std::ranges::any_of(formulas, [](const RecordedNumber& f) { return !f; }))
    return nullptr;
  const bool constant =
      mechanics.constant_inertia() && mechanics.constant_constraints() && !mechanics.has_drift();
  std::unique_ptr<RecordedPath> out(new RecordedPath);
  out->columns_ = static_cast<std::size_t>(plan.geometry->columns());
  out->n_ = static_cast<std::size_t>(mechanics.dim());
  out->count_ = formulas.size();
  const std::size_t n = out->n_, count = out->count_;

  graph::Recording recording;
  const Guards guards;
  const Numbers from = inputs_of_path(recording, "from", out->columns_);
  Numbers by = inputs_of_path(recording, "eta", n);
  const Numbers eta = by, xi = inputs_of_path(recording, "xi", n);
  by.insert(by.end(), xi.begin(), xi.end());
  const Number t = recording.input("t");
  by.push_back(t);
  const Numbers weights = inputs_of_path(recording, "weight", count);
  Numbers first;
  try {
    const Numbers coordinates = moved_coordinates(*geometry, from, eta);
    for (const RecordedNumber& f : formulas) first.push_back(f(t, coordinates, xi));
  } catch (const std::domain_error&) {
    return nullptr;
  }
  const Numbers values = first;
  for (std::size_t j = 0; j < by.size(); ++j) {
    Numbers rates(by.size());
    rates[j] = 1;
    const Numbers slopes = graph::along(values, by, rates);
    for (std::size_t i = 0; i < count; ++i) {
      if (slopes[i].is(0)) continue;
      if (!constant && j >= n && j < 2 * n) return nullptr;
      out->slope_entries_.push_back({static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)});
      first.push_back(slopes[i]);
    }
  }
  Numbers second;
  const std::vector<Numbers> all = graph::hessian(values, weights, by);
  for (std::size_t i = 0; i < by.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      if (all[i][j].is(0)) continue;
      out->second_entries_.push_back({static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)});
      second.push_back(all[i][j]);
    }
  out->first_ = code_of(recording, first);
  out->second_ = code_of(recording, second);
  out->in_.assign(out->columns_ + 2 * n + 1 + count, 0.0);
  out->out_.resize(std::max(first.size(), second.size()));
  out->work_.resize(std::max(out->first_->work_size(), out->second_->work_size()));
  const auto q = static_cast<Eigen::Index>(by.size());
  out->slopes_.setZero(static_cast<Eigen::Index>(count), q);
  out->hessian_.setZero(q, q);
  return out;
}

bool RecordedPath::evaluate(double t, std::span<const double> coordinates,
                            std::span<const double> velocity) {
  std::ranges::copy(coordinates, in_.begin());
  std::ranges::copy(velocity, in_.begin() + static_cast<std::ptrdiff_t>(columns_ + n_));
  in_[columns_ + 2 * n_] = t;
  (*first_)(in_.data(), out_.data(), work_.data());
  std::size_t at = count_;
  for (const Entry& e : slope_entries_) slopes_(e.row, e.column) = out_[at++];
  return slopes_.allFinite() && values().allFinite();
}

Eigen::VectorXd RecordedPath::values() const {
  return Eigen::Map<const Eigen::VectorXd>(out_.data(), static_cast<Eigen::Index>(count_));
}

const Eigen::MatrixXd& RecordedPath::hessian(const Eigen::VectorXd& weights) {
  std::copy_n(weights.data(), count_,
              in_.begin() + static_cast<std::ptrdiff_t>(columns_ + 2 * n_ + 1));
  (*second_)(in_.data(), out_.data(), work_.data());
  std::size_t at = 0;
  for (const Entry& e : second_entries_)
    hessian_(e.row, e.column) = hessian_(e.column, e.row) = out_[at++];
  return hessian_;
}

}  // namespace hamel
