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
         holonomic.constant.rows() == 0 && potential.is_constant() && force.is_zero() &&
         states.constant.rows() == 0;
}

DataMechanics::DataMechanics(std::shared_ptr<const FormulaPrograms> programs,
                             const GroupInfo& group, std::shared_ptr<const Geometry> geometry,
                             std::shared_ptr<const Inputs> given)
    : programs_(std::move(programs)),
      f_(programs_->formulas()),
      geometry_(std::move(geometry)),
      rates_(group, geometry_),
      given_(std::move(given)),
      n_(group.dim),
      states_(static_cast<int>(f_.states.constant.rows())),
      own_(static_cast<int>(f_.own_rows())),
      held_(static_cast<int>(f_.holonomic.constant.rows())),
      values_(2 * programs_->variables(), 0.0),
      now_(n_) {
  const size_t t = time(), first_rate = t + 1 + f_.inputs, end = programs_->variables();
  autonomous_ = !f_.rows.uses(t, first_rate) && !f_.drift.uses(t, first_rate) &&
                !f_.force.uses(t, first_rate) && !f_.states.uses(t, first_rate);
  velocity_force_ = f_.force.uses(first_rate, end);
  // Not the second derivatives of phi, nor the rates of inputs.
  exact_rates_ =
      held_ == 0 && !f_.drift.uses(t + 1, first_rate) && !f_.states.uses(t + 1, first_rate);
  now_.setZero();
}

const double* DataMechanics::outputs(Evaluation e) const {
  const graph::Code& code = programs_->code(e);
  const size_t count = code.program().results().size();
  if (outputs_.size() < count) outputs_.resize(count);
  if (work_.size() < code.work_size()) work_.resize(code.work_size());
  code(values_.data(), outputs_.data(), work_.data());
  return outputs_.data();
}

bool DataMechanics::constant_constraints() const {
  return held_ == 0 && states_ == 0 && f_.rows.is_constant() && f_.drift.is_constant();
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
  if (states_ > 0) out.setZero();
  if (f_.inertia.is_constant()) return f_.inertia.fill(nullptr, out);
  take(g);
  f_.inertia.fill(outputs(Evaluation::inertia), out);
}

void DataMechanics::constraints(double t, const double* g, Matrix a, Vector b) const {
  const double* y = nullptr;
  if (!constant_constraints()) {
    take(g);
    take(t);
    y = outputs(Evaluation::constraints);
  }
  const int stated = own_ - states_;
  if (states_ > 0) a.topRows(stated).rightCols(states_).setZero();
  f_.rows.fill(y, a.topRows(stated));
  f_.drift.fill(y + f_.rows.entries.size(), b.head(stated));
  b.tail(held_).setZero();
  const double* slopes = y + f_.rows.entries.size() + f_.drift.entries.size();
  for (int i = 0; i < states_; ++i) {
    a.row(stated + i) = -Eigen::Map<const Eigen::RowVectorXd>(slopes, n_);
    a(stated + i, n_ - states_ + i) += 1;
    b[stated + i] = slopes[n_];
    slopes += n_ + 1;
  }
  for (int i = 0; i < held_; ++i, slopes += time()) {
    now_.setZero();
    rates_.add_pulled_back(g, values_.data(), slopes, now_);
    a.row(own_ + i) = now_.transpose();
  }
}

void DataMechanics::rates(const Geometry& geometry, double t, const double* g, ConstVector xi,
                          Vector rows, Vector momentum) const {
  if (!exact_rates_) return Mechanics::rates(geometry, t, g, xi, rows, momentum);
  take(g);
  take(t);
  take(xi);
  const auto of_variables = values_.begin() + static_cast<std::ptrdiff_t>(programs_->variables());
  std::fill(of_variables, values_.end(), 0.0);
  if (!rates_.along(values_.data(), xi.data(), &*of_variables))
    return Mechanics::rates(geometry, t, g, xi, rows, momentum);
  of_variables[static_cast<std::ptrdiff_t>(time())] = 1;
  const double* y = outputs(Evaluation::rates);
  rows = Eigen::Map<const Eigen::VectorXd>(y, own_);
  momentum = Eigen::Map<const Eigen::VectorXd>(y + own_, n_);
}

void DataMechanics::holonomic(const double* g, Vector out) const {
  if (held_ == 0) return;
  take(g);
  f_.holonomic.fill(outputs(Evaluation::holonomic), out);
}

double DataMechanics::potential(const double* g) const {
  if (f_.potential.is_constant()) return f_.potential.constant(0, 0);
  take(g);
  return *outputs(Evaluation::potential);
}

void DataMechanics::force(double t, const double* g, ConstVector xi, Vector out) const {
  take(g);
  take(t);
  take(xi);
  const double* y = outputs(Evaluation::force);
  f_.force.fill(y, out);
  out.tail(states_).setZero();
  if (f_.potential.is_constant() && f_.inertia.is_constant()) return;
  rates_.add_pulled_back(g, values_.data(), y + f_.force.entries.size(), out);
}

void DataMechanics::inertial_force(const double* g, ConstVector xi, Vector out) const {
  out.setZero();
  if (f_.inertia.is_constant()) return;
  take(g);
  take(xi);
  rates_.add_pulled_back(g, values_.data(), outputs(Evaluation::inertial_force), out);
}

double DataMechanics::power(double t, const double* g, ConstVector xi) const {
  if (!has_force()) return 0;
  take(g);
  take(t);
  take(xi);
  now_.tail(states_).setZero();
  f_.force.fill(outputs(Evaluation::applied_force), now_);
  return now_.dot(xi);
}

std::vector<std::string> DataMechanics::start_mistakes(double t, const double* g,
                                                       ConstVector xi) const {
  take(g);
  take(t);
  take(xi);
  std::vector<std::string> out;
  std::vector<double> slopes(programs_->variables());
  const auto check = [&](const FormulaMatrix& matrix, bool differentiated) {
    for (const FormulaMatrix::Entry& e : matrix.entries) {
      std::fill(slopes.begin(), slopes.end(), 0.0);
      const double value = e.value.differentiate(values_, 1, slopes);
      const bool smooth =
          std::all_of(slopes.begin(), slopes.end(), [](double x) { return std::isfinite(x); });
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
  check(f_.states, false);
  return out;
}

}  // namespace hamel
