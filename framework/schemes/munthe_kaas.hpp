// Runge-Kutta-Munthe-Kaas methods on the equations of motion: what rkmk4, dopri5, tsit5 and dop853
// share, a step given by its tableau (runge_kutta.hpp), (M44).
//
// The coordinates are those of the algebra at the start of the step, g = g_0 tau(eta), in which
//   eta' = dL tau_eta^-1 xi.
// With the exact dL tau^-1 every tableau keeps its order with every tau; without it the order would
// be 2. Error of a step: the largest of
//   |e_eta,i| / (atol + rtol),   |e_xi,i| / (atol + rtol max |xi_i|):
// a unit of a coordinate is of size 1, since a displacement has no origin.
// Dense output: that of the tableau in (eta, x), then onto the constraints as a node.
// Source: Munthe-Kaas, High order Runge-Kutta methods on manifolds (1999); Hairer, Lubich, Wanner,
// IV.8.
#pragma once

#include <hamel/framework/schemes/error_scale.hpp>
#include <hamel/framework/schemes/runge_kutta.hpp>

namespace hamel {

struct MuntheKaas : ExplicitDefaults {
  using Family = MuntheKaas;  // what is compiled, for all tableaus
  template <class P>
  class Step;
};

/// A pair with an estimate of its error, whose steps keep the holonomic rows.
struct ExplicitPair : MuntheKaas {
  static constexpr StepChoice step_choice = StepChoice::by_estimate;
};

template <class P>
class MuntheKaas::Step : public RungeKutta<Step<P>, P, typename P::Vector> {
  using Base = RungeKutta<Step<P>, P, typename P::Vector>;
  using Base::at, Base::last;

 public:
  using typename Base::Element, typename Base::Node, typename Base::State, typename Base::Vector;
  static constexpr bool rate_in_algebra = true;
  /// Pairs keep the holonomic rows.
  bool keeps_rows() const { return this->table_.estimates(); }

  Step(const P& problem, const Tableau& table) : Base(problem, table, problem.dim()) {}

  void start(const Element& g, Vector& eta) {
    g0_ = g;
    eta.setZero();
  }
  bool element(const Vector& eta, Element& g) const {
    if (!this->problem_.in_domain(eta)) return false;
    this->problem_.tau(eta, g);
    this->problem_.compose(g0_, g, g);
    return true;
  }
  void rate(const Vector& eta, const Element& /*g*/, const Vector& xi, Vector& out) const {
    this->problem_.dtau_left_inverse(eta, xi, out);
  }
  bool element_with_rate(const Vector& eta, const Vector& xi, Element& g, Vector& out) const {
    if (!this->problem_.in_domain(eta)) return false;
    this->problem_.tau_with_rate(eta, xi, g, out);
    this->problem_.compose(g0_, g, g);
    return true;
  }

  /// Does the tableau estimate the error, O(h^k)?
  int estimated_order() const {
    return this->table_.estimates() ? this->table_.estimated_order : 0;
  }
  /// The error of the step that was just finished; it is good up to 1.
  double error(const Node& next, const ErrorScale& scale) const {
    const double e = estimate(this->table_.e, next, scale);
    if (this->table_.e3.empty() || e == 0) return e;
    const double e3 = estimate(this->table_.e3, next, scale);
    return e * (e / std::hypot(e, 0.1 * e3));  // no square: e may be 1e-200, at rest
  }

