// The constraint rows of a mechanism (rows.hpp), recorded.
#pragma once

#include <span>
#include <vector>

#include <hamel/systems/mechanisms/programs/body_formulas.hpp>
#include <hamel/systems/mechanisms/rows.hpp>

namespace hamel::mechanisms {

/// Row of A xi = b, of its holonomic phi (0 where it has none).
struct RecordedRow {
  std::vector<Number> coefficients;  // of A
  Number drift = 0;                  // b
  Number value = 0;                  // A xi - b
  Number phi = 0;
};

/// Numbers of a state that rows depend on beside the element.
struct RowInputs {
  std::span<const Number> g, xi;
  std::span<const Number> feet;         // x and y of each contact with a ground that has a height
  std::span<const Number> coupled;      // coordinates of ConstraintRows::coupled_links
  std::span<const Number> closures;     // phi of couplings
  std::span<const Number> rates, gaps;  // b and phi of prescribed rows
};

/// All rows, in the order of ConstraintRows::each().
std::vector<RecordedRow> record_rows(const ConstraintRows& rows, const BodyFormulas& bodies,
                                     const RowInputs& inputs);

/// The equations of feet (ground_contact.hpp), two for each contact.
std::vector<Number> record_feet(const ConstraintRows& rows, const BodyFormulas& bodies,
                                std::span<const Number> feet);

}  // namespace hamel::mechanisms
