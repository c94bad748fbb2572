// Common part of explicit schemes on the equations of motion: a Runge-Kutta method given by its
// tableau.
//
// In coordinates q of the element that it chooses, a scheme integrates
//   q' = rate(q, xi),   x' = a(t, g, x)   (stage_motion.hpp),   g = element(q).
// At the end of a step g goes to the group and xi onto A xi = b, orthogonally in the metric I or,
// in a frame that the system states, to E(g) y. A scheme that keeps the holonomic rows
// (Derived::keeps_rows) moves g onto phi = 0 before, g <- g tau(v) with the smallest v in that
// metric that has A v = (0, -phi): the change is of the size of the step's error, so that the order
// stays. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.1 to II.6;
// Hairer, Lubich, Wanner, IV.4.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <hamel/framework/lie/types.hpp>
#include <hamel/framework/metric/held_rows.hpp>
#include <hamel/framework/schemes/scheme.hpp>
#include <hamel/framework/schemes/stage_motion.hpp>
#include <hamel/framework/schemes/tableau.hpp>

namespace hamel {

/// Derived gives start(g, q), element(q, g) -> bool (false outside the domain of the coordinates),
/// rate(q, g, xi, out), keeps_rows(), and rate_in_algebra: rate does not look at g; where both are
/// cheaper at once, element_with_rate(q, xi, g, out) -> bool too. Q: the type of the coordinates.
template <class Derived, class P, class Q>
class RungeKutta {
 public:
  using Problem = P;
  using Node = hamel::Node<P>;
  using Element = typename P::Element;
  using Vector = typename P::Vector;
  using State = typename P::State;

  /// Evaluations of the equations of motion in the last step.
  int evaluations() const { return evaluations_; }

  HAMEL_FLATTEN void begin(const Node& node, double h) {
    from_ = &node;
    h_ = h;
    evaluations_ = table_.stages;
    self().start(node.g, q0_);
    problem_.velocity(node.x, xi_);
    self().rate(q0_, node.g, xi_, q_rates_[0]);
    if (is(end_, node)) {
      x_rates_[0] = x_rates_[at(last())];
    } else if (!is(begin_, node)) {  // else the step is taken again with another size
      motion_(node.t, node.g, node.x, xi_, x_rates_[0]);
      ++evaluations_;
    }
    begin_ = node;
    end_.t = kNever;
    extended_ = false;
  }

  HAMEL_FLATTEN bool finish(Node& next) const {
    for (int i = 1; i < last(); ++i) {
      if (!stage(i)) return false;
    }
    sum(last());
    if (!self().element(q_, next.g)) return false;
    next.t = from_->t + h_;
    if constexpr (!P::left_invariant) {
      if (!settle(next)) return false;
    }
    next.x = x_;
    if (table_.estimates() && !motion_.framed()) problem_.velocity(next.x, xi_);
    motion_(next.t, next.g, next.x, xi_, x_rates_[at(last())]);
    if (table_.estimates()) self().rate(q_, next.g, xi_, q_rates_[at(last())]);
    end_ = next;
    return next.x.allFinite();
  }
  /// Forgets the rates at the last nodes.
  void clear_history() { begin_.t = end_.t = kNever; }
  /// Was the last step refused because the equations of motion gave a value that is not finite?
  bool not_finite() const { return !(x_.allFinite() && q_.allFinite()); }
  /// Was the last step refused because the constraints do not hold at its end?
  bool lost_constraints() const { return lost_; }

 protected:
  /// coordinates: how many numbers q has.
  RungeKutta(const P& problem, const Tableau& table, int coordinates)
      : problem_(problem), table_(table), q0_(coordinates) {
    clear_history();
  }

