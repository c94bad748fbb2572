// Vector fields as formulas: what brackets are taken of.
#pragma once

#include <memory>
#include <vector>

#include <hamel/framework/graph/number.hpp>

namespace hamel::graph {

/// Fields on a set of elements, each of N numbers, near one of them: field a is the velocity
/// column a of E, of n components, and a velocity xi moves the numbers at T xi. Numbers on
/// which no formula depends may be others than the element's own, as an angle of a rotor.
struct VectorFields {
  std::shared_ptr<const Recording> recording;  // its first inputs: the element
  std::vector<Number> velocities;              // E, n x m, column by column
  std::vector<Number> moves;                   // T, N x n
  std::vector<Number> rates;                   // T E, N x m
};

/// A system that has the fields which it admits as formulas.
class HasVectorFields {
 public:
  virtual ~HasVectorFields() = default;
  /// Near an element; null where it has none, as where admissible velocities are not fields of the
  /// element alone.
  virtual std::shared_ptr<const VectorFields> vector_fields(const double* element) const = 0;
};

}  // namespace hamel::graph
