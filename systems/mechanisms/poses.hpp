// Poses and velocities that satisfy the rows of a mechanism: to look at it away from the drawn pose, and to start.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/system.hpp>
#include <hamel/systems/mechanisms/multibody.hpp>

namespace hamel::mechanisms {

/// Poses that share nothing, near g: g tau(eta), the rows left aside.
std::vector<std::vector<double>> poses_around(const Multibody& system,
                                              const std::vector<double>& g);
/// Poses near g on phi = 0 of all rows, reached by moves that satisfy the rows; g first. Rows may be dependent.
std::vector<std::vector<double>> poses_on_rows(const Multibody& system,
                                               const std::vector<double>& g);

/// Moves g onto phi(g) = 0 of all rows by the least change of the velocities that are free to change; returns the
/// largest |phi| left.
double satisfy(const Multibody& system, const std::vector<bool>& fixed, std::vector<double>& g);

/// Which of the rows of each() say something at all, and what those that say nothing new repeat.
struct Redundancy {
  std::vector<int> rows;                    // independent at one of the poses at least
  std::map<int, std::vector<int>> repeats;  // a row -> the rows that it is a combination of
};
Redundancy look_for_redundancy(const Multibody& system, const std::vector<double>& drawn);

/// A row in words, for messages.
struct Said {
  std::string where,
      what;  // of its part, "system.toml:3:1: "; "wheel 'rear' (rolls without slipping)"
};

/// Starts of a mechanism, by the names of coordinates and velocities.
class Starts {
 public:
  using Values = std::map<std::string, double>;
  using Places = std::map<std::string, std::string>;

  Starts(std::shared_ptr<const Multibody> system, std::string name,
         std::vector<std::string> columns, std::vector<std::string> rates, std::vector<Said> rows);
  /// Mistakes in these names; "speed" is the first of the root's velocities ahead.
  std::vector<std::string> mistakes(const std::vector<std::string>& names) const;
  /// At a time, where prescribed angles hold. Throws ConfigError where the rows forbid these values; places: where these
  /// stand in a file.
  Start solve(const Values& values, double t, const Places& places = {}) const;
  /// The coordinates that are prescribed, and what they are at a time.
  Values prescribed(double t) const;

 private:
  int rate(const std::string& name) const;  // -1: no velocity
  std::vector<double> configuration(const Values& values, double t, const Places& places) const;
  /// Throws that these rows and values do not go together, and the text behind them.
  [[noreturn]] void refuse(const std::vector<int>& rows, const Values& values, const Places& places,
                           const std::string& text) const;

  std::shared_ptr<const Multibody> system_;
  std::string name_;
  std::vector<std::string> columns_, rates_;
  std::vector<Said> rows_;
};

}  // namespace hamel::mechanisms
