// An agreement of contacts: an equation of the configuration on which the rank of their rows falls.
//
// Wheels that are steered one by one leave a vehicle no motion, unless their axles meet in one
// point: with r of the rows eliminated from another one, A22 - A21 A11^-1 A12, all entries vanish
// exactly where the rank is r. Such an entry times det A11, the minor psi of r + 1 rows and
// columns, is a holonomic row of the motion that stays there, psi = 0 with the differential of psi,
// and rows of contacts that are combinations of the others there give way. Source: Campion, Bastin,
// d'Andrea-Novel, IEEE Trans. Robotics and Automation 12 (1996), 2.
#pragma once

#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace hamel::mechanisms {

struct RecordedRow;  // programs/row_formulas.hpp

/// Part that its rows are named after.
inline constexpr std::string_view kAgreement = "agreement";

/// Counted among the rows but agreements, in the order of ConstraintRows::each().
struct Agreement {
  std::vector<std::pair<int, int>> pivots;  // rows and velocities
  int row = 0, velocity = 0;                // the entry

  struct Formula;
  /// psi, over the pivots that are constant.
  Formula formula(std::span<const RecordedRow> rows) const;
};

}  // namespace hamel::mechanisms
