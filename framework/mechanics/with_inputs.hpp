// A system with its inputs: itself a system, whose force and drift are those of S and what the
// inputs add at the time.
//
//   force(t, g, xi) + force(t, g, xi, u(t)),   drift(t, g) + drift(t, g, u(t))
// A run with inputs is one of WithInputs<S>, so that no scheme, problem or measurement depends on
// them, and a run without is one of S.
#pragma once

#include <memory>
#include <utility>

#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/mechanics/system_members.hpp>

namespace hamel {

/// S with the inputs of a run.
template <class S>
struct GivenInputs : S {
  std::shared_ptr<const Inputs> given;
  GivenInputs(const S& system, std::shared_ptr<const Inputs> inputs)
      : S(system), given(std::move(inputs)) {}
  const S& itself() const { return *this; }
};

/// The part of b that inputs give, where they give one.
template <class S, bool = has_input_drift<S>()>
struct InputRows : GivenInputs<S> {
  using GivenInputs<S>::GivenInputs;
};
template <class S>
struct InputRows<S, true> : GivenInputs<S> {
  using GivenInputs<S>::GivenInputs;
  Vec<constraint_count<S>()> drift(double t, const ElementOf<S>& g) const {
    Vec<constraint_count<S>()> b = this->itself().drift(t, g, this->given->at(t));
    if constexpr (has_drift<S>()) b += drift_of(this->itself(), t, g);
    return b;
  }
};

/// And the force.
template <class S, bool = has_input_force<S>()>
struct WithInputs : InputRows<S> {
  using InputRows<S>::InputRows;
};
template <class S>
struct WithInputs<S, true> : InputRows<S> {
  using InputRows<S>::InputRows;
  static constexpr int n = S::Group::dim;
  Vec<n> force(double t, const ElementOf<S>& g, const Vec<n>& xi) const {
    Vec<n> f = this->itself().force(t, g, xi, this->given->at(t));
    if constexpr (has_force<S>()) f += force_of(this->itself(), t, g, xi);
    return f;
  }
};

}  // namespace hamel
