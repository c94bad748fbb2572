// Names close to those of a system's members: the singular or plural, a longer form, a common
// misspelling. A function of such a name would never be called, and constraint()
// for constraints() would run an unconstrained body without notice: it is refused at compile time
// where the member itself is not there.
#pragma once

#include <hamel/framework/mechanics/system_members.hpp>

// clang-format off
#define HAMEL_CLOSE_NAMES(X) \
  X(constraints, constrains, constraint, constraint_matrix, constraint_rows, contraints)           \
  X(drift, drifts)                                                                                \
  X(holonomic, holonomic_constraint, holonomic_constraints, holonomic_rows, holonomics)            \
  X(potential, potencial, potential_energy, potentials)                                           \
  X(force, forces)                                                                                \
  X(start, starts)                                                                                \
  X(at_speed, at_speeds, start_at_speed)                                                          \
  X(exact, exact_motion, exact_solution)                                                          \
  X(has_exact, has_exact_motion, has_exact_solution)                                              \
  X(invariants, invariant, invarients)                                                            \
  X(contacts, contact, normal_reactions)                                                          \
  X(events, event)                                                                                \
  X(inputs, input)                                                                                \
  X(fields, feilds, field)                                                                        \
  X(potential_differential, potential_differentials)                                              \
  X(holonomic_differential, holonomic_differentials)                                              \
  X(inertia_differential, inertia_differentials)
// clang-format on

// HAMEL_EACH(f, member, a, b, ...): f(member, a) f(member, b) ..., for up to 64 names.
#define HAMEL_PARENTHESES ()
#define HAMEL_SCAN(...) HAMEL_SCAN3(HAMEL_SCAN3(HAMEL_SCAN3(HAMEL_SCAN3(__VA_ARGS__))))
#define HAMEL_SCAN3(...) HAMEL_SCAN2(HAMEL_SCAN2(HAMEL_SCAN2(HAMEL_SCAN2(__VA_ARGS__))))
#define HAMEL_SCAN2(...) HAMEL_SCAN1(HAMEL_SCAN1(HAMEL_SCAN1(HAMEL_SCAN1(__VA_ARGS__))))
#define HAMEL_SCAN1(...) __VA_ARGS__
#define HAMEL_EACH(f, member, ...) __VA_OPT__(HAMEL_SCAN(HAMEL_EACH_STEP(f, member, __VA_ARGS__)))
#define HAMEL_EACH_STEP(f, member, name, ...) \
  f(member, name) __VA_OPT__(HAMEL_EACH_AGAIN HAMEL_PARENTHESES(f, member, __VA_ARGS__))
#define HAMEL_EACH_AGAIN() HAMEL_EACH_STEP

namespace hamel {
namespace named {

#define HAMEL_DECLARE(member, name) int name;
#define HAMEL_DECLARE_ALL(member, ...) HAMEL_EACH(HAMEL_DECLARE, member, __VA_ARGS__)
struct CloseNames {
  HAMEL_CLOSE_NAMES(HAMEL_DECLARE_ALL)
};
#undef HAMEL_DECLARE_ALL
#undef HAMEL_DECLARE
template <class S, bool = std::is_final_v<S>>
struct WithClose : S, CloseNames {};
template <class S>
struct WithClose<S, true> : CloseNames {};  // nothing can derive from it

}  // namespace named

/// Refuses a system that has a function of a close name and not the member itself.
template <class S>
constexpr void refuse_misspelt() {
#define HAMEL_REFUSE(member, name)                                                      \
  static_assert(                                                                        \
      named::member<S> || requires { &named::WithClose<S>::name; } ||                   \
          requires { requires named::Data<decltype(&S::name)>; },                       \
      "this system has a function '" #name "', which is never called, and no '" #member \
      "': did you mean that?");
#define HAMEL_REFUSE_ALL(member, ...) HAMEL_EACH(HAMEL_REFUSE, member, __VA_ARGS__)
  HAMEL_CLOSE_NAMES(HAMEL_REFUSE_ALL)
#undef HAMEL_REFUSE_ALL
#undef HAMEL_REFUSE
}

}  // namespace hamel

#undef HAMEL_CLOSE_NAMES
#undef HAMEL_PARENTHESES
#undef HAMEL_SCAN
#undef HAMEL_SCAN3
#undef HAMEL_SCAN2
#undef HAMEL_SCAN1
#undef HAMEL_EACH
#undef HAMEL_EACH_STEP
#undef HAMEL_EACH_AGAIN
