// W bodies of a left-invariant system at once: the batch of a scheme for an instruction set.
//
// A step with an equation is the scalar kernel's: the extrapolation of earlier solutions and one
// correction with the Jacobian kept; in lanes for which that is not enough, Newton's iteration from
// new Jacobians (solvers/newton.hpp), where the step states them over lanes. Lanes that need more
// than its usual course, or keep no trusted solution, are solved one by one by the scalar solver,
// and go on with the others. An explicit step that leaves its domain fails in its lane.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include <hamel/framework/lanes/lane.hpp>
#include <hamel/framework/lanes/lane_batch.hpp>
#include <hamel/framework/lie/types.hpp>
#include <hamel/framework/loop/denormals.hpp>
#include <hamel/framework/loop/extrapolation.hpp>
#include <hamel/framework/loop/node_ring.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

/// Nodes of the bodies in one register, and what is done to them between steps.
template <class P, class T>
class LaneNodes {
 public:
  using Problem = typename P::template Over<T>;
  static constexpr int width = T::width;

  bool failed(int lane) const { return get_lane<T>(failed_, lane); }
  void put(int lane, const hamel::Node<P>& start) {
    put_lane(nodes_.now().g, lane, start.g);
    put_lane(nodes_.now().x, lane, start.x);
    nodes_.now().t = start.t;
    nodes_.previous() = nodes_.now();
    set_lane<T>(failed_, lane, false);
    nodes_.count_anew();
  }
  void get(int lane, hamel::Node<P>& now, hamel::Node<P>* previous) const {
    get_node(nodes_.now(), lane, now);
    if (previous != nullptr) get_node(nodes_.previous(), lane, *previous);
  }

 protected:
  using Mask = typename T::Mask;
  LaneNodes(const EachBody<P>& problems, double h) : problem_(problems), h_(h), nodes_(problem_) {}
  static void get_node(const hamel::Node<Problem>& from, int lane, hamel::Node<P>& to) {
    get_lane(from.g, lane, to.g);
    get_lane(from.x, lane, to.x);
    to.t = from.t;
  }

  Problem problem_;
  double h_;
  NodeRing<Problem> nodes_;
  Mask failed_ = Mask(false);  // (in braces: a list of lanes)
};

/// With an equation.
template <class Scheme, class P, class T>
class ImplicitLanes : public LaneNodes<P, T> {
  using Base = LaneNodes<P, T>;
  using One = LaneStep<Scheme, P>;
  using Step = LaneStep<Scheme, typename Base::Problem>;
  using Unknown = typename Step::Unknown;
  using Jacobian = typename Step::Jacobian;
  using typename Base::Mask;

 public:
  using Base::width;
  /// first: the lane of the batch that is the first one here.
  ImplicitLanes(const LaneSetup<One>& setup, int first)
      : Base(EachBody<P>(setup.problems, first, width), setup.h),
        step_(std::type_identity<One>(), EachBody<One>(setup.steps, first, width)),
        enough_(setup.enough * setup.enough),
        aimed_(setup.aimed * setup.aimed),
        rescue_(setup.rescue),
        first_(first) {
    inverse_.setIdentity();
  }
  void put(int lane, const hamel::Node<P>& start) {
    Base::put(lane, start);
    history_.clear_history();
    kept_ = trusted_ = Mask(false);
  }
  /// Steps of two registers' bodies. Solving for x is a chain of operations that wait for each
  /// other; the processor fills it with the other register's element, which waits for nothing.
  HAMEL_FLATTEN static void advance(ImplicitLanes& a, ImplicitLanes& b, long count) {
    if (count <= 0) return;
    Unknown x, z;
    a.predict(x);
    a.correct(x);
    b.predict(z);
    a.move(x);
    b.correct(z);
    for (long k = 1; k < count; ++k) {
      a.predict(x);
      b.move(z);
      a.correct(x);
      b.predict(z);
      a.move(x);
      b.correct(z);
    }
    b.move(z);
  }

