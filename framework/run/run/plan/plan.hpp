// The plan of a run, checked before the first step. Not installed.
//
// Five functions, each from values to values; what is wrong is added to one Mistakes.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/run/run/contacts/run_contacts.hpp>
#include <hamel/framework/run/run/events.hpp>
#include <hamel/framework/run/run/own_system.hpp>
#include <hamel/framework/run/run/rows/reactions.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

class Mistakes {
 public:
  void add(std::string one) { all_.push_back(std::move(one)); }
  void add(const std::vector<std::string>& more) {
    all_.insert(all_.end(), more.begin(), more.end());
  }
  bool none() const { return all_.empty(); }
  const std::vector<std::string>& all() const { return all_; }
  std::vector<std::string>& all() { return all_; }
  /// Throws ConfigError where there are any.
  void refuse() const {
    if (!none()) throw ConfigError(all_);
  }

 private:
  std::vector<std::string> all_;
};

/// The options of a run that a scheme makes no use of: s; solver, tolerance and, but for "halve",
/// on_failure of explicit ones, which solve no equation. Half an explicit step may succeed where
/// the whole left the domain of tau.
std::vector<std::string> unused_options(const SchemeInfo& scheme, const Config& config);

/// The scheme, and what of a kernel's setup follows from names and numbers alone.
struct Method {
  const SchemeInfo* scheme = nullptr;  // null: there is none of this name
  bool compiled = false;               // by the program, for its own types
  bool erased = false;                 // the kernel is that of systems without types
  int composition_order = 0;           // 0: one substep
  std::vector<std::string> unused;     // options
  KernelSetup setup;
};
Method plan_method(const Registry& registry, const Config& config, const OwnSystem* own,
                   Mistakes& mistakes);

/// The system with its parameters and inputs.
struct PlannedSystem {
  std::shared_ptr<SystemModel> model;
  std::shared_ptr<Inputs> inputs;
  std::vector<std::string> notes;
};
/// Empty where nothing else can be checked.
std::optional<PlannedSystem> plan_system(const Registry& registry, const Config& config,
                                         const OwnSystem* own, Mistakes& mistakes);

/// I, A, b where a run starts, and the Hamel frame of them, once a start was projected.
struct StartMatrices {
  Eigen::MatrixXd inertia, constraints;
  Eigen::VectorXd drift;
  Eigen::MatrixXd frame = {};
};

/// The start as requested, or the system's own, and the matrices there.
struct PlannedStart : StartMatrices {
  Start start;
  bool refused = false;  // its configuration: no further checks there
  std::vector<std::string> notes;
};
PlannedStart plan_start(const SystemModel& system, const Config& config, Mistakes& mistakes);
/// I, A, b at the start, checked, and the start moved onto the holonomic rows. geometry: null for a
/// group that is not registered. Rows of contacts that are open are no rows of the start, and with
/// slip none of contacts that may slide.
void evaluate_start(const SystemModel& system, const std::shared_ptr<const Inputs>& inputs,
                    const Geometry* geometry, const Config& config, PlannedStart& planned,
                    Mistakes& mistakes);
/// Contacts that may slide or open: their numbers, their rows, and whether the run can follow them.
void check_contacts(const SystemModel& system, const Config& config, const SchemeInfo* scheme,
                    Mistakes& mistakes);
/// A held table of an input that is a rate of the rows A xi = b, where it jumps within the run:
/// that would be an impulse.
void check_jumps_of_rates(const SystemModel& system, const Inputs& inputs, const Geometry& geometry,
                          const Config& config, const PlannedStart& planned, Mistakes& mistakes);
/// The admissible velocity of a start without mistakes; notes what the projection dropped.
void project_start(const SystemModel& system, PlannedStart& planned);
/// The state of an admissible start.
Snapshot state_of(const Start& start, double t);
/// The velocity of a state after an impact, onto the constraints there in the metric I. ConfigError
/// that names the event.
std::vector<double> admissible(const SystemModel& system,
                               const std::shared_ptr<const Geometry>& geometry,
                               const EventState& state, const std::string& event);

/// Data that a file keeps, so that the same run can be resumed.
struct Outputs {
  std::string request, files;
};
Outputs plan_outputs(const RunRequest& request, Mistakes& mistakes);
/// Policy for the rows: of a run by hand they are kept on request, of a run to its end always.
enum class Rows { asked_for, always };
bool keeps_rows(const RunRequest& request, Rows rows);
/// More rows than memory or disk have room for.
void check_rows(const RunRequest& request, const GroupInfo& group, Mistakes& mistakes);

/// The kernel: the program's own, the one compiled for this problem, or the one of any problem.
KernelFactory plan_kernel(const Registry& registry, const Config& config, const OwnSystem* own,
                          const PlannedSystem& planned,
                          const std::shared_ptr<const Geometry>& geometry, Method& method,
                          Mistakes& mistakes);

/// Everything that a run needs.
struct RunPlan {
  Config config;
  std::shared_ptr<const SystemModel> system;
  std::shared_ptr<const Geometry> geometry;  // null for a group that is not registered
  std::vector<std::string> notes, unused;
  bool keeps_rows = true;                 // the scheme does
  bool compiled = true;                   // the kernel, for the types of the system
  bool recording = false;                 // rows of the trajectory are kept
  std::shared_ptr<Reactions> reactions;   // null where there are none
  std::shared_ptr<Reactions> motion;      // of what sensors measure; null without
  std::shared_ptr<RunContacts> contacts;  // null where none may slide or open
  std::unique_ptr<Events> events;
  KernelSetup setup;
  /// Kernels of the run's contacts: that locate their switches, or of the scheme nonsmooth.
  KernelFactory (*with_contacts)(SmoothKernels smooth, std::shared_ptr<const Geometry> geometry,
                                 const SystemModel& system,
                                 std::shared_ptr<RunContacts> contacts) = nullptr;
  KernelFactory kernel;
  SmoothKernels smooth;  // of a piece between switches of contacts
  /// The kernel that takes the steps of the run.
  KernelFactory run_kernel() const;
  Outputs outputs;
};
/// Complete where there are no mistakes.
RunPlan plan_run(const Registry& registry, const RunRequest& request, const OwnSystem* own,
                 Rows rows, Mistakes& mistakes);

}  // namespace hamel
