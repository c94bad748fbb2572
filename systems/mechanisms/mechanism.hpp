// A mechanism: bodies, joints, contacts and couplings put together, with nothing derived by hand.
//
//   hamel::Mechanism m("scooter");
//   const auto deck = m.body("deck", {.mass = 5, .at = {0.3, 0, 0.1}, .box = {0.8, 0.2, 0.05}});
//   const auto fork =
//       m.body("fork", {.mass = 2, .at = {0.7, 0, 0.4}, .inertia = {0.1, 0.1, 0.01}});
//   m.planar("road", deck);
//   m.hinge("steer", deck, fork, {.at = {0.7, 0, 0}, .axis = {0, 0, 1}});
//   m.blade("rear", deck, {.at = {0, 0, 0}});
//   m.blade("front", fork, {.at = {0.7, 0, 0}});
//   m.start({{"speed", 2}, {"steer.angle", 0.3}});
//   hamel::simulate(m).until(10).run();
//
// All points and directions are those of one pose of the whole mechanism, as drawn: x ahead, z up,
// the ground z = 0. That pose is the default start. Moments of inertia are about the mass centre,
// along the axes of that pose. Parts are named; names are checked when the mechanism is used
// (model()), all mistakes at once. The same parts in a file: mechanism_file.hpp. The computations:
// tree.hpp, rows.hpp, forces.hpp.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/mechanics/event.hpp>
#include <hamel/framework/mechanics/input_table.hpp>
#include <hamel/framework/mechanics/parameters.hpp>
#include <hamel/framework/mechanics/point.hpp>
#include <hamel/systems/mechanisms/part_options.hpp>

namespace hamel {

struct SystemInfo;
struct SystemModel;

class HAMEL_API Mechanism {
 public:
  explicit Mechanism(std::string name);
  Mechanism(const Mechanism&);
  Mechanism(Mechanism&&) noexcept;
  Mechanism& operator=(const Mechanism&);
  Mechanism& operator=(Mechanism&&) noexcept;
  ~Mechanism();

  /// A body; what it returns is its name.
  std::string body(const std::string& name, const BodyOptions& options);

  // Joints. Each body hangs on one; those of parent kWorld carry all others.
  void free(const std::string& name, const std::string& child, const JointOptions& o = {}) {
    joint("free", name, kWorld, child, o);
  }
  void planar(const std::string& name, const std::string& child, const JointOptions& o = {}) {
    joint("planar", name, kWorld, child, o);
  }
  void hinge(const std::string& name, const std::string& parent, const std::string& child,
             const JointOptions& o) {
    joint("hinge", name, parent, child, o);
  }
  void slider(const std::string& name, const std::string& parent, const std::string& child,
              const JointOptions& o) {
    joint("slider", name, parent, child, o);
  }
  void ball_joint(const std::string& name, const std::string& parent, const std::string& child,
                  const JointOptions& o) {
    joint("ball", name, parent, child, o);
  }
  /// Two hinges, axis on the parent and axis2 on the child, whose axes intersect.
  void universal(const std::string& name, const std::string& parent, const std::string& child,
                 const JointOptions& o) {
    joint("universal", name, parent, child, o);
  }
  void weld(const std::string& name, const std::string& parent, const std::string& child) {
    joint("weld", name, parent, child, {});
  }
  /// By the name of its kind, one of those above or another one.
  void joint(const std::string& kind, const std::string& name, const std::string& parent,
             const std::string& child, const JointOptions& options);

