// The names of the retractions, and the list of those that a group offers.
//
// A retraction is a template over the group, specialised where it exists:
//   Exp                  exp(xi)                                                      every group
//   Cayley               (I - xi^/2)^-1 (I + xi^/2) in the defining matrices          every group
//   CayleyLiteral        the same on SO2, where Cayley adds angles                    SO2
//   Polar                orthogonal polar factor of I + omega^                        SO3
//   SecondKind           exp(xi_1 e_1) ... exp(xi_n e_n)                              every group
//   SecondKindSymmetric  exp(xi_1 e_1/2) ... exp(xi_n e_n) ... exp(xi_1 e_1/2)        every group
// A group states its list as a member, `using Retractions = TypeList<Exp<SO3>, Cayley<SO3>>;`,
// first the default; for a group that cannot be changed specialise RetractionsOf instead.
#pragma once

#include <hamel/framework/lie/retraction_defaults.hpp>

namespace hamel {

template <class G>
struct Exp;
template <class G>
struct Cayley;
template <class G>
struct CayleyLiteral;
template <class G>
struct Polar;
template <class G>
struct SecondKind;
template <class G>
struct SecondKindSymmetric;

/// RetractionsOf<G>::type is the TypeList of the retractions of G.
template <class G>
struct RetractionsOf {
  using type = typename G::Retractions;
};

/// Does the group offer the retraction R?
template <class G, class R>
inline constexpr bool has_retraction = RetractionsOf<G>::type::template contains<R>;

}  // namespace hamel
