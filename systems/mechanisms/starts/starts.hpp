// Start of a mechanism: coordinates and velocities that satisfy its rows, from those that are
// stated.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/system.hpp>
#include <hamel/systems/mechanisms/multibody.hpp>
#include <hamel/systems/mechanisms/starts/start_velocity.hpp>

namespace hamel::mechanisms {

/// The text of a row, for messages.
struct RowLabel {
  std::string where,
      what;  // of its part, "system.toml:3:1: "; "wheel 'rear' (rolls without slipping)"
};
/// Some of these rows, one behind the other.
std::string in_words(const std::vector<int>& some, const std::vector<RowLabel>& rows);
/// Sentence that a row contradicts those of a list.
std::string contradiction(const RowLabel& row, const std::string& list);

/// Starts of a mechanism, by the names of coordinates and velocities.
class Starts {
 public:
  using Values = std::map<std::string, double>;
  using Places = std::map<std::string, std::string>;

  Starts(std::shared_ptr<const Multibody> system, std::string name,
         std::vector<std::string> columns, std::vector<std::string> rates,
         std::vector<RowLabel> rows);
  /// Is this the name of the velocity that "speed" is?
  bool is_speed(const std::string& name) const { return ahead() >= 0 && rate(name) == ahead(); }
  /// Mistakes in these names; "speed" is that of the first planar or free root joint ahead.
  std::vector<std::string> mistakes(const std::vector<std::string>& names) const;
  /// At a time, where prescribed angles hold. Velocities that are not given are those of the fewest
  /// motions (start_velocity.hpp); a note names the joints that move unasked. Throws ConfigError
  /// where the rows forbid these values; places: where these are in a file.
  SystemStart solve(const Values& values, double t, const Places& places = {}) const;
  /// The coordinates that are prescribed, and what they are at a time.
  Values prescribed(double t) const;

  /// Its coordinates.
  std::vector<double> configuration(const Values& values, double t,
                                    const Places& places = {}) const;

 private:
  int ahead() const;                        // the velocity that "speed" is; -1: there is none
  int rate(const std::string& name) const;  // -1: no velocity
  std::string unasked(const std::vector<int>& some, const Values& values,
                      const StartVelocity& found, const Eigen::VectorXd& xi) const;
  // Equations of the velocity of a start: rows, then velocities that are stated.
  struct Equations {
    Eigen::MatrixXd a;
    Eigen::VectorXd b;
    std::vector<int> rows;  // of each()
    Eigen::VectorXd solution() const;
    bool solved() const;
  };
  Equations equations(const std::vector<double>& g, double t,
                      const std::vector<std::pair<int, Values::value_type>>& stated,
                      const std::vector<int>& rows) const;
  struct SlippingPart {
    std::string name;
    std::vector<int> rows;
  };
  std::vector<SlippingPart> closed_parts(const Eigen::VectorXd& phi) const;
  std::vector<bool> own_velocities(const std::string& part) const;
  bool add_own_rows(const SlippingPart& part, const StartVelocity& velocity,
                    const std::function<Equations(std::span<const int>)>& with, Equations& to,
                    Eigen::VectorXd& now) const;
  /// Adds those of parts that may slide or open, one after the other as long as they agree with the
  /// others and, where not all do, move nothing that several contacts carry; returns the names of
  /// contacts that slip.
  std::vector<std::string> add_slipping(
      const std::vector<double>& g, double t,
      const std::vector<std::pair<int, Values::value_type>>& stated, Equations& to) const;
  // A stated coordinate of a joint with one velocity.
  struct Choice {
    size_t column;
    int velocity;
  };
  std::string would_do(const std::vector<Choice>& choices, const std::vector<double>& near,
                       const std::vector<bool>& fixed) const;
  /// Throws that these rows and values are inconsistent, and the text after them.
  [[noreturn]] void refuse(const std::vector<int>& rows, const Values& values, const Places& places,
                           const std::string& text) const;

  std::shared_ptr<const Multibody> system_;
  std::string name_;
  std::vector<std::string> columns_, rates_;
  std::vector<RowLabel> rows_;
};

}  // namespace hamel::mechanisms