  // Contacts with the ground.
  void wheel(const std::string& name, const std::string& body, const WheelOptions& options);
  void roller(const std::string& name, const std::string& body, const WheelOptions& options);
  void blade(const std::string& name, const std::string& body, const BladeOptions& options);
  void ball(const std::string& name, const std::string& body, const WheelOptions& options);
  /// A point of a body above the ground: a skid, a leg, a caster without its wheel.
  void point(const std::string& name, const std::string& body, const PointOptions& options);
  /// By the name of its kind, one of those above or another one.
  void contact(const std::string& kind, const std::string& name, const std::string& body,
               const ContactOptions& options);
  /// A joint that closes a chain: its points, and axes, coincide.
  void loop(const std::string& name, const std::string& a, const std::string& b,
            const LoopOptions& options);
  /// A gear, belt, linkage or differential.
  void coupling(const std::string& name, const CouplingOptions& options);
  void wall(const std::string& name, const WallOptions& options);
  /// Adds a state `clock`, which is the time, where a formula of a wall, a coupling or a state has
  /// t: their rows are of the configuration alone. Called by wall(), coupling() and state().
  void time(const std::string& formula);
  /// The rate of a hinge or slider, as a function of time, or as an input of the run, "steer.rate".
  /// With the angle (of a slider the position) whose derivative it is, a run starts there. With the
  /// derivative of the rate the equations of motion are exact; without, they find it by
  /// differences.
  void prescribe(const std::string& joint, std::function<double(double t)> rate,
                 std::function<double(double t)> angle = {},
                 std::function<double(double t)> slope = {});
  /// Prescribes a rate that does not change, so that there are steady motions; of rate 0 with an
  /// angle the joint is held there.
  void prescribe(const std::string& joint, double rate, std::function<double(double t)> angle = {});
  void prescribe(const std::string& joint, const Range& range = {});
  /// Locks a hinge or slider where a run starts, or at an angle [rad] or position [m].
  void hold(const std::string& joint) { prescribe(joint, 0.0); }
  void hold(const std::string& joint, double at) {
    prescribe(joint, 0.0, [at](double) { return at; });
  }
  /// The ground turns about the origin [rad/s] and moves [m/s].
  void ground(double rate, Point velocity = {0, 0, 0});
  /// The ground is z = height(x, y), a formula; constants: names that it may use.
  void ground_height(const std::string& formula, const Parameters& constants = {});
  /// "refuse", or "drop": policy for rows that are implied by others.
  void redundant(const std::string& policy);
  /// "equal_compliance", "stated" (by the `share` of each contact) or "refuse": policy for loads of
  /// contacts that statics and the motion leave open.
  void distribution(const std::string& policy);

  // Forces.
  /// m/s^2; an incline is a direction of gravity that is not -z.
  void gravity(Point acceleration) { gravity_ = acceleration; }
  void spring(const std::string& name, const std::string& a, const std::string& b,
              const SpringOptions& options);
  /// A torque [N m] or force [N] in a hinge or slider: a signal, or an input of the run,
  /// "steer.torque", "lift.force". time_dependent: may the signal use t? If not, there are steady
  /// motions.
  void motor(const std::string& joint, Signal effort, bool time_dependent = true);
  void motor(const std::string& joint, const Range& range = {});
  /// Dry friction in a hinge or slider whose bound, N m or N, is an input of the run, "rear.brake",
  /// at least 0.
  void brake(const std::string& joint, const Range& range = Range{0});
  void force(const std::string& name, const std::string& body, const ForceOptions& options);
  /// A couple.
  void torque(const std::string& name, const std::string& body, const TorqueOptions& options);
  /// An input of the run that signals may use: SignalInput::inputs, behind those of motors and
  /// prescribed joints.
  void input(const InputField& field);

  /// A coordinate "lag" with the velocity "lag.rate", which formulas may use.
  void state(const std::string& name, const StateOptions& options);

  /// A point of a body (or of the ground) whose place, velocity, acceleration, yaw and length of
  /// path are columns of every run, "tip.x", "tip.vz", "tip.ax", "tip.yaw", "tip.path".
  void sensor(const std::string& name, const std::string& body, Point at);
  /// A column of every run by a formula of columns: "abs(tip.vz)".
  void output(const std::string& name, const std::string& formula, const OutputOptions& o = {});

  /// An event of a run (--events, --stop-at), a function of time, coordinates and velocities.
  void event(Event event);

