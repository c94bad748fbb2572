// Members that a system's struct defines; none of them is overlooked.
//
// A member counts when it can be called in its stated form. One of that name that cannot (drift(t)
// alone, a force that is not const) would be ignored without notice, so it is refused at compile
// time: named::x<S> tests whether S has a function x of any signature. Deriving from S and from a
// struct that has an x makes the name x ambiguous exactly then.
#pragma once

#include <type_traits>
#include <utility>

#include <hamel/framework/lie/concepts.hpp>
#include <hamel/framework/mechanics/inputs.hpp>

namespace hamel {
namespace named {

struct Names {
  int constraints, drift, holonomic, potential, force, start, exact, has_exact, invariants, fields,
      draw, name, summary, formula, known, source, potential_differential, holonomic_differential,
      inertia_differential, frame, frame_rate, contacts, events, inputs, shape, at_speed, released;
};
template <class S, bool = std::is_final_v<S>>
struct Both : S, Names {};
template <class S>
struct Both<S, true> : Names {};  // nothing can derive from it

// Data may have any name: `double force`.
template <class Address>
concept Data = !std::is_member_function_pointer_v<Address> &&
               !std::is_function_v<std::remove_pointer_t<Address>>;

#define HAMEL_NAMED(member)    \
  template <class S>           \
  concept member = !requires { \
    &Both<S>::member;          \
  }                            \
  &&!requires { requires Data<decltype(&S::member)>; };
HAMEL_NAMED(constraints)
HAMEL_NAMED(drift)
HAMEL_NAMED(holonomic)
HAMEL_NAMED(potential)
HAMEL_NAMED(force)
HAMEL_NAMED(start)
HAMEL_NAMED(exact)
HAMEL_NAMED(has_exact)
HAMEL_NAMED(invariants)
HAMEL_NAMED(fields)
HAMEL_NAMED(draw)
HAMEL_NAMED(name)
HAMEL_NAMED(summary)
HAMEL_NAMED(formula)
HAMEL_NAMED(known)
HAMEL_NAMED(source)
HAMEL_NAMED(potential_differential)
HAMEL_NAMED(holonomic_differential)
HAMEL_NAMED(inertia_differential)
HAMEL_NAMED(frame)
HAMEL_NAMED(frame_rate)
HAMEL_NAMED(contacts)
HAMEL_NAMED(events)
HAMEL_NAMED(inputs)
HAMEL_NAMED(shape)
HAMEL_NAMED(at_speed)
HAMEL_NAMED(released)
#undef HAMEL_NAMED

}  // namespace named

template <class S>
using ElementOf = typename S::Group::template Element<double>;

/// The rows of constraints(), constraints(g) or constraints(t, g), from their shape.
template <class S>
constexpr int constraint_count() {
  const auto rows = []<class A>(std::type_identity<A>) {
    return std::decay_t<A>::RowsAtCompileTime;
  };
  using Element = const ElementOf<S>&;
  using Of = const S&;
  if constexpr (requires(Of s) { s.constraints(); }) {
    return rows(std::type_identity<decltype(std::declval<Of>().constraints())>{});
  } else if constexpr (requires(Of s, Element g) { s.constraints(g); }) {
    return rows(
        std::type_identity<decltype(std::declval<Of>().constraints(std::declval<Element>()))>{});
  } else if constexpr (requires(Of s, Element g) { s.constraints(0.0, g); }) {
    return rows(std::type_identity<decltype(std::declval<Of>().constraints(
                    0.0, std::declval<Element>()))>{});
  } else {
    static_assert(!named::constraints<S>,
                  "constraints of this system cannot be called: expected a const member "
                  "constraints(), constraints(g) or constraints(t, g)");
    return 0;
  }
}

/// The rows of holonomic(g).
template <class S>
constexpr int holonomic_count() {
  if constexpr (requires(const S& s, const ElementOf<S>& g) { s.holonomic(g); }) {
    return std::decay_t<decltype(std::declval<const S&>().holonomic(
        std::declval<const ElementOf<S>&>()))>::RowsAtCompileTime;
  } else {
    static_assert(
        !named::holonomic<S>,
        "holonomic of this system cannot be called: expected a const member holonomic(g)");
    return 0;
  }
}

template <class S>
constexpr bool has_potential() {
  constexpr bool has = requires(const S& s, const ElementOf<S>& g) { s.potential(g); };
  static_assert(has || !named::potential<S>,
                "potential of this system cannot be called: expected a const member potential(g)");
  return has;
}

/// Contributions of inputs, to the force and to b.
template <class S>
constexpr bool has_input_force() {
  return requires(const S& s, const ElementOf<S>& g, const Vec<S::Group::dim>& xi, InputValues u) {
    s.force(0.0, g, xi, u);
  };
}
template <class S>
constexpr bool has_input_drift() {
  return requires(const S& s, const ElementOf<S>& g, InputValues u) { s.drift(0.0, g, u); };
}
/// Does a system state inputs?
template <class S>
constexpr bool has_inputs() {
  constexpr bool states = requires(const S& s, detail::InputReader& u) { s.inputs(u); };
  static_assert(states || !named::inputs<S>,
                "inputs of this system cannot be called: expected a const member inputs(u)");
  static_assert(states == (has_input_force<S>() || has_input_drift<S>()),
                "inputs(u) goes with force(t, g, xi, u) or drift(t, g, u), which use them");
  return states;
}

/// b of A xi = b.
template <class S>
constexpr bool has_constant_drift() {
  return requires(const S& s) { s.drift(); };
}
template <class S>
constexpr bool has_drift() {
  constexpr bool has = has_constant_drift<S>() || requires(const S& s, const ElementOf<S>& g) {
    s.drift(g);
  }
  || requires(const S& s, const ElementOf<S>& g) { s.drift(0.0, g); };
  static_assert(has || has_input_drift<S>() || !named::drift<S>,
                "drift of this system cannot be called: expected a const member drift(), drift(g), "
                "drift(t, g) or, with inputs, drift(t, g, u)");
  return has;
}
template <class S>
auto drift_of(const S& system, [[maybe_unused]] double t, [[maybe_unused]] const ElementOf<S>& g) {
  if constexpr (requires { system.drift(t, g); }) return system.drift(t, g);
  else if constexpr (requires { system.drift(g); }) return system.drift(g);
  else return system.drift();
}

/// f, in the dual.
template <class S>
constexpr bool has_force() {
  using Xi = const Vec<S::Group::dim>&;
  constexpr bool has = requires(const S& s, const ElementOf<S>& g, Xi xi) { s.force(0.0, g, xi); }
  || requires(const S& s, const ElementOf<S>& g, Xi xi) { s.force(g, xi); };
  static_assert(has || has_input_force<S>() || !named::force<S>,
                "force of this system cannot be called: expected a const member force(g, xi), "
                "force(t, g, xi) or, with inputs, force(t, g, xi, u)");
  return has;
}
template <class S, class Xi>
auto force_of(const S& system, [[maybe_unused]] double t, const ElementOf<S>& g, const Xi& xi) {
  if constexpr (requires { system.force(t, g, xi); }) return system.force(t, g, xi);
  else return system.force(g, xi);
}

/// No member depends on the time.
template <class S>
constexpr bool is_autonomous() {
  using Element = const ElementOf<S>&;
  using Xi = const Vec<S::Group::dim>&;
  constexpr bool rows = requires(const S& s, Element g) { s.constraints(0.0, g); };
  constexpr bool drift = requires(const S& s, Element g) { s.drift(0.0, g); };
  constexpr bool force = requires(const S& s, Element g, Xi xi) { s.force(0.0, g, xi); };
  return !rows && !drift && !force;
}

template <class S>
concept HasConstantRows = requires(const S& s) {
  s.constraints();
};

/// Constant inertia and rows, and nothing else: the small fast path.
template <class S>
constexpr bool is_left_invariant() {
  constexpr bool constant = requires(const S& s) { s.inertia(); };
  constexpr bool constant_rows = constraint_count<S>() == 0 || HasConstantRows<S>;
  return constant && constant_rows && holonomic_count<S>() == 0 && !has_potential<S>() &&
         !has_drift<S>() && !has_force<S>();
}

template <class S>
concept RowsFit =
    !HasConstantRows<S> ||
    Shape<decltype(std::declval<const S&>().constraints()), constraint_count<S>(), S::Group::dim>;

template <class S>
concept System = requires(const S& s, const typename S::Group::template Element<double>& g) {
  requires Group<typename S::Group>;
  requires requires {
    { s.inertia() } -> Shape<S::Group::dim, S::Group::dim>;
  } || requires {
    { s.inertia(g) } -> Shape<S::Group::dim, S::Group::dim>;
  };
  requires RowsFit<S>;  // k rows of n columns, where there are any
};

}  // namespace hamel