 private:
  // The extrapolation, corrected once with the Jacobian kept.
  void predict(Unknown& x) {
    Unknown f;
    step_.begin(this->nodes_.now(), this->h_);
    guess(x);
    step_.residual(x, f);
    x = x - inverse_.lazyProduct(f);
  }
  // Where that is not enough: the solution by other means. Then the state at the next node.
  void correct(Unknown& x) {
    Unknown f;
    step_.residual(x, f);
    step_.finish_state(x, this->nodes_.next());
    const Mask good =
        (kept_ && at_most(f.squaredNorm(), enough_ * step_.scale_squared())) || this->failed_;
    if (!xsimd::all(good)) [[unlikely]]
      solve_others(x, good);
    history_.push(x);
  }
  void move(const Unknown& x) {
    step_.finish_element(x, this->nodes_.next());
    this->nodes_.turn(this->problem_);
  }
  void guess(Unknown& x) const {
    if (history_.count() == 0) [[unlikely]]
      step_.guess(x);
    else history_(x);
  }
  // In the lanes that are not good.
  [[gnu::noinline]] void solve_others(Unknown& x, const Mask& good) {
    Mask solved = good;
    if constexpr (requires(Jacobian j) { step_.linearise(x, x, j); }) {
      if (history_.count() > 0) solved = solved || iterate(trusted_ && !good, x);
    }
    if (!xsimd::all(solved)) solve_one_by_one(solved, x);
    step_.finish_state(x, this->nodes_.next());
  }
  // As Newton::iterate from the guess, in the lanes of `open`: while each correction reduces |F|,
  // and to a solution near the guess if it took several. Returns the lanes that it solved.
  HAMEL_FLATTEN [[gnu::noinline]] Mask iterate(const Mask& open, Unknown& result) {
    constexpr int kMost = 8;
    Unknown first, trial, trial_f;
    guess(first);
    Unknown x = first, f = Unknown::Zero();
    Jacobian inverse = inverse_;
    const T scale = step_.scale_squared(), aimed = aimed_ * scale;
    T size(0.0);
    Mask running = open && below(0.0, scale), valid(false), kept(false), solved(false);
    for (int k = 1; k <= kMost && xsimd::any(running); ++k) {
      if (const Mask renewed = running && !valid; xsimd::any(renewed)) {
        Jacobian j;
        step_.linearise(x, f, j);
        size = f.squaredNorm();
        inverse = chosen(renewed, Jacobian(j.inverse()), inverse);
      }
      trial = x - inverse.lazyProduct(f);
      step_.residual(trial, trial_f);
      const T after = trial_f.squaredNorm();
      running = running && below(after, size) && below(size, kInfinite);
      valid = at_most(after, 0.01 * size);
      x = chosen(running, trial, x);
      f = trial_f;
      size = after;
      const Mask done = running && at_most(after, aimed);
      if (k == 1) {
        kept = done && valid;
        solved = done;
      } else {
        solved = solved || (done && at_most((x - first).squaredNorm(), 1e-4 * x.squaredNorm()));
      }
      running = running && !done;
    }
    result = chosen(solved, x, result);
    inverse_ = chosen(solved, inverse, inverse_);
    kept_ = (solved && kept) || (!solved && kept_);
    return solved;
  }
  // a in the lanes of a mask, b in the others.
  template <class M>
  static M chosen(const Mask& mask, const M& a, const M& b) {
    M out;
    for (Eigen::Index i = 0; i < out.size(); ++i)
      out.data()[i] = select(mask, a.data()[i], b.data()[i]);
    return out;
  }
  [[gnu::noinline, gnu::cold]] void solve_one_by_one(const Mask& solved, Unknown& x) {
    typename LaneRescue<P>::Solve solve;
    for (int lane = 0; lane < width; ++lane) {
      if (get_lane<T>(solved, lane)) continue;
      get_lane(this->nodes_.now().x, lane, solve.node);
      solve.count = history_.count();
      for (int j = 0; j < solve.count; ++j)
        get_lane(history_.differences()[static_cast<std::size_t>(j)], lane, solve.differences[j]);
      if (!rescue_->solve(first_ + lane, solve)) {
        set_lane<T>(this->failed_, lane, true);
        solve.x.setZero();
        solve.inverse.setZero();
        solve.kept = solve.trusted = false;
      }
      put_lane(x, lane, solve.x);
      put_lane(inverse_, lane, solve.inverse);
      set_lane<T>(kept_, lane, solve.kept);
      set_lane<T>(trusted_, lane, solve.trusted);
    }
  }

