// What the stages of an explicit scheme carry beside the element, and its rate: y of the frame that
// the system states (mechanics/framed_equations.hpp), else the velocity in the problem's own
// coordinates (mechanics/equations_of_motion.hpp).
#pragma once

#include <utility>

#include <hamel/framework/mechanics/equations_of_motion.hpp>

namespace hamel {

namespace detail {
template <class P>
struct StageOf {
  using type = typename P::State;
};
template <class P>
requires requires { typename P::Stage; }
struct StageOf<P> {
  using type = typename P::Stage;
};
}  // namespace detail

template <class P>
class StageMotion {
 public:
  using Problem = OfMotion<P>;
  using Element = typename P::Element;
  using Vector = typename P::Vector;
  using State = typename P::State;
  using Stage = typename detail::StageOf<P>::type;

  explicit StageMotion(const P& problem) : problem_(problem), equations_(problem_) {}

  /// Does the system state a frame? Known at compile time where its type is.
  constexpr bool framed() const {
    if constexpr (kFrame == Frame::never) return false;
    else if constexpr (kFrame == Frame::always) return true;
    else return problem_.framed();
  }
  int size() const {
    if constexpr (kFrame == Frame::sometimes) {
      if (framed()) return problem_.framed_size();
    }
    if constexpr (kFrame == Frame::always) return Stage::RowsAtCompileTime;
    else return problem_.state_size();
  }
  /// What is carried at a node of velocity x.
  void begin(const State& x, Stage& y) const { y = x.head(y.size()); }
  /// The velocity of a node at which y and xi are carried.
  void end(const Stage& y, const Vector& xi, State& x) const {
    if constexpr (P::left_invariant) x = y;
    else x = xi;
  }
  /// xi of y, where it does not depend on the element.
  void velocity(const Stage& y, Vector& xi) const {
    if constexpr (kFrame != Frame::always) {
      if (!framed()) problem_.velocity(y, xi);
    }
  }
  /// xi of y at g.
  void expand(const Element& g, const Stage& y, Vector& xi) const {
    if constexpr (kFrame != Frame::never) {
      if (framed()) return problem_.expand(g, y, xi);
    }
    velocity(y, xi);
  }
  /// y' at (t, g, y), and xi in a frame; without one xi is left as it is.
  void operator()(double t, const Element& g, const Stage& y, Vector& xi, Stage& rate) {
    if constexpr (kFrame != Frame::never) {
      if (framed()) return problem_.framed_motion(t, g, y, xi, rate);
    }
    if constexpr (kFrame != Frame::always) equations_(t, g, y, rate);
  }
  /// Moves the velocity y onto A xi = b at (t, g); returns the squared sizes of what was added, and
  /// of the velocity. In a frame it is there.
  std::pair<double, double> settle(double t, const Element& g, Stage& y) {
    if constexpr (kFrame != Frame::always) {
      if (!framed()) {
        equations_.set(t, g);
        return equations_.project(y);
      }
    }
    Vector xi(problem_.dim());
    expand(g, y, xi);
    const double size = equations_.size(xi);
    return {0, size * size};
  }
  /// The rows and the metric of the last set() or evaluation without a frame.
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

  Problem problem_;
  EquationsOfMotion<Problem> equations_;
};

}  // namespace hamel