  /// The start: coordinates and velocities by name, and "speed", that of the first planar or free
  /// root joint ahead. Those that are not given follow from the rows: coordinates stay near the
  /// drawn pose; joints but wheels' axles are at rest unless the rows require their motion, which a
  /// note of the run names (start_velocity.hpp).
  void start(const std::map<std::string, double>& values);
  void start(const std::string& name, double value);
  /// A velocity by name beside the speed of a run that starts at one (`--speed`): a motion to be
  /// seen where straight ahead there would be none.
  void push(const std::string& name, double value);
  /// Meaning of the numbers given for a start (`--velocity`): names as those of start(). Left out:
  /// speed.
  void start_arguments(std::vector<std::string> names);

  const std::string& name() const { return name_; }
  /// The system. Throws ConfigError with all mistakes, each with the name of its part.
  SystemModel model() const;

  /// Part of model(): name, group and inputs, and the names of velocities, which bodies and joints
  /// alone determine. Throws ConfigError where they make no tree.
  SystemModel outline() const;

  /// Location of the next parts and statements in a file, for messages.
  void place(std::string where) { where_ = std::move(where); }

 private:
  friend class Assembly;
  struct Part {
    std::string name, where;
  };
  struct BodyPart : Part, BodyOptions {};
  struct JointPart : Part, JointOptions {
    std::string kind, parent, child;
  };
  struct ContactPart : Part, ContactOptions {
    std::string kind, body;
  };
  struct LoopPart : Part, LoopOptions {
    std::string a, b;
    std::string kind = "loop";  // "ball": one of b that rolls on or inside a, with this radius
    double radius = 0;
    bool inside = false, both = false;  // both: on and inside
    ContactOptions contact = {};        // of a ball: its friction
  };
  struct CouplingPart : Part, CouplingOptions {};
  struct WallPart : Part, WallOptions {};
  struct SpringPart : Part, SpringOptions {
    std::string a, b;
  };
  struct ForcePart : Part, ForceOptions {
    std::string body;
    bool couple = false;  // a torque
  };
  struct StateOfRate : Part, StateOptions {
    bool is_time = false;
  };
  struct SensorPart : Part {
    std::string body;
    Point at;
  };
  struct OutputPart : Part, OutputOptions {
    std::string formula;
  };
  struct HeightPart : Part {  // its name is the formula
    Parameters constants;
  };
  struct RatePart : Part {
    std::function<double(double)> rate;   // empty: an input
    std::function<double(double)> angle;  // empty: that of the start
    std::function<double(double)> slope;  // of the rate; empty: by differences
    bool time_dependent = false;          // not constant
    Range range = {};
  };
  struct MotorPart : Part {
    Signal effort;  // empty: an input
    bool time_dependent = false;
    Range range = {};
  };
  struct BrakePart : Part {
    Range range;
  };
  struct InputPart : Part {
    InputField field;
  };
  struct StartPart : Part {
    double value = 0;
  };
  struct StartArguments : Part {
    std::vector<std::string> names;
  };
  Part part(const std::string& name) const;

  std::string name_, where_;
  Part redundant_ = {"refuse", ""}, distribution_ = {"equal_compliance", ""};
  std::vector<BodyPart> bodies_;
  std::vector<JointPart> joints_;
  std::vector<ContactPart> contacts_;
  std::vector<LoopPart> loops_;
  std::vector<CouplingPart> couplings_;
  std::vector<WallPart> walls_;
  std::vector<SpringPart> springs_;
  std::vector<ForcePart> forces_;
  std::vector<StateOfRate> states_;
  std::vector<SensorPart> sensors_;
  std::vector<OutputPart> outputs_;
  std::vector<RatePart> rates_;
  std::vector<MotorPart> motors_;
  std::vector<BrakePart> brakes_;
  std::vector<InputPart> inputs_;
  std::vector<Event> events_;
  Point gravity_ = {0, 0, -9.81}, ground_velocity_ = {0, 0, 0};
  double ground_rate_ = 0;
  std::optional<HeightPart> ground_height_;
  std::vector<StartPart> start_, push_;
  StartArguments start_arguments_;
};

/// A mechanism has no parameters to set.
HAMEL_API std::function<SystemModel(const Parameters&)> maker(const Mechanism& mechanism);
/// The registry entry of a mechanism: registry().add(system_info(mechanism)).
HAMEL_API SystemInfo system_info(const Mechanism& mechanism);

}  // namespace hamel
