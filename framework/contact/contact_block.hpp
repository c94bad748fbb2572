// A contact in the contact problem (contact_problem.hpp), and what it does there.
#pragma once

namespace hamel {

/// The unknowns of a contact: P_n where it has a normal row, then P_t.
struct ContactBlock {
  int first = 0;        // of its unknowns in P
  bool normal = true;   // has it P_n?
  int tangential = 0;   // directions: 0, 1 or 2
  double friction = 0;  // mu
  double bound = 0;     // of |P_t|, without P_n
  int size() const { return (normal ? 1 : 0) + tangential; }
};

enum class ContactAnswer { sticks, slides, opens };

}  // namespace hamel
