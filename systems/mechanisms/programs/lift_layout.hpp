// Numbers in which lift on programs carries an element (lift_programs.hpp).
//
// As the tree lays it out, but for what turns about an axis: of a wheel, on whose angle nothing
// depends, the angle and full turns in place of a cosine and a sine; of any other hinge the angle,
// turns included, beside them; turns as numbers. A step adds h v to an angle.
#pragma once

#include <memory>
#include <vector>

#include <hamel/systems/mechanisms/programs/mechanism_programs.hpp>

namespace hamel::mechanisms {

class LiftLayout {
 public:
  enum class Kind {
    added,    // x
    wheel,    // angle, turns
    turning,  // angle, c, s
    ball,     // R, column by column
    planar,   // c, s, x, y, turns
    free      // R, p
  };
  struct Part {
    Kind kind;
    int first;    // of its numbers
    int element;  // of those of the tree
    int dof;
  };

  /// Null where a joint is of a group that lift on programs does not know in its place.
  static std::shared_ptr<const LiftLayout> of(const MechanismParts& parts);

  const std::vector<Part>& parts() const { return parts_; }  // of each link
  size_t size() const { return size_; }
  size_t turning_count() const { return turning_; }
  /// Is tau of a geometry Cayley's map, and addition on axes? Seen from what it does.
  bool moves_by(const Geometry& geometry) const;
  /// To an element of the tree, and back.
  void pack(const double* numbers, double* element) const;
  void unpack(const double* element, double* numbers) const;
  void coordinates(const double* numbers, double* out) const;
  // The group and its tau, Cayley's map; out may be an argument.
  void compose(const double* g, const double* h, double* out) const;
  void inverse(const double* g, double* out) const;
  void tau(const double* xi, double* out) const;
  /// xi of a whole step (lie/recover_step.hpp); false where there is none.
  bool recover_step(const double* delta, double s, double* xi) const;
  /// Without round-off of the products behind it.
  void normalise(double* numbers) const;
  /// The turns of planar parts behind a step h v.
  void count_turns(const double* before, const double* v, double h, double* after) const {
    for (const Part& part : parts_)
      if (part.kind == Kind::planar) count_turns(part, before, h * v[part.dof], after);
  }

 private:
  static void count_turns(const Part& part, const double* before, double angle, double* after);

  std::vector<Part> parts_;
  size_t size_ = 0, turning_ = 0;
};

}  // namespace hamel::mechanisms
