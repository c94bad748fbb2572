// One name for each coordinate and each component of the velocity of a system.
//
// A coordinate has the name that the system states (shape, or its file), else its group's; in a
// product with the number of its factor in front, 2_theta, where two would else have the same. A
// velocity has the name that the system states; where it is the rate of a coordinate the
// coordinate's, pitch'; else its group's, omega; else its number, xi1, xi2, ... A name that another
// column of every run has (t, energy, mu1) is left to that; a name that a parameter has is left to
// the parameter, but for the coordinates of a group that is no product.
//
// Other names are read wherever a name is: xi4 of the fourth velocity, and in a product those of
// earlier releases, 4_theta, theta_4, angle_4'.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// Completes group.columns, rates and other_names of a model that has its group, fields and inputs
/// and may state coordinates, shape and rates. A model that has its names stays as it is. Throws
/// ConfigError where the number of names is wrong.
void name_quantities(SystemModel& model);

/// Resolves the names of a model's coordinates and velocities.
class QuantityNames {
 public:
  explicit QuantityNames(const SystemModel& model);
  /// The coordinates, then the velocities.
  const std::vector<std::string>& all() const { return all_; }
  /// The place in all() of a name that is read; none where nothing is called so.
  std::optional<std::size_t> find(const std::string& name) const;
  /// t and all(), as formulas have them: a number in front goes behind, theta_2.
  const std::vector<std::string>& variables() const { return variables_; }
  /// Reads this name no longer.
  void forget(const std::string& name) { places_.erase(name); }
  /// A text with those of variables() for all names that are read.
  std::string in_formula(const std::string& text) const;
  /// The message of a mistake in a formula, with the names of all().
  std::string in_words(std::string message) const;

 private:
  std::vector<std::string> all_, variables_;
  std::map<std::string, std::size_t> places_;
};

/// "2_theta'" -> "theta_2'"; another name as it is.
std::string name_in_formula(const std::string& name);

}  // namespace hamel
