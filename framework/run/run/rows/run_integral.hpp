// Integral over a run of a rate of its states, of which the nodes and some states within steps are
// known, at the recorded states. Not installed.
#pragma once

#include <memory>
#include <vector>

#include <hamel/framework/loop/snapshot.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/run/run/rows/nodal_quadrature.hpp>

namespace hamel {

class RunIntegral {
 public:
  /// inputs: of the run, null without: where one of them jumps the quadrature begins anew.
  explicit RunIntegral(std::shared_ptr<const Inputs> inputs = nullptr)
      : inputs_(std::move(inputs)), changes_(inputs_ != nullptr ? inputs_->changes() : 0) {}

  /// A node, from the start on; a state within a step that has no end yet. rate(Snapshot) -> double
  template <class Rate>
  void node(const Snapshot& state, const Rate& rate) {
    add(state, rate);
    if (inputs_ != nullptr) last_ = state;
    if (quadrature_.settled()) settle();
  }
  template <class Rate>
  void within(const Snapshot& state, const Rate& rate) {
    add(state, rate);
    if (quadrature_.settled()) settle();
  }
  /// Has the rate been 0 since it last began? A node at which it is 0 may then be left out. Rows
  /// that wait are complete.
  bool rests() {
    if (!quadrature_.rests() || (inputs_ != nullptr && inputs_->changes() != changes_))
      return false;
    settle();
    return true;
  }
  /// A recorded state, between the last two nodes or one of them.
  void row(double time) {
    waiting_.push_back(time);
    if (quadrature_.settled()) settle();
  }
  /// An event changed the state at the last node.
  template <class Rate>
  void impact(const Snapshot& after, const Rate& rate) {
    break_off(after, rate);
    last_ = after;
  }
  /// After the last node: no row waits.
  void finish() { settle(); }
  /// The integral at the recorded states that are complete by now and were not taken before, in
  /// their order: one waits for the first nodes of the quadrature.
  void settled(std::vector<double>& out) {
    out.clear();
    out.swap(settled_);
  }

  template <class Archive>
  void serialize(Archive& archive) {
    // After a resume Inputs::changes() restarts from zero; only whether a change is pending is
    // saved.
    bool changed = inputs_ != nullptr && inputs_->changes() != changes_;
    archive(changed, last_, quadrature_, done_, started_, waiting_, settled_);
    if (inputs_ != nullptr) changes_ = inputs_->changes() - (changed ? 1 : 0);
  }

 private:
  template <class Rate>
  void add(const Snapshot& state, const Rate& rate) {
    if (inputs_ != nullptr) {
      if (inputs_->changes() != changes_ && started_) break_off(last_, rate);
      changes_ = inputs_->changes();
    }
    const double now = rate(state);
    if (started_ && !quadrature_.joins(state.time)) settle();
    quadrature_.add(state.time, now);
    started_ = true;
  }
  // The quadrature begins anew at a node: an input jumps or has a kink there, and so has the rate,
  // or the state does.
  template <class Rate>
  void break_off(const Snapshot& at, const Rate& rate) {
    settle();
    done_ += quadrature_.whole();  // the end of a slip, of no power, may lie between it and `at`
    quadrature_ = NodalQuadrature();
    quadrature_.add(at.time, rate(at));
  }
  void settle() {
    for (const double time : waiting_) settled_.push_back(done_ + quadrature_.value(time));
    waiting_.clear();
  }

  std::shared_ptr<const Inputs> inputs_;
  long changes_ = 0;            // of the inputs, seen
  Snapshot last_;               // node, where there are inputs
  NodalQuadrature quadrature_;  // since it began, when the integral was done_
  double done_ = 0;
  bool started_ = false;
  std::vector<double> waiting_, settled_;  // times; values
};

}  // namespace hamel
