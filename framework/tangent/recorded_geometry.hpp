// Groups with a retraction over recorded numbers: what the equation of a step is recorded with.
//
// An element is a block of numbers; planar rotations have no count of turns: the angle at a place
// is that where the step begins and the angle between, so that no record depends on it. Tables are
// filled where everything is linked by name (add_recorded_geometry).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/lie/group_info.hpp>
#include <hamel/framework/tangent/traced.hpp>

namespace hamel {

/// Out-parameters may be the in-parameters.
class RecordedGeometry {
 public:
  virtual ~RecordedGeometry() = default;
  virtual int dim() const = 0;
  virtual int size() const = 0;     // numbers of an element
  virtual int columns() const = 0;  // of its coordinates
  virtual void from_coordinates(const Traced* c, Traced* g) const = 0;
  /// Coordinates of g(from) way.
  virtual void coordinates(const Traced* from, const Traced* way, Traced* out) const = 0;
  virtual void compose(const Traced* g, const Traced* h, Traced* out) const = 0;
  virtual void inverse(const Traced* g, Traced* out) const = 0;
  virtual void Ad_transpose(const Traced* g, const Traced* mu, Traced* out) const = 0;
  virtual void tau(const Traced* xi, Traced* out) const = 0;
  /// Throws DomainError.
  virtual void tau_inverse(const Traced* g, Traced* out) const = 0;
  /// m0 of the cotangent lift (lie/trivialised.hpp).
  virtual void base_momentum(double s, const Traced* xi, const Traced* p, const Traced* nu,
                             Traced* out) const = 0;
};

/// Factor after factor.
std::shared_ptr<const RecordedGeometry> recorded_product(
    std::vector<std::shared_ptr<const RecordedGeometry>> factors);

/// For groups without products.
void add_recorded_geometry(const std::string& group, const std::string& retraction,
                           std::shared_ptr<const RecordedGeometry> geometry);
/// Null where a factor has none of this name.
std::shared_ptr<const RecordedGeometry> recorded_geometry(const GroupInfo& group,
                                                          const std::string& retraction);

}  // namespace hamel
