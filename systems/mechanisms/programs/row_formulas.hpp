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

/// All rows, in the order of ConstraintRows::each(). rates, gaps: b and phi of the prescribed ones.
std::vector<RecordedRow> record_rows(const ConstraintRows& rows, const BodyFormulas& bodies,
                                     std::span<const Number> xi, std::span<const Number> rates,
                                     std::span<const Number> gaps);

}  // namespace hamel::mechanisms
