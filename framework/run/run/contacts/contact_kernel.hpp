// A run with contacts, as one kernel: pieces of smooth motion, each a kernel of its own in one set
// of modes, and between them the switches (contact_dynamics.hpp).
//
// A switch is a root of a gate on the dense output of a step, which ends there:
//   open     gap                          strikes
//   rolling  l_n                          opens
//            mu l_n - |l_t|               slides, along -l_t
//   sliding  l_n                          opens
//            s . d - sigma V              ceases to slip: d the direction of s at the last node,
//                                         V a scale of velocities, sigma = 1e-7, half of |s| where
//                                         that is less already; the slip that is left, and the time
//                                         that it takes to end, are taken to first order, with an
//                                         error of order sigma^2.
//   begins   max(3 eps, 1e-6 V) - |s|     slides (its friction has the direction of the slip), no
//                                         event
//            s . d + sigma V              has not begun
// The step at whose end a slip stops is taken again, up to there. A gap that has just opened has a
// root at its beginning, which is divided out; the first step of a flight takes at most half of it.
// A located switch is obeyed, not tested again.
//   Impacts that accumulate: where the rest of their series, of ratio r, rises less than atol, the
// contact stays closed from there on. Source: Studer, Leine, Glocker, Step size adjustment and
// extrapolation for time-stepping schemes in non-smooth dynamics (2008). Not installed.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/framework/run/run/contacts/kernel_of_contacts.hpp>
#include <hamel/framework/run/run/dip.hpp>
#include <hamel/framework/schemes/dynamic_problem.hpp>

namespace hamel {

class ContactKernel final : public KernelOfContacts {
 public:
  ContactKernel(SmoothKernels smooth, KernelSetup setup, std::shared_ptr<RunContacts> contacts);

  Status advance(long count) override;
  long whole_steps() const override { return steps_; }
  bool off_grid() const override { return false; }
  using Kernel::state;
  void state(Snapshot& out, const StateParts& parts) const override;
  const SolverStats& stats() const override;
  void node(Snapshot& out) const override { now_->node(out); }
  void beginning(Snapshot& out) const override { of_last_step().beginning(out); }
  double time() const override { return now_->time(); }
  double beginning_time() const override { return of_last_step().beginning_time(); }
  void set_end_time(double t) override;
  double next_step() const override { return now_->next_step(); }
  std::unique_ptr<Kernel> another(const KernelSetup& setup) const override;
  void clear_history() override { now_->clear_history(); }
  bool interpolate(double t, Snapshot& out) override;
  bool motion_within(double t, Snapshot& out) override;

 private:
  // A gap of this size, m, is closed at a start, or where other contacts hold it.
  static constexpr double kClosedGap = 1e-9;
  // A slip of this many eps of (5), and of what has ended, has grown.
  static constexpr double kGrown = 3;
  enum class Switch { strikes, bears, opens, slides, stops, grows };
  // Gates of a contact; one that is infinite is none.
  using Gates = std::vector<std::array<double, 3>>;
  struct Found {
    double time;
    int contact;
    Switch what;
  };

  Kernel& of_last_step() const { return before_ != nullptr ? *before_ : *now_; }
  ContactState& contact(int i) const { return contacts_->states()[static_cast<size_t>(i)]; }
  FollowedContact& followed(int i) const { return contacts_->followed()[static_cast<size_t>(i)]; }

  void begin() override;
  // dynamics() at the state of now_, or of a snapshot.
  void evaluate_node();
  void take_node(const std::optional<Found>& found);
  // Behind steps in which all contacts rolled.
  void catch_up();
  void evaluate(const Snapshot& state);
  void follow_speeds();
  void take_direction(int i, const Eigen::Vector2d& direction);
  void find_held();
  void close_held();
  Status fail(const std::string& reason) const;
  Status take_again(double from, double end);
  std::string why_no_node();

  // contact_gates: along the last step.
  // near: off the constraints by about the error of a step, which costs less.
  void gates(double t, Gates& out, bool near = false);
  // Where all contacts roll: by the reactions of the system itself.
  void rolling_gates(double t, Gates& out, bool near);
  void look_at(double t, bool near);
  std::optional<Found> stop_found();
  double slip_left(int i);
  double grown(int i) const;
  double gate(int contact, size_t which, double t);
  double locate(int contact, size_t which, ValueAt before, ValueAt after);
  void graze(int i, double t);
  bool leaves(int i, double opened, double dip);
  std::optional<double> crossing(int contact, size_t which, ValueAt first, ValueAt before,
                                 ValueAt now);
  bool pulls(int i, size_t which, const Gates& before, const Gates& now) const;
  std::optional<Found> find(double from, double to);
  // At the end of a step in which all contacts roll: are their gates far from 0 all along?
  bool stays(double from, double to);
  Switch switch_of(int contact, size_t gate) const;

  // contact_begins: contacts that begin to slide.
  void grow(int first);
  void choose_ease(const ContactStates& before);
  void follow_begun();
  void end_begun(int i);

  // contact_switch: at the state of a switch.
  std::string apply(const Found& found);
  std::string strike_all(int first);
  void end_chatter(int i, double ratio);
  std::string stop_slip(int i);
  std::string decide(const std::vector<char>& slides);
  std::string go_on(const std::vector<char>& slides);
  std::vector<char> at_rims(int first);
  void take_up(double step);
  std::shared_ptr<const Mechanics> mechanics_of(
      const std::shared_ptr<const ContactStates>& states) const;
  bool all_roll() const;
  double first_step(double step);
  bool too_many(double t);

  // A kernel of one set of modes, which stays as it is when the run has others.
  struct Piece {
    std::shared_ptr<ContactStates> states;
    std::unique_ptr<Kernel> kernel;
    bool ideal = false;  // of the system itself
  };
  std::map<std::vector<int>, std::vector<Piece>> pieces_;  // by their modes
  Kernel* now_ = nullptr;
  std::shared_ptr<ContactStates> now_states_;  // of its piece
  Kernel* before_ = nullptr;                   // of the last step, where a switch ended it
  double usual_step_ = 0;  // that a step would have been followed by, had it not been taken again
  double stop_ = std::numeric_limits<double>::infinity();  // of a slip, where a step ends
  long steps_ = 0;
  std::string failure_;  // of a start or a switch
  // A slip at the last node: its direction, and the size at which it has ended.
  struct Slip {
    Eigen::Vector2d reference = {1, 0};
    double least = 0;
  };
  std::vector<Slip> slips_;
  // A slip that begins: when, and its largest part across its friction.
  struct Begun {
    double since = 0, across = 0;
  };
  std::vector<Begun> begun_;
  Gates at_node_, middle_, end_, one_;
  Gates before_node_;         // of the node before, where all contacts have rolled since
  std::vector<Gates> looks_;  // at the parts of a step
  std::unique_ptr<EquationsOfMotion<DynamicProblem>>
      all_rolls_;        // where their rows are those of now_
  bool rolled_ = false;  // dynamics() and the speeds that are followed are those of an earlier node
  bool rolls_on_ = false;  // the last step did: at_node_ is of now_
  // The state of a switch.
  double ends_ = 0;  // of its impacts, where they accumulate
  Eigen::VectorXd move_;
  std::vector<std::pair<std::string, double>> events_;
  Snapshot snapshot_;
  mutable Snapshot shown_;
  mutable SolverStats all_;
};

}  // namespace hamel
