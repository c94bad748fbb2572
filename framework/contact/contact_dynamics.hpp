// The motion of a system in the modes of its contacts: accelerations and reactions, what a mode is
// after a switch, and impacts.
//
// In W = [N; T] of a contact N is its normal row and T its tangential rows, s = T xi - b_T the
// slip. With M_A the inverse inertia projected along the rows that are always on,
//   I xi' = ad*_xi I xi + F + A^T l + sum C^T l_c,   A xi' = b' - A' xi,   R xi' = b_R' - R' xi,
//   rolling: R = C = W;   sliding: R = N, C = N - mu (s/|s|)^T T,                               (2)
// so that the friction of a sliding contact is implicit in its normal reaction: one linear system,
// not symmetric, K l_c = b_R' - R' xi - R a, K = R M_A C^T, a the acceleration without contacts.
// Behind a slip that ends friction continues smoothly, against s/|s| or -s/|s|, whichever is along
// the slip at the last node: no stage of a step that passes the end has a jump; the step ends
// there. A contact with a given load in place of N has the force -mu load T^T s/|s| when it slides.
// Where rows of contacts that roll depend on each other (four wheels of a cart) the motion is
// unique, and their reactions are those of the least sum of (l/(mu load))^2: contacts of equal
// compliance, none beyond its cone as long as the others hold the rest (limit_load.hpp). Where
// normal reactions do (four legs) what slides moves as its loads are, and they are those of
// contacts that give way by l/share each, small beside all else.
//   Modes after a switch: the contact problem with G = W M_A C^T and c = W a + W' xi - b_W', of
// contacts that slip N and C of (2) alone, of the others W.                                     (3)
//   Impact: the contact problem with G = W M_A W^T, c = ((1 + e)(N xi - b_N), T xi - b_T), e = 0 of
// contacts that already rest; then xi <- xi + M_A W^T P, and (3).                               (4)
// Where several are coupled P depends on the order of their impacts, unless those that rest leave
// without an impulse (the hind spoke of a rimless wheel) or none has friction or restitution.
//   Where a contact in space begins to slide its slip grows as t^2 and turns with its friction at a
// rate of about a/|s|, a = mu l_n T M_A T^T, without end as t -> 0: behind this it follows the
// direction d of the contact problem, gamma_t = k d, and lags behind by d'|s|/a. While it begins
// friction is against
//   e = (s + eps d)/|s + eps d|,                                                                (5)
// which is d at first, s/|s| at last, and leaves s the same lag, but for eps d'/a: the rate of e is
// a/(|s| + eps) at most, and the error of a velocity about eps^2 d'/a. Source:
// Pfeiffer, Glocker, Multibody Dynamics with Unilateral Contacts (1996); Leine, Nijmeijer, Dynamics
// and Bifurcations of Non-Smooth Mechanical Systems (2004).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include <hamel/framework/contact/contact_problem.hpp>
#include <hamel/framework/contact/limit_load.hpp>
#include <hamel/framework/contact/pivots.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/contact_law.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/metric/metric.hpp>

namespace hamel {

/// A contact at a time.
struct ContactState {
  ContactMode mode = ContactMode::open;
  Eigen::Vector2d direction = {1, 0};  // of the slip, where it is too small to have one
  double no_slip = 0;                  // m/s: smaller slips have none
  bool begins = false;                 // it begins to slide, (5)
  double ease = 0;                     // m/s: eps; direction is near d
};
using ContactStates = std::vector<ContactState>;

/// A contact's impulses in the problem of a step: none, that of N alone, all.
enum class ImpulseOf : char { none, normal, all };

class ContactDynamics {
 public:
  using ConstVector = Eigen::Ref<const Eigen::VectorXd>;

  /// mechanics: with the rows of all contacts.
  ContactDynamics(std::shared_ptr<const Geometry> geometry,
                  std::shared_ptr<const Mechanics> mechanics, std::vector<ContactLaw> laws);

  /// The inputs that loads follow; null: those are 0.
  void drive(std::shared_ptr<const Inputs> inputs) { inputs_ = std::move(inputs); }

