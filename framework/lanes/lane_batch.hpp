// The two halves of a loop in lanes: a batch, compiled for an instruction set, takes the steps of W
// bodies; what one of them needs by itself comes from the other half, compiled as the scalar
// kernels are, so that it has their bits.
#pragma once

#include <memory>
#include <span>

#include <hamel/framework/schemes/problem.hpp>

namespace hamel {

/// The step of one lane by the scalar solver. Only of schemes with an equation.
template <class P>
class LaneRescue {
 public:
  using State = typename P::State;
  /// Unknown, and what its solution leaves behind.
  struct Solve {
    State node;            // x at the beginning of the step
    State differences[6];  // of the earlier solutions, count of them (loop/extrapolation.hpp)
    int count = 0;
    State x;  // out
    typename P::StateMatrix inverse;
    bool kept = false;     // may the next solve begin with one correction by `inverse`?
    bool trusted = false;  // is x, and was what came before, the principal root?
  };
  /// false: the step fails.
  virtual bool solve(int lane, Solve& step) = 0;

 protected:
  ~LaneRescue() = default;
};

/// P: the problem of one body.
template <class P>
class LaneBatch {
 public:
  LaneBatch() = default;
  LaneBatch(const LaneBatch&) = delete;
  LaneBatch& operator=(const LaneBatch&) = delete;
  virtual ~LaneBatch() = default;
  /// count steps; lanes of which one fails are marked, and go on with numbers of no use.
  virtual void advance(long count) = 0;
  virtual bool failed(int lane) const = 0;
  /// As if nothing had been before.
  virtual void put(int lane, const Node<P>& start) = 0;
  /// previous: null where it is not wanted.
  virtual void get(int lane, Node<P>& now, Node<P>* previous) const = 0;
};

/// What the batch is made of: one step (its constants) and one problem for each lane.
template <class Step>
struct LaneSetup {
  using P = typename Step::Problem;
  std::span<const P* const> problems;
  std::span<const Step* const> steps;
  double h;
  double enough, aimed;   // residuals at which one correction is enough, and further ones end
  LaneRescue<P>* rescue;  // outlives it
};

template <class Scheme, class P>
using LaneStep = typename Scheme::template Step<P>;
template <class Scheme, class P>
using LaneMaker = std::unique_ptr<LaneBatch<P>> (*)(const LaneSetup<LaneStep<Scheme, P>>& setup);

}  // namespace hamel
