// Higher order by symmetric composition of a symmetric second-order step:
//   Psi_{c1 h} o ... o Psi_{cr h},  c_i = c_{r+1-i},  sum c_i = 1.
// Substeps with c < 0 run backwards. Source of each table: Hairer, Lubich, Wanner, Geometric
// Numerical Integration (2nd ed.), sections II.4 and V.3.2, with the original named beside it.
#pragma once

#include <string>
#include <vector>

namespace hamel {

struct Composition {
  std::string name;
  std::string source;
  int order;  // reached when the step composed is reversible and of order 2
  std::vector<double> coefficients;
};

/// All tables, "none" (the plain step) first.
const std::vector<Composition>& compositions();

}  // namespace hamel