  static size_t at(int i) { return static_cast<size_t>(i); }
  int last() const { return table_.stages; }
  bool is(const Node& one, const Node& other) const {
    return one.t == other.t && one.x == other.x && problem_.same(one.g, other.g);
  }
  // q_ and x_ at stage i.
  void sum(int i) const {
    Local<Q> q = q_;
    Local<State> x = x_;
    q = q0_;
    x = from_->x;
    for (int j = 0; j < i; ++j) {
      const double weight = h_ * table_.at(i, j);
      if (weight == 0) continue;
      q += weight * q_rates_[at(j)];
      x += weight * x_rates_[at(j)];
    }
    q_ = q;
    x_ = x;
  }
  // In registers where the size is known, else in place.
  template <class V>
  using Local = std::conditional_t<V::SizeAtCompileTime == Eigen::Dynamic, V&, V>;
  HAMEL_FLATTEN [[gnu::noinline]] bool stage(int i) const {
    sum(i);
    const double t = from_->t + table_.c[at(i)] * h_;
    if (motion_.framed()) {  // xi follows from g
      if (!self().element(q_, g_)) return false;
      motion_(t, g_, x_, xi_, x_rates_[at(i)]);
      self().rate(q_, g_, xi_, q_rates_[at(i)]);
      return true;
    }
    problem_.velocity(x_, xi_);
    if constexpr (P::left_invariant && Derived::rate_in_algebra) {
      if (!problem_.in_domain(q_)) return false;
      self().rate(q_, g_, xi_, q_rates_[at(i)]);
    } else if constexpr (requires { self().element_with_rate(q_, xi_, g_, q_); }) {
      if (!self().element_with_rate(q_, xi_, g_, q_rates_[at(i)])) return false;
    } else {
      if (!self().element(q_, g_)) return false;
      self().rate(q_, g_, xi_, q_rates_[at(i)]);
    }
    motion_(t, g_, x_, xi_, x_rates_[at(i)]);
    return true;
  }
  // Onto the constraints. They must hold to a percent of the velocity before they are imposed: the
  // error of a sound step is a small part of that. It is not where the equations of motion are
  // nearly singular.
  bool settle(Node& node) const {
    constexpr double most = 0.01;
    double off = 0;  // squared, of the rows of phi, in the metric
    const int held = problem_.holonomic_rows();
    if (held > 0) {
      if (!motion_.sets_rows()) motion_.rows().set(node.t, node.g);
      gaps_.setZero();
      problem_.holonomic(from_->g, phi_);
      gaps_.tail(held) = phi_;
      problem_.holonomic(node.g, phi_);
      gaps_.tail(held) = (gaps_.tail(held) - phi_) / h_;
      off = motion_.rows().smallest(gaps_, move_);
      if (self().keeps_rows() && !onto_rows(node.g)) return false;
    }
    const auto [added, size] = motion_.settle(node.t, node.g, x_);
    lost_ = !(std::max(off, added) <= most * most * size) &&
            !(std::max(off, added) <= square_of_round_off(node));
    return !lost_;
  }
  // A velocity that moves nothing by more than the round-off of a place, or that of forces in
  // balance brings about, squared in the metric: all that there is of a motion at rest.
  [[gnu::noinline, gnu::cold]] double square_of_round_off(const Node& node) const {
    constexpr double balance = 1e-13;  // of forces and reactions, relative
    move_.setConstant(kPlaceRoundOff / h_);
    const double of_place = motion_.rows().size(move_);
    move_.setZero();
    const double of_forces = balance * h_ * motion_.rows().force_size(node.t, node.g, move_);
    return std::max(of_place * of_place, of_forces * of_forces);
  }
  // By Newton's method with the rows of the last stage.
  bool onto_rows(Element& g) const {
    const int held = problem_.holonomic_rows();
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 20; ++k) {
      problem_.holonomic(g, phi_);
      double now = 0;
      for (int i = 0; i < held; ++i) now = std::max(now, std::abs(phi_[i]));
      if (!(now < before)) break;
      before = now;
      if (now == 0) break;
      gaps_.setZero();
      gaps_.tail(held) = -phi_;
      motion_.rows().smallest(gaps_, move_);
      problem_.tau(move_, g_);
      problem_.compose(g, g_, g);
    }
    lost_ = !(before <= 1e-12);
    return !lost_;
  }

  static constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
  P problem_;
  Tableau table_;
  mutable StageMotion<P> motion_{problem_};
  const Node* from_ = nullptr;
  // Whose rates are those of the first and the last stage.
  mutable Node begin_{problem_}, end_{problem_};
  double h_ = 0;
  int evaluations_ = 0;
  Q q0_;
  mutable Element g_ = problem_.element();
  mutable Q q_ = q0_;
  mutable State x_ = State::Zero(problem_.state_size());
  mutable std::vector<Q> q_rates_ = std::vector<Q>(at(table_.all_stages()), q0_);
  mutable std::vector<State> x_rates_ = std::vector<State>(q_rates_.size(), x_);
  mutable Vector xi_ = Vector::Zero(problem_.dim()), move_ = xi_;
  mutable typename P::HolonomicValues phi_{problem_.holonomic_rows()};
  mutable typename P::Multipliers gaps_{problem_.constraint_count()};
  mutable bool lost_ = false, extended_ = false;  // by the stages of the dense output

 private:
  Derived& self() { return static_cast<Derived&>(*this); }
  const Derived& self() const { return static_cast<const Derived&>(*this); }
};

/// The classical method of order 4.
inline const Tableau& classical_rk4() {
  static constexpr double c[] = {0, 0.5, 0.5, 1, 1};
  static constexpr double a[] = {0.5, 0, 0.5, 0, 0, 1, 1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  static constexpr Tableau table = {.order = 4, .stages = 4, .c = c, .a = a};
  return table;
}

}  // namespace hamel
