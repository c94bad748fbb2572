// Rows that a system leaves out since others imply them, as four rates of a base that has three
// freedoms: they hold as long as their b is the same combination of the others' b.
#pragma once

#include <string>

namespace hamel {

class HasImpliedRows {
 public:
  virtual ~HasImpliedRows() = default;
  /// The first of these rows whose b is another at (t, g), and by how much; "" where all agree.
  virtual std::string contradiction(double t, const double* g) const = 0;
};

}  // namespace hamel