  /// A first step from a node: an Euler step and the change of the rates along it, as in dopri5.f.
  double first_step(const Node& node, const ErrorScale& scale) {
    const int n = this->problem_.dim();
    this->begin(node, 1);
    const auto size = [&](const Vector& eta_rate, const State& x_rate) {
      this->problem_.velocity(x_rate, error_);
      double norm = 0;  // by hypot: squares of 1e-200 or 1e200 are no numbers
      for (int i = 0; i < n; ++i) {
        norm =
            std::hypot(norm, eta_rate[i] / scale.at(1), error_[i] / scale.at(std::abs(after_[i])));
      }
      return norm / std::sqrt(2 * n);
    };
    this->problem_.velocity(node.x, after_);
    const Vector one = Vector::Ones(n);
    const double value = size(one, node.x), rate = size(this->q_rates_[0], this->x_rates_[0]);
    double h = rate > 1e-5 && value > 1e-5 ? 0.01 * value / rate : 1e-6;
    this->q_ = h * this->q_rates_[0];
    this->x_ = node.x + h * this->x_rates_[0];
    Vector eta_rate = this->q_rates_[0];
    State x_rate = this->x_rates_[0];
    if (element(this->q_, this->g_)) {
      this->problem_.velocity(this->x_, this->xi_);
      this->motion_(node.t + h, this->g_, this->x_, this->xi_, x_rate);
      this->rate(this->q_, this->g_, this->xi_, eta_rate);
    }
    eta_rate -= this->q_rates_[0];
    x_rate -= this->x_rates_[0];
    const double most = std::max(rate, size(eta_rate, x_rate) / h);
    const double order = this->table_.estimated_order;
    const double next = most <= 1e-15 ? std::max(1e-6, h * 1e-3) : std::pow(0.01 / most, 1 / order);
    return std::min(100 * h, next);
  }

  /// The node at t + theta h within the step that was just finished.
  bool interpolate(double theta, Node& out) const {
    if (!interpolate_freely(theta, out)) return false;
    if constexpr (!P::left_invariant) {
      if (!this->settle(out)) return false;
      out.x = this->x_;
    }
    return true;
  }
  /// The same as the tableau gives it: off the constraints by about the error of the step.
  bool interpolate_freely(double theta, Node& out) const {
    if (!this->extended_ && !extend()) return false;
    this->q_ = theta * q_powers_.back();
    this->x_ = theta * x_powers_.back();
    for (size_t j = q_powers_.size() - 1; j-- > 0;) {
      this->q_ = theta * (this->q_ + q_powers_[j]);
      this->x_ = theta * (this->x_ + x_powers_[j]);
    }
    this->x_ += this->from_->x;
    if (!element(this->q_, out.g)) return false;
    out.t = this->from_->t + theta * this->h_;
    out.x = this->x_;
    return true;
  }

 private:
  // The further stages, and the coefficients of theta^(j+1) in (eta, x): h sum_i p_ij k_i.
  bool extend() const {
    const Tableau& table = this->table_;
    for (int i = last() + 1; i < table.all_stages(); ++i)
      if (!this->stage(i)) return false;
    for (int j = 0; j < table.degree; ++j) {
      Vector& q = q_powers_[at(j)];
      State& x = x_powers_[at(j)];
      q.setZero();
      x.setZero();
      for (int i = 0; i < table.all_stages(); ++i) {
        const double weight = this->h_ * table.dense[at(i * table.degree + j)];
        if (weight == 0) continue;
        q += weight * this->q_rates_[at(i)];
        x += weight * this->x_rates_[at(i)];
      }
    }
    this->extended_ = true;
    return true;
  }
  double estimate(std::span<const double> weights, const Node& next,
                  const ErrorScale& scale) const {
    error_.setZero();
    x_error_.setZero();
    for (int i = 0; i <= last(); ++i) {
      const double weight = this->h_ * weights[at(i)];
      if (weight == 0) continue;
      error_ += weight * this->q_rates_[at(i)];
      x_error_ += weight * this->x_rates_[at(i)];
    }
    double most = error_.cwiseAbs().maxCoeff() / scale.at(1);
    this->problem_.velocity(this->from_->x, this->xi_);
    this->problem_.velocity(next.x, after_);
    this->problem_.velocity(x_error_, error_);
    for (int i = 0; i < this->problem_.dim(); ++i) {
      const double size = std::max(std::abs(this->xi_[i]), std::abs(after_[i]));
      const double part = std::abs(error_[i]) / scale.at(size);
      if (!(part <= most)) most = part;
    }
    return most;
  }

  Element g0_ = this->problem_.element();
  mutable std::vector<Vector> q_powers_ = std::vector<Vector>(at(this->table_.degree), this->q0_);
  mutable std::vector<State> x_powers_ = std::vector<State>(at(this->table_.degree), this->x_);
  mutable Vector error_ = Vector::Zero(this->problem_.dim()), after_ = error_;
  mutable State x_error_ = State::Zero(this->problem_.state_size());
};

}  // namespace hamel
