// Eigenvalues of neighbouring matrices, each with the one it becomes. For sources of this room, not
// installed.
#pragma once

#include <complex>
#include <vector>

namespace hamel::reduced {

using Complex = std::complex<double>;

/// For each value the place of the nearest of `others` that is not taken, the nearest pairs first;
/// -1 where none is left.
std::vector<int> matched(const std::vector<Complex>& values, const std::vector<Complex>& others);

}  // namespace hamel::reduced