  int count() const { return static_cast<int>(laws_.size()); }
  const ContactLaw& law(int i) const { return laws_[static_cast<size_t>(i)]; }
  const Mechanics& mechanics() const { return *mechanics_; }
  const std::shared_ptr<const Geometry>& geometry() const { return geometry_; }
  /// The rows that are on in these modes, ascending, without those that follow from others where
  /// evaluate() was.
  std::vector<int> rows(const ContactStates& states) const;

  /// Everything that follows needs one: all at (t, g, xi).
  void evaluate(double t, const double* g, const ConstVector& xi);
  double gap(int i) const;
  double gap_rate(int i) const;
  Eigen::Vector2d slip(int i) const;
  /// Is the slip of contact i more than round-off?
  bool slips(const ContactState& state, int i) const { return slip(i).norm() > 10 * state.no_slip; }
  /// The largest velocity that the kinetic energy could be that of at a contact.
  double speed_scale(int i) { return scale_at(i, xi_); }
  /// The same of an acceleration, behind accelerate(): of that without the contacts' reactions.
  double acceleration_scale(int i) { return scale_at(i, free_); }

  /// The acceleration in these modes, (2), into acceleration(). False where the system is singular.
  bool accelerate(const ContactStates& states);
  const Eigen::VectorXd& acceleration() const { return acceleration_; }
  /// Behind accelerate(): d of (5) of contact i, which begins to slide.
  const Eigen::Vector2d& first_direction(int i) const { return first_[static_cast<size_t>(i)]; }
  /// Behind accelerate(): a of (5).
  double friction_acceleration(int i);
  /// Behind accelerate(): the multipliers of all rows, those of open contacts 0.
  const Eigen::VectorXd& reactions();
  double normal_reaction(int i) const { return normal_[static_cast<size_t>(i)]; }
  Eigen::Vector2d tangential_reaction(int i) {
    limit();
    return tangential_[static_cast<size_t>(i)];
  }
  /// How far contact i, which rolls, is from the rim of its cone, N; 0 where it begins to slide.
  double hold_left(int i);
  /// Does contact i, which rolls, begin to slide where `first` does?
  bool yields_with(int i, int first);
  /// Behind accelerate(), of an open contact whose normal row follows from those of closed ones
  /// (the fourth of four legs): its height where these give way by l/share each, which is above 0
  /// as long as it bears nothing; infinite where what sticks holds it. None where it is free.
  std::optional<double> height_of_held(const ContactStates& states, int i);
  /// N M_A C^T of a contact that slides.
  double coefficient(int i) const { return coefficient_[static_cast<size_t>(i)]; }
  /// The power of these reactions, l . (A xi - b): of friction.
  double reaction_power() const;
  /// The part of contact i in it.
  double friction_power(int i) const { return tangential_[static_cast<size_t>(i)].dot(slip(i)); }
  /// The rates of gap_rate() and slip() at acceleration().
  double gap_acceleration(int i) const;
  Eigen::Vector2d slip_rate(int i) const;

  /// The modes behind a switch that changes those of its contacts alone, as `states` has them:
  /// their directions, and whether all satisfy (3). An open contact with a gap below `closed` has
  /// to leave.
  bool continue_in(ContactStates& states, double closed);
  /// Modes of the contacts that are closed, (3). slides: those that begin to slide in their
  /// direction. Returns why there are none, "" where there are.
  std::string decide(ContactStates& states, const std::vector<char>& slides = {});
  /// The velocity after an impact, (4), in place of xi: of contacts that strike, and of those that
  /// are closed already. Returns why there is none.
  std::string strike(const ContactStates& states, const std::vector<char>& strikes,
                     Eigen::VectorXd& xi);
  /// The impulses at one end of a step (nonsmooth_kernel.hpp), of the contacts that are `on`: those
  /// that slip have N and C of (2) where their direction is known, all others W; given loads press
  /// for a time, and what slips under them has that impulse.
  void set_up_impulses(const ContactStates& states, const std::vector<ImpulseOf>& on, double time,
                       bool along_slip);
  /// Behind it: how many, their rows, what one does to the velocity, and what given loads do.
  int impulse_count() const { return static_cast<int>(on_.size()); }
  int impulse_row(int i) const { return on_[static_cast<size_t>(i)].row; }
  int impulse_contact(int i) const { return on_[static_cast<size_t>(i)].contact; }
  auto impulse_response(int i) const { return responses_.col(i); }
  const Eigen::VectorXd& given_change() const { return free_; }
  /// The impulses P with gamma = G P + c, into impulses(), and what the contacts then do. near:
  /// from those of a problem next to this one. Returns why there are none.
  std::string solve_impulses(const Eigen::MatrixXd& g, const Eigen::VectorXd& c, bool near,
                             ContactStates& states);
  /// Do their rows depend on each other by this G?
  bool impulses_depend(const Eigen::MatrixXd& g);
  /// The next problems are next to none.
  void forget_impulses() {
    for (Problem& problem : problems_) problem.of.forget();
  }
  auto impulses() const { return problem().p(); }
  /// Behind it: are their rows dependent? A G that is not theirs hides it.
  bool shared() const { return shared_; }
  /// G = W M_A C^T of these.
  void impulse_metric(Eigen::MatrixXd& out) const;
  /// Takes the slip of contact i, and what other rows that are on have gained, out of xi.
  bool stop(const ContactStates& states, int i, Eigen::VectorXd& xi);
  /// Takes the rate of its gap out of xi, along C of (2).
  void rest(const ContactStates& states, int i, Eigen::VectorXd& xi);

