// Formulas that lift records at a place of a mechanism (lift_programs.hpp): rows, forces, and those
// of the numbers that a node carries.
#pragma once

#include <utility>
#include <vector>

#include <hamel/framework/graph/elimination.hpp>
#include <hamel/systems/mechanisms/programs/lift_layout.hpp>
#include <hamel/systems/mechanisms/programs/row_formulas.hpp>

namespace hamel::mechanisms {

using graph::Frame;

/// Elements are in the numbers of the layout.
class LiftFormulas {
 public:
  using Numbers = std::vector<Number>;
  using Rows = std::vector<RecordedRow>;

  LiftFormulas(const MechanismParts& parts, const LiftLayout& layout)
      : parts_(parts), layout_(layout) {}

  BodyFormulas bodies(const Numbers& element, const Numbers& xi) const;
  /// The rows kept. any: velocities for rows whose coefficients are slopes by them; held: the
  /// coordinates at which joints are held, empty: no phi of them.
  Rows rows(const BodyFormulas& bodies, const Numbers& element, const Numbers& any,
            const Numbers& rates, const Numbers& held) const;
  /// f - dV without dampers; that of dampers.
  Numbers still_force(const BodyFormulas& bodies, const Numbers& element,
                      const Numbers& motors) const;
  Numbers damping(const Numbers& element, const Numbers& v) const;

  /// Numbers that a node carries, and its velocity.
  struct Carried {
    Numbers xi;
    Numbers momentum, force;  // E^T mu, E^T f
    Number energy;            // xi . I xi
    Number force_size;        // sum f_i^2 / I_ii
    Numbers diagonal;         // of E^T I E
  };
  /// mu: the momentum at the node; xi: its velocity where that is known, else null.
  Carried carry(const BodyFormulas& bodies, const Frame& frame, const Numbers& mu,
                const Numbers& force, const Numbers* xi) const;

 private:
  const LiftLayout::Part& part(int link) const {
    return layout_.parts()[static_cast<size_t>(link)];
  }
  Numbers signals(const Numbers& element, const Numbers& motors) const;
  const MechanismParts& parts_;
  const LiftLayout& layout_;
};

/// Which inputs of the current recording do these numbers depend on?
std::vector<bool> inputs_of(const std::vector<Number>& numbers);

/// a . b.
Number sum_of_products(const std::vector<Number>& a, const std::vector<Number>& b);

}  // namespace hamel::mechanisms