  static constexpr double kInfinite = std::numeric_limits<double>::infinity();
  Step step_;
  double enough_, aimed_;
  LaneRescue<P>* rescue_;
  int first_;
  Jacobian inverse_;
  Mask kept_ = Mask(false), trusted_ = kept_;
  Extrapolation<Unknown> history_{Unknown::Zero()};
};

/// Without one, given by its tableau.
template <class Scheme, class P, class T>
class ExplicitLanes : public LaneNodes<P, T> {
  using Base = LaneNodes<P, T>;
  using Step = LaneStep<Scheme, typename Base::Problem>;

 public:
  ExplicitLanes(const LaneSetup<LaneStep<Scheme, P>>& setup, int first)
      : Base(EachBody<P>(setup.problems, first, Base::width), setup.h),
        step_(this->problem_, Scheme::tableau()) {}
  void put(int lane, const hamel::Node<P>& start) {
    Base::put(lane, start);
    step_.clear_history();
  }
  static void advance(ExplicitLanes& a, ExplicitLanes& b, long count) {
    for (long k = 0; k < count; ++k) {
      a.step();
      b.step();
    }
  }

 private:
  HAMEL_FLATTEN [[gnu::noinline]] void step() {
    step_.begin(this->nodes_.now(), this->h_);
    step_.finish(this->nodes_.next());
    if (step_.not_finite()) [[unlikely]]
      fail_where_not_finite();
    this->nodes_.turn(this->problem_);
  }

  // These lanes continue from rest, where their numbers remain finite.
  [[gnu::noinline, gnu::cold]] void fail_where_not_finite() {
    auto& next = this->nodes_.next();
    for (int lane = 0; lane < Base::width; ++lane) {
      double sum = 0;
      const auto add = [&](const auto& x, const auto& /*x*/) { sum += x.get(lane); };
      each_number(next.g, next.g, add);
      each_number(next.x, next.x, add);
      if (std::isfinite(sum)) continue;
      set_lane<T>(this->failed_, lane, true);
      put_lane(next.g, lane, P::element());
      put_lane(next.x, lane, typename P::State(P::State::Zero()));
    }
  }

  Step step_;
};

/// A batch of two registers, whose steps alternate: one step is mostly a chain of operations that
/// wait for each other, and the processor has begun the other register's before it ends.
template <class P, class Lanes>
class LanePair final : public LaneBatch<P> {
  static constexpr int width = Lanes::width;

 public:
  static constexpr int lanes = 2 * width;
  template <class Setup>
  explicit LanePair(const Setup& setup) : parts_{Lanes(setup, 0), Lanes(setup, width)} {}
  void advance(long count) override {
    const FlushDenormals flushed;
    Lanes::advance(parts_[0], parts_[1], count);
  }
  bool failed(int lane) const override { return parts_[lane / width].failed(lane % width); }
  void put(int lane, const Node<P>& start) override {
    parts_[lane / width].put(lane % width, start);
  }
  void get(int lane, Node<P>& now, Node<P>* previous) const override {
    parts_[lane / width].get(lane % width, now, previous);
  }

 private:
  Lanes parts_[2];
};

template <class Scheme, class P, class Arch>
struct LanesOf {
  using type = LanePair<P, ImplicitLanes<Scheme, P, Lane<Arch>>>;
};
template <class Scheme, class P, class Arch>
requires requires { Scheme::tableau(); }
struct LanesOf<Scheme, P, Arch> {
  using type = LanePair<P, ExplicitLanes<Scheme, P, Lane<Arch>>>;
};
template <class Scheme, class P, class Arch>
std::unique_ptr<LaneBatch<P>> make_lanes(const LaneSetup<LaneStep<Scheme, P>>& setup) {
  return std::make_unique<typename LanesOf<Scheme, P, Arch>::type>(setup);
}

}  // namespace hamel
