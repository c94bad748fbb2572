// The scheme `nonsmooth`: a run with contacts in steps of one size, without a search for switches.
//
// From a node (g0, xi0), with W = [N; T] and C of contact_dynamics.hpp (2), a step of lift between
// impulses P at its beginning and Q at its end:
//   xi0' = xi0 + M_A C(g0)^T P,   (g1, xi1') = lift(g0, xi0'),   xi1 = xi1' + M_A W(g1)^T Q.
// P: the contact problem of gamma = (gap(g1)/h, T(gm) xm), gm = g0 tau(h xm/2), g1 = g0 tau(h xm);
//    a contact that slips at g0 has N and C alone, its friction against that slip; one that strikes
//    in the step has N alone.
// Q: that of gamma = W(g1) xi1 - b; of a contact that strikes in the step gamma_n has
//    + e min(0, N xi0 - b), unless that bounce ends within a step, and the cone holds P + Q.
// Given loads press h/2 at either end. So no gap is ever below 0, what slides or rolls is of order
// 2, through the end of a slip too, and an impact of order 1. The problem of P is solved by secants
// of gamma from G = W M_A C^T on, or from where those of the step before have ended. Source:
// Breuling, Capobianco, Eugster, Leine, A nonsmooth RATTLE algorithm for mechanical systems with
// frictional unilateral constraints (2024), whose cone holds P + Q of all contacts, which is of
// order 1. Not installed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/run/run/contacts/kernel_of_contacts.hpp>

namespace hamel {

class NonsmoothKernel final : public KernelOfContacts {
 public:
  /// smooth: of lift.
  NonsmoothKernel(SmoothKernels smooth, KernelSetup setup, std::shared_ptr<RunContacts> contacts);

  Status advance(long count) override;
  long whole_steps() const override { return whole_; }
  bool off_grid() const override { return left_ != setup_.step; }
  using Kernel::state;
  void state(Snapshot& out, const StateParts& parts) const override;
  const SolverStats& stats() const override;
  void node(Snapshot& out) const override { lift_->node(out); }
  void beginning(Snapshot& out) const override { out = before_; }
  double time() const override { return time_; }
  double beginning_time() const override { return before_.time; }
  void set_end_time(double t) override;
  double next_step() const override { return left_; }
  std::unique_ptr<Kernel> another(const KernelSetup& setup) const override;
  void clear_history() override { lift_->clear_history(); }
  bool interpolate(double t, Snapshot& out) override;
  bool motion_within(double t, Snapshot& out) override { return interpolate(t, out); }

 private:
  static constexpr double kNoSpeed = 1e-10;  // of what the energy allows

  void begin() override;
  // lift goes on at the node with this velocity.
  void put_lift(Nearby to, std::span<const double> velocity, double size);
  // How long the next step is, which an input may end.
  Status find_length();
  // A step with these impulses at its beginning: into end_, g1_, gaps_.
  Status take_step(const Eigen::VectorXd& p, Nearby to);
  // gamma of P behind it.
  Status find_gamma(Eigen::VectorXd& out);
  void begin_press();
  Status press();
  Status find_impulses();
  void forget_steps();
  double place_scale(int row) const;
  bool others_strike();
  std::string end_step();
  std::string solve_end(const std::vector<ImpulseOf>& on, double h);
  bool bounces(const ContactLaw& law, int row) const;
  void find_no_speeds();
  void take_modes(const ContactStates& before);
  Status take_one();
  Status fail(const std::string& reason, double residual = 0) const;

  std::unique_ptr<Kernel> lift_;
  double left_ = 0;    // of the step that an input has ended
  double length_ = 0;  // of the next
  long steps_ = 0, whole_ = 0;
  // The end of a step without Q, the node before; the step without what strikes in it.
  Eigen::VectorXd g1_, xi1_;
  Snapshot end_, before_, unstruck_, measured_;
  ContactStates states_;
  std::vector<ImpulseOf> on_;
  std::vector<char> strikes_;
  std::vector<double> no_speeds_;
  Eigen::VectorXd rates_;  // W xi0 - b
  // Rows of P, with the modes of their contacts, and those of the step before; in how many steps
  // since they have been the same.
  struct PressedRow {
    int row, contact;
    ContactMode mode;
    bool operator==(const PressedRow&) const = default;
  };
  std::vector<PressedRow> rows_of_p_, rows_before_;
  int steady_ = 0;
  bool fresh_ = true;            // what lift has solved is not near
  Nearby first_ = Nearby::node;  // the first step of press()
  double round_off_ = 0;         // of gamma
  std::vector<size_t> lengths_;  // coordinates that are places
  std::vector<char> is_place_;   // velocities
  Eigen::VectorXd p_, p_before_, gamma_, gaps_, b_, given_, pushed_;
  // G of P, with what secants have found beside its own.
  Eigen::MatrixXd responses_, metric_, own_metric_, beside_, a_;
  int iterations_ = 0;  // secants of the last step
  int most_ = 0;        // iterations of lift in one step, over all its secants
  mutable SolverStats stats_;
  // Work space.
  Eigen::VectorXd middle_, moved_, half_, now_, move_, missed_, best_, c_, turned_, done_, at_end_,
      unpushed_;
  std::vector<ImpulseOf> on_at_end_;
  std::vector<double> pressed_;
  ContactStates modes_before_, all_open_;
};

}  // namespace hamel
