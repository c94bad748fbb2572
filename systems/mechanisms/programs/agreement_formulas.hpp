// Agreements of contacts (agreement.hpp): how they are found, and their rows.
#pragma once

#include <span>
#include <vector>

#include <hamel/systems/mechanisms/programs/mechanism_programs.hpp>
#include <hamel/systems/mechanisms/programs/row_formulas.hpp>

namespace hamel::mechanisms {

/// An equation, and the pivots that are factors of its terms: it is their determinant, as none of
/// them may divide where it could vanish along a motion.
struct Agreement::Formula {
  Number psi;
  std::vector<std::pair<int, int>> factors;
};

/// psi of a row and its differential along the velocities.
RecordedRow agreement_row(const Agreement& agreement, std::span<const RecordedRow> rows,
                          const BodyFormulas& bodies, const ConstraintRows& kinds,
                          const RowInputs& inputs);

/// Equations whose differentials are independent of each other and of the rows at a state where
/// the rank of the kept rows falls, the first one; none where it does not. Entries that vanish at
/// the other states too are no equations. units: of the velocities.
std::vector<Agreement> find_agreements(const MechanismParts& parts,
                                       const std::vector<std::vector<double>>& states,
                                       const Eigen::VectorXd& units);

/// psi of all agreements, then the differential of each.
FilledProgram record_agreements(const MechanismParts& parts);

}  // namespace hamel::mechanisms