 private:
  double scale_at(int i, const Eigen::VectorXd& velocity);
  int hold(const ContactStates& states, int i, bool across);
  struct Row {
    int row;      // of A
    int contact;  // whose it is
  };
  // The direction of the slip that friction opposes, as accelerate() finds it for all.
  const Eigen::Vector2d& direction(int i) const { return directions_[static_cast<size_t>(i)]; }
  void find_loads(double t);
  void find_direction(const ContactStates& states, int i);
  // That of (5), nearest to the one that it has.
  void find_first_direction(const ContactStates& states, int i);
  void take_nearest_slide(int i);
  double turn_first_directions(const ContactStates& states);
  void find_first_directions(const ContactStates& states);
  // M_A of column_, or of a row of A, into a column of responses_.
  void respond(int column);
  void respond_to(int row, int column);
  void sliding_row(int i, const Eigen::Vector2d& d, Eigen::VectorXd& out) const;
  void free_acceleration(const ContactStates& states, int without = -1);
  // Rows of a contact that are on, C of (2) or W, and their responses.
  void add_rows(int i, ContactMode mode);
  void set_up(const ContactStates& states);
  void take_reactions(const ContactStates& states);
  double row_times(int row, const ConstVector& v) const {
    double sum = 0;
    for (Eigen::Index i = 0; i < v.size(); ++i) sum += a_(row, i) * v[i];
    return sum;
  }
  bool project(const std::vector<int>& rows, Eigen::VectorXd& xi);
  // The contact of the next block, with its rows at the end of on_ and their responses.
  void add_block(int i, bool slides, const Eigen::Vector2d& d);
  // Does a contact that is closed slide already? Its direction is known then, and its friction.
  bool slides_on(ContactState& state, int i, bool told);
  bool slips_at(const ContactBlock& block) const;
  bool lawful(const ContactStates& states, int i, double force, double closed);
  void take_answer(ContactState& state, size_t block) const;
  // G of responses_ into k_; the solution with k_ and c_.
  void find_metric();
  std::string solve_problem(const char* level, bool near = false);
  std::string names_of_blocks() const;
  void set_up_impact(const ContactStates& states, const std::vector<char>& strikes, bool beside);
  std::string why_coupled() const;
  std::string solve_impact(Eigen::VectorXd& xi);
  bool others_leave(const ContactStates& states, const std::vector<char>& strikes,
                    const Eigen::VectorXd& xi);
  bool dependent();
  // K l = right side, in k_work_ and multipliers_, of m rows; where they depend on each other the
  // reactions are those of the least sum of squares, each in units of its bound.
  void solve_rows(int m);
  Eigen::Map<Eigen::MatrixXd> k_map(int m) { return {k_work_.data(), m, m}; }
  void share(int m, int rank);
  // Reactions that all hold, of contacts that roll; once behind accelerate().
  void limit();
  int keep_tangential(int m);
  double holds(int i) const;
  // near: P is that of a problem next to this one.
  ContactProblem::Outcome give_way(int m, bool near);
  void give_way_by(double compliance, int m);

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> mechanics_;
  std::vector<ContactLaw> laws_;
  std::shared_ptr<const Inputs> inputs_;
  std::vector<double> constant_loads_;
  std::vector<int> always_;  // rows of no contact
  Metric<> metric_;          // with the rows that are always on
  Eigen::MatrixXd a_;        // all rows, and b, and the rates b' - A' xi
  Eigen::VectorXd b_, rates_;
  Eigen::VectorXd xi_, change_, force_, free_, acceleration_, gaps_, always_rates_, no_rates_;
  Eigen::VectorXd reactions_, row_, column_, work_;
  Eigen::MatrixXd responses_;  // M_A C^T, a column a row
  Eigen::MatrixXd k_, k_work_, right_;
  ContactSolutions solutions_;
  Eigen::VectorXd multipliers_, c_;
  std::vector<double> normal_, coefficient_;
  std::vector<Eigen::Vector2d> tangential_, directions_, first_;
  std::vector<Row> on_;
  Pivots pivots_;
  LimitLoad limit_;
  int open_ = 0;  // columns of null_ behind accelerate(), until limit() has seen them
  Eigen::MatrixXd null_, left_null_, normal_equations_;
  Eigen::VectorXd work_m_;
  std::vector<ContactBlock> blocks_;
  std::vector<int> block_contacts_;
  // Problems at the end of a step, and elsewhere; each continues its last solution.
  struct Problem {
    Problem(int unknowns, int contacts) : of(unknowns, contacts), rank(unknowns, unknowns) {}
    ContactProblem of;
    Eigen::FullPivLU<Eigen::MatrixXd> rank;
  };
  std::array<Problem, 2> problems_;
  bool at_end_ = false;
  ContactProblem& problem() { return problems_[at_end_ ? 1 : 0].of; }
  const ContactProblem& problem() const { return problems_[at_end_ ? 1 : 0].of; }
  bool shared_ = false;  // the last problem had dependent rows
  double time_ = 0;
};

/// The system in one set of modes: its rows that are on, and (2). For one run, whose states it
/// follows.
class ModeMechanics final : public Mechanics {
 public:
  ModeMechanics(std::shared_ptr<ContactDynamics> dynamics,
                std::shared_ptr<const ContactStates> states);
  int dim() const override { return full().dim(); }
  int constraint_count() const override { return static_cast<int>(rows_.size()); }
  int holonomic_rows() const override { return static_cast<int>(gaps_.size()); }
  bool constant_inertia() const override { return full().constant_inertia(); }
  bool constant_constraints() const override { return full().constant_constraints(); }
  bool autonomous() const override { return full().autonomous(); }
  bool has_force() const override { return true; }
  bool has_drift() const override { return full().has_drift(); }
  void inertia(const double* g, Matrix out) const override { full().inertia(g, out); }
  void momentum(const double* g, ConstVector xi, Vector out, Vector force) const override {
    full().momentum(g, xi, out, force);
  }
  void constraints(double t, const double* g, Matrix a, Vector b) const override {
    rows_at(t, g, a, b);
  }
  void holonomic(const double* g, Vector out) const override { gaps_at(g, out); }
  void begin() const override { full().begin(); }
  bool has_accelerations() const override { return true; }
  void accelerations(double t, const double* g, ConstVector xi, Vector out) const override {
    accelerate(t, g, xi, out);
  }
  void force(double t, const double* g, ConstVector xi, Vector out) const override {
    full().force(t, g, xi, out);
  }
  void inertial_force(const double* g, ConstVector xi, Vector out) const override {
    full().inertial_force(g, xi, out);
  }
  double power(double t, const double* g, ConstVector xi) const override {
    return full().power(t, g, xi);
  }
  double potential(const double* g) const override { return full().potential(g); }

 private:
  const Mechanics& full() const { return dynamics_->mechanics(); }
  // Out of line, as virtual functions cannot be (tools/cmake/localise).
  void rows_at(double t, const double* g, Matrix a, Vector b) const;
  void gaps_at(const double* g, Vector out) const;
  void accelerate(double t, const double* g, ConstVector xi, Vector out) const;

  std::shared_ptr<ContactDynamics> dynamics_;
  std::shared_ptr<const ContactStates> states_;
  std::vector<int> rows_, gaps_;      // of A; of phi
  mutable Eigen::MatrixXd all_rows_;  // work space
  mutable Eigen::VectorXd all_b_, all_gaps_;
};

}  // namespace hamel
