// What a Mechanics may say of its motions beside the equations: names, starts from a few numbers, notes, arrows.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/mechanics/components.hpp>
#include <hamel/framework/mechanics/system.hpp>

namespace hamel {

/// A force of the multipliers of some rows, drawn as an arrow in the world.
struct DrawnForce {
  std::string name;
  /// Where it acts [m], and the force [N].
  std::function<std::pair<Vec<3>, Vec<3>>(std::span<const double> coordinates,
                                          std::span<const double> reactions)>
      value;
};

struct MotionWords {
  std::vector<std::string> rates, reactions;  // of the velocities and of the multipliers
  /// A start at a time from a few numbers, at most as many as start_parameters names; without any the system's own start
  /// there. Throws ConfigError where there is no such motion.
  std::vector<std::string> start_parameters;  // "speed", in m/s
  std::function<Start(std::span<const double>, double t)> start_from;
  /// The same at a speed ahead [m/s]; empty where nothing runs ahead.
  std::function<Start(double speed, double t)> start_at_speed;
  std::vector<std::string> parts;                             // the bodies of a mechanism
  std::vector<std::string> notes;                             // what the user should know
  std::vector<std::pair<std::string, std::string>> formulas;  // "potential", "m*g*x"
  std::vector<DrawnForce> forces;
};

class Worded {
 public:
  virtual ~Worded() = default;
  virtual const MotionWords& words() const = 0;
  /// What is wrong with a state that a run starts from.
  virtual std::vector<std::string> mistakes_at(double /*t*/, const double* /*g*/,
                                               Mechanics::ConstVector /*xi*/) const {
    return {};
  }
};

/// A Mechanics with its words.
template <class Base>
class WithWords final : public Base, public Worded {
 public:
  WithWords(const Base& mechanics, MotionWords words) : Base(mechanics), words_(std::move(words)) {}
  const MotionWords& words() const override { return words_; }

 private:
  MotionWords words_;
};

/// Of a system; all empty where it says nothing.
inline const MotionWords& words_of(const SystemModel& model) {
  static const MotionWords none;
  const auto* worded = dynamic_cast<const Worded*>(model.mechanics.get());
  return worded == nullptr ? none : worded->words();
}

/// The components of xi by the names that the system states, else by those of its group (components.hpp).
std::vector<Component> components_of(const SystemModel& model);

/// The unit of the multiplier of a row: "N" of contacts, whose rows are forces of size 1; "" where nothing is known.
std::string unit_of_reaction(const SystemModel& model, int row);

}  // namespace hamel
