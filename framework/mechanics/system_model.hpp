// A system with its type erased: its equations, and what is stated about it beside them.
//
// erase() (system.hpp) makes one of a struct; mechanisms and systems by data fill the same members.
// Whatever is not stated is empty.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/lie/group_info.hpp>
#include <hamel/framework/mechanics/components.hpp>
#include <hamel/framework/mechanics/contact_law.hpp>
#include <hamel/framework/mechanics/drawing.hpp>
#include <hamel/framework/mechanics/event.hpp>
#include <hamel/framework/mechanics/fields.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/mechanics/start.hpp>

namespace hamel {

/// The exact motion from a start: t -> (coordinates of g, xi). Call with |t| increasing.
using ExactFlow = std::function<std::pair<std::vector<double>, std::vector<double>>(double)>;

/// A number that the exact motion keeps.
struct Invariant {
  std::string name;
  std::function<double(std::span<const double> coordinates, std::span<const double> velocity)>
      value;
  bool energy = false;  // the energy, which every state of a run has
};

/// A force of the multipliers of some rows, drawn as an arrow in the world.
struct DrawnForce {
  std::string name;
  /// The point where it acts [m], and the force [N].
  std::function<std::pair<Vec<3>, Vec<3>>(std::span<const double> coordinates,
                                          std::span<const double> reactions)>
      value;
};

/// A sensor: numbers of a state beside coordinates and velocities, columns of every run.
struct Sensor {
  std::string name, meaning;
  std::vector<std::string> columns, units;
  std::size_t first_acceleration = 0;  // the columns from here on need the acceleration
  int velocity = -1;  // the first of three columns, whose path is one more, name.path; -1: none
  /// At a place, velocity and acceleration xi', which may be left out for the columns before.
  std::function<void(std::span<const double> coordinates, std::span<const double> velocity,
                     std::span<const double> acceleration, std::span<double> out)>
      value;
};

/// A column of every run by a formula of t, parameters and other columns.
struct OutputFormula {
  std::string name, formula, unit, meaning;
  std::string where = {};  // in a file, in front of messages
};

/// A further name by which a coordinate or velocity is read; place counts the coordinates, then the
/// velocities.
struct OtherName {
  std::string name;
  std::size_t place;
};

/// A system with its parameters set and its type erased.
struct SystemModel {
  std::string name;
  GroupInfo group;
  std::shared_ptr<const Mechanics> mechanics;
  std::vector<Field> fields;
  SystemStart start;
  /// Empty when nothing is known exactly.
  std::function<ExactFlow(const Start&)> exact;
  std::vector<Invariant> invariants;
  std::vector<Event> events;
  std::vector<int> contacts;  // the rows whose multiplier is a normal reaction
  /// Contacts that may slide and open; their rows are not in contacts.
  std::vector<ContactLaw> contact_laws;
  // Stated names: of the coordinates of so2 and rn, and of all coordinates; empty: those of the
  // group. name_quantities() completes group.columns, rates and other_names (quantity_names.hpp).
  std::vector<std::string> shape, coordinates;
  std::vector<std::string> rates;  // of the velocities
  std::vector<OtherName> other_names;
  bool has_names = false;
  Drawing drawing;
  std::vector<InputField> inputs;
  /// The mechanics that these inputs drive; empty where there are none. All other members hold with
  /// inputs too.
  std::function<std::shared_ptr<const Mechanics>(std::shared_ptr<const Inputs>)> drive;

  std::vector<std::string> reactions;                         // names of the multipliers
  std::vector<std::string> parts;                             // the bodies of a mechanism
  std::vector<std::string> notes;                             // shown with every run
  std::vector<std::pair<std::string, std::string>> formulas;  // "potential", "m*g*x"
  std::vector<DrawnForce> forces;
  std::vector<Sensor> sensors;
  std::vector<OutputFormula> outputs;
  bool rows_may_depend = false;  // on each other, at some places: a run watches them
  /// Counts the copies of a model that is made once for several users; null where each has its own.
  std::shared_ptr<const void> copies;

  /// A start at time t from at most as many numbers as start_parameters has names; from none: the
  /// system's own start at that time. Throws ConfigError where no such motion exists.
  std::function<SystemStart(std::span<const double>, double t)> start_from;
  std::vector<std::string> start_parameters;  // "speed", in m/s
  /// Straight ahead at a speed [m/s]; empty where no straight motion is defined.
  std::function<SystemStart(double speed, double t)> start_at_speed;
  /// A start with these coordinates and velocities by name, and "speed", in place of the usual
  /// ones; pushed: with the push of the file where a speed is given. Throws ConfigError where no
  /// such motion exists. Empty: numbers of the usual start are replaced.
  std::function<SystemStart(const std::map<std::string, double>& values, double t, bool pushed)>
      start_with;
  /// The same with the push of the file, with which a run starts, and as text: "w1 = 0.1"; empty
  /// where there is none.
  std::function<SystemStart(double speed, double t)> start_pushed;
  std::string push;
  /// Mistakes of a state as the start of a run. inputs: null where none drive the run.
  std::function<std::vector<std::string>(double t, const double* g, std::span<const double> xi,
                                         const std::shared_ptr<const Inputs>& inputs)>
      start_mistakes;
};

/// Options behind the name of a system by name, each a list: robot.urdf?wheel=left,right&root=free.
using NameOptions = std::map<std::string, std::vector<std::string>>;

/// A registered system: its descriptions, its parameters, and how to make it.
struct SystemInfo {
  std::string name, summary, formula, known, source;
  GroupInfo group;
  std::vector<Field> fields;
  std::vector<InputField> inputs;
  /// Throws ConfigError naming every parameter that does not fit.
  std::function<SystemModel(const Parameters&)> make;
  /// With options behind the name, bicycle?hold=steer; empty: it takes none.
  std::function<SystemModel(const Parameters&, const NameOptions&)> make_with = {};
};

/// "no constraint", "1 constraint row", "3 constraint rows, 1 holonomic".
std::string constraints_in_words(const SystemModel& model);

/// The components of xi by name (quantity_names.hpp), with their units.
std::vector<Component> components_of(const SystemModel& model);

/// The unit of the multiplier of a row: "N" of contacts, whose rows are forces of size 1; "" where
/// nothing is known.
std::string unit_of_reaction(const SystemModel& model, int row);

}  // namespace hamel
