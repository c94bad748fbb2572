// Friction and restitution as parameters of a system whose contact is ideal without them.
#pragma once

#include <optional>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/contact_law.hpp>
#include <hamel/framework/mechanics/parameters.hpp>

namespace hamel {

/// Not set: the contact rolls without slipping and never opens.
struct ContactParameters {
  std::optional<double> friction;     // mu, of Coulomb's law
  std::optional<double> restitution;  // e, of Newton's law

  bool ideal() const { return !friction && !restitution; }
  void fields(auto& f) {
    f("friction", friction, "1", "coefficient of friction; not set: never slides", non_negative);
    f("restitution", restitution, "1", "coefficient of restitution, of impacts; with friction",
      between(0, 1));
  }
  /// Adds the contact where it is not ideal.
  void add_to(auto& add, ContactLaw law) const {
    if (ideal()) return;
    if (!friction)
      throw ConfigError({"parameter 'restitution': set friction too, 0 for a smooth ground"});
    law.friction = *friction;
    law.restitution = restitution.value_or(0);
    add(std::move(law));
  }
};

}  // namespace hamel
