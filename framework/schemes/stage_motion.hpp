// The equations of motion as the stages of an explicit scheme evaluate them: in the frame that the
// system states (mechanics/framed_equations.hpp), else with multipliers
// (metric/equations_of_motion.hpp).
#pragma once

#include <utility>

#include <hamel/framework/metric/equations_of_motion.hpp>

namespace hamel {

template <class P>
class StageMotion {
 public:
  using Problem = OfMotion<P>;
  using Element = typename P::Element;
  using Vector = typename P::Vector;
  using State = typename P::State;

  explicit StageMotion(const P& problem) : problem_(problem), equations_(problem_) {}

  /// Does the system state a frame? Known at compile time where its type is.
  constexpr bool framed() const {
    if constexpr (kFrame == Frame::never) return false;
    else if constexpr (kFrame == Frame::always) return true;
    else return problem_.framed();
  }
  /// The rate of x at (t, g). In a frame the first entries y of x decide, xi = E(g) y is set, and
  /// the other entries are integrated to be compared with it; without one xi is left as it is.
  void operator()(double t, const Element& g, const State& x, Vector& xi, State& rate) {
    if constexpr (kFrame != Frame::never) {
      if (framed()) return problem_.framed_motion(t, g, x, xi, rate);
    }
    if constexpr (kFrame != Frame::always) equations_(t, g, x, rate);
  }
  /// Moves the velocity x onto A xi = b at (t, g): in a frame to E(g) y, else orthogonally in the
  /// metric I. Returns the squared sizes of what was added, and of the velocity.
  std::pair<double, double> settle(double t, const Element& g, State& x) {
    if constexpr (kFrame == Frame::always) return onto_frame(t, g, x);
    else if constexpr (kFrame == Frame::never) return onto_rows(t, g, x);
    else return framed() ? onto_frame(t, g, x) : onto_rows(t, g, x);
  }
  /// Has the last evaluation set rows()?
  bool sets_rows() const { return !framed() && !equations_.gives_accelerations(); }
  /// The rows and the metric of the last set() or evaluation that sets them.
  EquationsOfMotion<Problem>& rows() { return equations_; }

 private:
  enum class Frame { never, sometimes, always };
  static constexpr Frame kFrame = [] {
    if constexpr (requires { std::bool_constant<Problem::framed()>(); })
      return Problem::framed() ? Frame::always : Frame::never;
    else if constexpr (requires(const Problem& problem) { problem.framed(); })
      return Frame::sometimes;
    else return Frame::never;
  }();

  std::pair<double, double> onto_rows(double t, const Element& g, State& x) {
    equations_.set(t, g);
    return equations_.project(x);
  }
  std::pair<double, double> onto_frame(double t, const Element& g, State& x) {
    if (!known_ || !problem_.constant_inertia()) equations_.set(t, g);
    known_ = true;
    added_ = x;
    problem_.expand(g, added_, x);
    added_ -= x;
    const double added = equations_.size(added_), size = equations_.size(x);
    return {added * added, size * size};
  }

  Problem problem_;
  EquationsOfMotion<Problem> equations_;
  bool known_ = false;  // the metric
  State added_ = State::Zero(problem_.state_size());
};

}  // namespace hamel
