// W bodies of a left-invariant system at once: the batch of a scheme for an instruction set.
//
// A step with an equation is the scalar kernel's usual one: the extrapolation of earlier solutions,
// one correction with the Jacobian kept (solvers/newton.hpp). Lanes for which that is not enough,
// or which keep none, are solved one by one by the scalar solver, and go on with the others. An
// explicit step that leaves its domain fails in its lane.
#pragma once

#include <array>
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

/// Nodes of W bodies, and what is done to them between steps.
template <class P, class T>
class LaneNodes : public LaneBatch<P> {
 public:
  using Problem = typename P::template Over<T>;
  static constexpr int width = T::width;

  bool failed(int lane) const override { return failed_[static_cast<std::size_t>(lane)]; }
  void put(int lane, const hamel::Node<P>& start) override {
    put_lane(nodes_.now().g, lane, start.g);
    put_lane(nodes_.now().x, lane, start.x);
    nodes_.now().t = start.t;
    nodes_.previous() = nodes_.now();
    failed_[static_cast<std::size_t>(lane)] = false;
    nodes_.count_anew();
    forget();
  }
  void get(int lane, hamel::Node<P>& now, hamel::Node<P>& previous) const override {
    get_lane(nodes_.now().g, lane, now.g);
    get_lane(nodes_.now().x, lane, now.x);
    now.t = nodes_.now().t;
    get_lane(nodes_.previous().g, lane, previous.g);
    get_lane(nodes_.previous().x, lane, previous.x);
    previous.t = nodes_.previous().t;
  }

 protected:
  LaneNodes(const EachBody<P>& problems, double h) : problem_(problems), h_(h), nodes_(problem_) {}

  virtual void forget() = 0;
  void fail(int lane) { failed_[static_cast<std::size_t>(lane)] = true; }
  Problem problem_;
  double h_;
  NodeRing<Problem> nodes_;

 private:
  std::array<bool, static_cast<std::size_t>(width)> failed_ = {};
};

/// With an equation.
template <class Scheme, class P, class T>
class ImplicitLanes final : public LaneNodes<P, T> {
  using Base = LaneNodes<P, T>;
  using One = LaneStep<Scheme, P>;
  using Step = LaneStep<Scheme, typename Base::Problem>;
  using Unknown = typename Step::Unknown;
  using Mask = typename T::Mask;
  using Base::width;

 public:
  ImplicitLanes(const LaneSetup<One>& setup)
      : Base(EachBody<P>({setup.problems.begin(), setup.problems.end()}), setup.h),
        step_(std::type_identity<One>(), EachBody<One>({setup.steps.begin(), setup.steps.end()})),
        target_(setup.tolerance * setup.tolerance),
        rescue_(setup.rescue) {
    inverse_.setIdentity();
  }
  void advance(long count) override {
    const FlushDenormals flushed;
    for (long k = 0; k < count; ++k) {
      if (!step()) [[unlikely]] {
        solve_one_by_one();
        finish();
      }
      this->nodes_.turn(this->problem_);
    }
  }

 private:
  // One correction of the extrapolation, and the next node. false: that is not enough in all lanes.
  HAMEL_FLATTEN bool step() {
    step_.begin(this->nodes_.now(), this->h_);
    Unknown x, f;
    if (history_.count() == 0) [[unlikely]]
      step_.guess(x);
    else history_(x);
    step_.residual(x, f);
    x = x - inverse_.lazyProduct(f);
    step_.residual(x, f);
    const Mask good = kept_ && f.squaredNorm().v <= target_ * step_.scale_squared().v;
    if (!xsimd::all(good) || !step_.finish(x, this->nodes_.next())) [[unlikely]] {
      x_ = x;
      good_ = good;
      return false;
    }
    history_.push(x);
    return true;
  }
  // Behind solve_one_by_one.
  [[gnu::noinline, gnu::cold]] void finish() {
    if (!step_.finish(x_, this->nodes_.next())) fail_where_not_finite();
    history_.push(x_);
  }
  [[gnu::noinline, gnu::cold]] void solve_one_by_one() {
    alignas(64) bool fine[width];
    good_.store_aligned(fine);
    alignas(64) bool kept[width];
    kept_.store_aligned(kept);
    typename LaneRescue<P>::Solve solve;
    for (int lane = 0; lane < width; ++lane) {
      if (fine[lane] || this->failed(lane)) continue;
      get_lane(this->nodes_.now().x, lane, solve.node);
      solve.count = history_.count();
      for (int j = 0; j < solve.count; ++j)
        get_lane(history_.differences()[static_cast<std::size_t>(j)], lane, solve.differences[j]);
      if (!rescue_->solve(lane, solve)) {
        this->fail(lane);
        solve.x.setZero();
        solve.inverse.setZero();
        solve.kept = false;
      }
      put_lane(x_, lane, solve.x);
      put_lane(inverse_, lane, solve.inverse);
      kept[lane] = solve.kept;
    }
    kept_ = Mask::load_aligned(kept);
  }
  [[gnu::noinline, gnu::cold]] void fail_where_not_finite() {
    for (int lane = 0; lane < width; ++lane) {
      typename P::State x;
      get_lane(x_, lane, x);
      if (!(x.squaredNorm() < std::numeric_limits<double>::infinity())) this->fail(lane);
    }
  }
  void forget() override {
    history_.clear_history();
    kept_ = Mask(false);
  }

  Step step_;
  double target_;
  LaneRescue<P>* rescue_;
  Unknown x_ = Unknown::Zero();
  typename Step::Jacobian inverse_;
  Mask kept_ = Mask(false), good_ = kept_;
  Extrapolation<Unknown> history_{Unknown::Zero()};
};

/// Without one, given by its tableau.
template <class Scheme, class P, class T>
class ExplicitLanes final : public LaneNodes<P, T> {
  using Base = LaneNodes<P, T>;
  using Step = LaneStep<Scheme, typename Base::Problem>;

 public:
  explicit ExplicitLanes(const LaneSetup<LaneStep<Scheme, P>>& setup)
      : Base(EachBody<P>({setup.problems.begin(), setup.problems.end()}), setup.h),
        step_(this->problem_, Scheme::tableau()) {}
  HAMEL_FLATTEN void advance(long count) override {
    const FlushDenormals flushed;
    for (long k = 0; k < count; ++k) {
      step_.begin(this->nodes_.now(), this->h_);
      if (!step_.finish(this->nodes_.next())) [[unlikely]]
        fail_where_not_finite();
      this->nodes_.turn(this->problem_);
    }
  }

 private:
  [[gnu::noinline, gnu::cold]] void fail_where_not_finite() {
    for (int lane = 0; lane < Base::width; ++lane) {
      typename P::State x;
      get_lane(this->nodes_.next().x, lane, x);
      if (!(x.squaredNorm() < std::numeric_limits<double>::infinity())) this->fail(lane);
    }
  }
  void forget() override { step_.clear_history(); }

  Step step_;
};

template <class Scheme, class P, class Arch>
std::unique_ptr<LaneBatch<P>> make_lanes(const LaneSetup<LaneStep<Scheme, P>>& setup) {
  if constexpr (requires { Scheme::tableau(); })
    return std::make_unique<ExplicitLanes<Scheme, P, Lane<Arch>>>(setup);
  else return std::make_unique<ImplicitLanes<Scheme, P, Lane<Arch>>>(setup);
}

}  // namespace hamel
