// The growth d, d + [d, d], ... of brackets of admissible directions at a configuration.
//
// Time is a coordinate, t' = 1, where b != 0 or A, b depend on it: then d is spanned by the fields
// X_a of ker A and by X_0 = d/dt + (the particular velocity, A xi = b), and the rows are
// integrable, with phi(t, g) = 0 for integrals, exactly when the X_a and X_0 are closed under
// brackets. Dimensions are counted without X_0.
//
// Constant fields of constant rows: linear algebra with the structure constants. Else random
// combinations of all brackets of 1, 2, ... fields, at g and at a configuration nearby: exact where
// the rows are known as formulas (exact_brackets.hpp), by differences along paths for a user's own
// type that is known by its values alone (carried_fields.hpp). Ranks nearby are generic: d stays
// closed from the first generation on that adds nothing there, and no configuration has more
// directions than that. At g itself brackets may pause and grow again (z' = y^2 x' at y = 0: 2, 2,
// 3). Tolerances: a direction is new when it is above 1e-6 of its generation (1e-10 where brackets
// are exact) and ten times above the generation's error, measured by computing it twice, along
// paths of the length over which the fields are smooth at g. A generation whose error exceeds 1e-4
// of it (from six or seven fields on) is not decided, nor is any beyond it. Generations below 1e-6
// of the fields are taken for zero. Where such a small bracket is ten times above the errors of its
// own coordinates, nothing is decided: z' = 1e-12 y x' is not integrable, and no more than that
// distinguishes it.
#pragma once

#include <vector>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/mechanics/natural_units.hpp>

namespace hamel {
namespace graph {
struct RowFields;
}

struct Growth {
  std::vector<int>
      dimensions;           // with brackets of at most 1, 2, ... fields, to the last that adds any
  int nearby = -1;          // what brackets span at configurations nearby; -1: not decided
  bool with_drift = false;  // X_0 is among the fields
  int looked_at = 0;        // brackets of at most this many fields were looked at
  bool round_off = false;   // deeper ones could not be distinguished from round-off
  bool near_zero = false;   // some that are left out are small, but not zero
  /// The span of all brackets is known and reached.
  bool decided() const { return dimensions.back() == nearby; }
};

/// So many fields in a bracket: more drown in round-off; kFewFields take milliseconds.
constexpr int kMostFields = 8, kFewFields = 3;

/// geometry: of a retraction with tau(x) for |x| < 3. Brackets of up to n fields are looked at,
/// `most` of them at most. units: of the n components, in which all are measured; empty: 1.
/// formulas: of the rows (recorded_rows.hpp); null: there are none.
Growth growth_of(const Geometry& geometry, const Mechanics& mechanics, const double* g,
                 int most = kMostFields, const std::vector<double>& units = {},
                 const graph::RowFields* formulas = nullptr);

}  // namespace hamel
