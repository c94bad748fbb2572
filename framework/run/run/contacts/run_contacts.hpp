// The contacts of a run: their modes, as its kernel has them, and what has switched. Not installed.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/contact/contact_dynamics.hpp>
#include <hamel/framework/loop/snapshot.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel {

/// A contact as the kernel follows it.
struct FollowedContact {
  double opened = -1e300;  // when it left its gap of 0, which is a root of the gap then
  double struck = -1e300, between = 0;  // last strike, and the time before it since another
  double speed = 0;                     // m/s: the largest speed_scale() so far
  double rest = 0;                      // m/s: a contact as slow as this is at rest
  double height = 0;                    // m: the largest gap so far
  bool held = false;  // open, at a height that others hold; found again at each node
  double scale() const { return std::max(speed, rest); }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(opened, struck, between, speed, height);
  }
};

/// A switch that was met: events by name, with the state before and behind them.
struct ContactSwitch {
  std::vector<std::pair<std::string, double>> events;  // with their times
  Snapshot before, after;
};

/// Kernels of pieces without a switch: of any mechanics, and of the system itself, whose contacts
/// all roll, which may be compiled for its types.
struct SmoothKernels {
  KernelFactory any, ideal;
};

class RunContacts {
 public:
  RunContacts(std::shared_ptr<const Geometry> geometry, const SystemModel& system);

  /// The inputs that loads follow.
  void drive(const std::shared_ptr<const Inputs>& inputs) {
    dynamics_->drive(inputs);
    measured_->drive(inputs);
  }

  const SystemModel& system() const { return *system_; }
  const std::shared_ptr<ContactDynamics>& dynamics() const { return dynamics_; }
  ContactStates& states() { return *states_; }
  std::shared_ptr<const ContactStates> shared_states() const { return states_; }
  std::vector<FollowedContact>& followed() { return followed_; }
  /// A kernel of it continues in its modes, else it finds them at its start.
  bool known() const { return known_; }
  void set_known(bool known) { known_ = known; }
  /// Another run: at another start.
  void begin_anew();
  /// The changes of mode as events.
  void name_changes(const ContactStates& before, double t,
                    std::vector<std::pair<std::string, double>>& events) const;

  /// Switches of the last step; the driver takes them.
  std::vector<ContactSwitch> switches;
  std::vector<std::string> notes;
  // Switches since a time, of those that never end.
  double window = 0;
  long met = 0;

  // ---- measured, in the modes of the run, or of the last step before its switch ----
  void look_back(bool back) { looks_back_ = back; }
  void keep_modes() { before_ = *states_; }
  /// Numbers of ContactMode, one a contact.
  std::vector<double> mode_numbers() const;
  const ContactStates& looked_at() const { return looks_back_ ? before_ : *states_; }
  bool any_slides() const {
    return std::ranges::any_of(
        looked_at(), [](const ContactState& state) { return state.mode == ContactMode::slides; });
  }
  /// The multipliers of all rows.
  const Eigen::VectorXd& reactions(double t, const double* g, const Eigen::VectorXd& xi);
  /// Behind reactions(): xi'.
  const Eigen::VectorXd& acceleration() const { return measured_->acceleration(); }
  /// Behind reactions(): their power, which is that of friction.
  double reaction_power() { return measured_->reaction_power(); }
  /// Behind the power of balanced(): that of friction at contact i.
  double friction_power(int i) const { return any_slides() ? measured_->friction_power(i) : 0; }
  /// The system in the modes of the run.
  std::shared_ptr<const Mechanics> in_modes() const;
  /// The system as its energy is followed: with the power of friction.
  std::shared_ptr<const Mechanics> balanced(const std::shared_ptr<RunContacts>& self) const;

  template <class Archive>
  void serialize(Archive& archive) {
    for (ContactState& s : *states_) {
      int mode = static_cast<int>(s.mode);
      archive(mode, s.direction[0], s.direction[1], s.no_slip, s.begins, s.ease);
      s.mode = static_cast<ContactMode>(mode);
    }
    for (FollowedContact& f : followed_) f.serialize(archive);
    archive(known_, notes, window, met);
  }

 private:
  std::shared_ptr<const SystemModel> system_;
  std::shared_ptr<ContactDynamics> dynamics_, measured_;
  std::shared_ptr<ContactStates> states_;
  ContactStates before_;
  std::vector<FollowedContact> followed_;
  bool known_ = false, looks_back_ = false;
};

}  // namespace hamel
