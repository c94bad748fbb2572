// Names close to those of a system's members: a letter left out or exchanged with its neighbour,
// the singular, a longer form. A function of such a name would never be called, and constraint()
// for constraints() would run an unconstrained body without a word: it is refused at compile time
// where the member itself is not there. Words of their own (star, stat, fore) are left out.
#pragma once

#include <hamel/framework/mechanics/system_members.hpp>

// clang-format off
#define HAMEL_CLOSE_NAMES(X) \
  X(constraints, cnostraints, cnstraints, consraints, consrtaints, constaints, constarints,       \
    constrains, constrainst, constraint, constraint_matrix, constraint_rows, constraitns,         \
    constraits, constranits, constrants, constriants, constrints, contraints, contsraints,        \
    cosntraints, costraints)                                                                      \
  X(drift, dift, dirft, drfit, drft, drif, drifts, drit, dritf)                                   \
  X(holonomic, hlonomic, hloonomic, holnomic, holnoomic, holonmic, holonmoic, holonoic,           \
    holonoimc, holonomc, holonomci, holonomi, holonomic_constraint, holonomic_constraints,        \
    holonomic_rows, holonomics, holoomic, holoonmic, hoolnomic, hoonomic)                         \
  X(potential, poential, poetntial, potencial, potenial, potenital, potentail, potental,          \
    potential_energy, potentials, potentil, potentila, potetial, potetnial, potnetial, potntial,  \
    ptential, ptoential)                                                                          \
  X(force, foce, focre, forc, forces, forec, frce, froce)                                         \
  X(start, sart, satrt, starts, statr, strt)                                                      \
  X(at_speed, a_speed, a_tspeed, at_peed, at_pseed, at_sped, at_spede, at_spee, at_speeds, atspeed, \
    start_at_speed)                                                                               \
  X(exact, eact, eaxct, exac, exact_motion, exact_solution, exat, exatc, excat, exct)             \
  X(has_exact, ha_exact, ha_sexact, has_eact, has_eaxct, has_exac, has_exact_motion,              \
    has_exact_solution, has_exat, has_exatc, has_excat, has_exct, has_xact, has_xeact,            \
    hase_xact, hasexact, hs_exact, hsa_exact)                                                     \
  X(invariants, inariants, inavriants, invaiants, invairants, invaraints, invarants, invarians,   \
    invarianst, invariant, invariatns, invariats, invarients, invarinats, invarints, invraiants,  \
    invriants, ivariants, ivnariants)                                                             \
  X(contacts, contact, contacs, contatcs, cotnacts, normal_reactions)                             \
  X(events, eents, eevnts, evens, evenst, event, evetns, evets, evnets, evnts, vents)             \
  X(inputs, input, inpts, inptus, inpus, inpust, intputs, iputs)                                  \
  X(fields, feilds, felds, fiedls, fieds, fiels, fielsd, filds, fileds)                           \
  X(potential_differential, potential_diferential, potential_differental,                         \
    potential_differentials)                                                                      \
  X(holonomic_differential, holonomic_diferential, holonomic_differental,                         \
    holonomic_differentials)                                                                      \
  X(inertia_differential, inertia_diferential, inertia_differental, inertia_differentials)
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
