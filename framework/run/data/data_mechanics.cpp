#include <hamel/framework/run/data/data_mechanics.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace hamel {

bool FormulaMatrix::uses(size_t first, size_t last) const {
  return std::any_of(entries.begin(), entries.end(), [&](const Entry& e) {
    const auto used = e.value.used();
    return std::any_of(used.begin(), used.end(), [&](size_t i) { return first <= i && i < last; });
  });
}

bool DataFormulas::left_invariant() const {
  return inertia.is_constant() && rows.is_constant() && drift.is_zero() &&
         holonomic.constant.rows() == 0 && potential.is_constant() && force.is_zero();
}

DataMechanics::DataMechanics(DataFormulas formulas, const GroupInfo& group,
                             std::shared_ptr<const Geometry> geometry,
                             std::shared_ptr<const Inputs> given)
    : f_(std::move(formulas)),
      geometry_(std::move(geometry)),
      rates_(group, geometry_),
      given_(std::move(given)),
      n_(group.dim),
      own_(static_cast<int>(f_.rows.constant.rows())),
      held_(static_cast<int>(f_.holonomic.constant.rows())),
      values_(time() + 1 + f_.inputs + static_cast<size_t>(n_), 0.0),
      slopes_(values_.size()),
      now_(n_) {
  const size_t t = time(), first_rate = t + 1 + f_.inputs;
  autonomous_ = !f_.rows.uses(t, first_rate) && !f_.drift.uses(t, first_rate) &&
                !f_.force.uses(t, first_rate);
  velocity_force_ = f_.force.uses(first_rate, values_.size());
  // Not the second derivatives of phi, nor the rates of inputs.
  exact_rates_ = held_ == 0 && !f_.drift.uses(t + 1, first_rate);
}

bool DataMechanics::constant_constraints() const {
  return held_ == 0 && f_.rows.is_constant() && f_.drift.is_constant();
}

void DataMechanics::take(const double* g) const { geometry_->coordinates(g, values_.data()); }
void DataMechanics::take(double t) const {
  values_[time()] = t;
  if (given_ == nullptr) return;
  const InputValues u = given_->at(t);
  std::copy(u.begin(), u.end(), values_.data() + time() + 1);
}
void DataMechanics::take(ConstVector xi) const {
  std::copy(xi.data(), xi.data() + xi.size(), values_.data() + time() + 1 + f_.inputs);
}

void DataMechanics::inertia(const double* g, Matrix out) const {
  if (!f_.inertia.is_constant()) take(g);
  f_.inertia.at(values_, out);
}

void DataMechanics::constraints(double t, const double* g, Matrix a, Vector b) const {
  if (!constant_constraints()) {
    take(g);
    take(t);
  }
  f_.rows.at(values_, a.topRows(own_));
  f_.drift.at(values_, b.head(own_));
  b.tail(held_).setZero();
  for (int i = 0; i < held_; ++i) {
    std::fill(slopes_.begin(), slopes_.end(), 0.0);
    for (const FormulaMatrix::Entry& e : f_.holonomic.entries) {
      if (e.row == i) e.value.differentiate(values_, 1, slopes_);
    }
    now_.setZero();
    rates_.add_pulled_back(g, values_.data(), slopes_.data(), now_);
    a.row(own_ + i) = now_.transpose();
  }
}

bool DataMechanics::rates(double t, const double* g, ConstVector xi, Vector rows,
                          Vector momentum) const {
  if (!exact_rates_) return false;
  take(g);
  take(t);
  std::fill(slopes_.begin(), slopes_.end(), 0.0);
  if (!rates_.along(values_.data(), xi.data(), slopes_.data())) return false;
  slopes_[time()] = 1;
  rows.setZero();
  momentum.setZero();
  f_.rows.add_rate(values_, slopes_, -1, xi, rows);
  f_.drift.add_rate(values_, slopes_, 1, Eigen::Matrix<double, 1, 1>::Ones(), rows);
  f_.inertia.add_rate(values_, slopes_, 1, xi, momentum);
  return true;
}

void DataMechanics::holonomic(const double* g, Vector out) const {
  if (held_ == 0) return;
  take(g);
  f_.holonomic.at(values_, out);
}

double DataMechanics::potential(const double* g) const {
  if (f_.potential.is_constant()) return f_.potential.constant(0, 0);
  take(g);
  return f_.potential.entries.front().value(values_);
}

void DataMechanics::add_inertial_slopes(ConstVector xi) const {
  for (const FormulaMatrix::Entry& e : f_.inertia.entries)
    e.value.differentiate(values_, 0.5 * xi[e.row] * xi[e.column], slopes_);
}

void DataMechanics::force(double t, const double* g, ConstVector xi, Vector out) const {
  take(g);
  take(t);
  take(xi);
  f_.force.at(values_, out);
  if (f_.potential.is_constant() && f_.inertia.is_constant()) return;
  std::fill(slopes_.begin(), slopes_.end(), 0.0);
  for (const FormulaMatrix::Entry& e : f_.potential.entries)
    e.value.differentiate(values_, -1, slopes_);
  add_inertial_slopes(xi);
  rates_.add_pulled_back(g, values_.data(), slopes_.data(), out);
}

void DataMechanics::inertial_force(const double* g, ConstVector xi, Vector out) const {
  out.setZero();
  if (f_.inertia.is_constant()) return;
  take(g);
  std::fill(slopes_.begin(), slopes_.end(), 0.0);
  add_inertial_slopes(xi);
  rates_.add_pulled_back(g, values_.data(), slopes_.data(), out);
}

double DataMechanics::power(double t, const double* g, ConstVector xi) const {
  if (!has_force()) return 0;
  take(g);
  take(t);
  take(xi);
  f_.force.at(values_, now_);
  return now_.dot(xi);
}

std::vector<std::string> DataMechanics::start_mistakes(double t, const double* g,
                                                       ConstVector xi) const {
  take(g);
  take(t);
  take(xi);
  std::vector<std::string> out;
  const auto check = [&](const FormulaMatrix& matrix, bool differentiated) {
    for (const FormulaMatrix::Entry& e : matrix.entries) {
      std::fill(slopes_.begin(), slopes_.end(), 0.0);
      const double value = e.value.differentiate(values_, 1, slopes_);
      const bool smooth =
          std::all_of(slopes_.begin(), slopes_.end(), [](double x) { return std::isfinite(x); });
      if (!std::isfinite(value))
        out.push_back(fmt::format("{}: '{}' is {} at the start", e.where, e.text, value));
      else if (differentiated && !smooth)
        out.push_back(
            fmt::format("{}: '{}' has no finite derivative at the start", e.where, e.text));
    }
  };
  check(f_.inertia, true);
  check(f_.rows, false);
  check(f_.drift, false);
  check(f_.holonomic, true);
  check(f_.potential, true);
  check(f_.force, false);
  return out;
}

}  // namespace hamel
