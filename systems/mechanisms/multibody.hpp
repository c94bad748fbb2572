// A tree of bodies with its rows and forces as Mechanics: what the schemes step.
//
// What a step evaluates are programs (programs/mechanism_programs.hpp), recorded when the first of
// them is needed; behind that nothing here takes memory. Work space is kept, so that an object
// serves one run at a time.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/graph/motion_terms.hpp>
#include <hamel/framework/mechanics/implied_rows.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/systems/mechanisms/programs/lift_programs.hpp>
#include <hamel/systems/mechanisms/programs/mechanism_programs.hpp>

namespace hamel::mechanisms {

/// A row that was dropped, at a place and time: b of A xi = b, and what the rows that are kept make
/// it.
struct ImpliedRow {
  int row;
  std::string name, sum;  // "rr.rate"; of prescribed rates, "fl.rate + fr.rate - rl.rate"
  double is = 0, has_to_be = 0;
  bool contradicts = false;
  /// "rr.rate has to be fl.rate = 3: got 2"
  std::string in_words() const;
};

class Multibody final : public Mechanics,
                        public graph::HasRowFields,
                        public graph::HasMotionTerms,
                        public graph::HasSystemFormulas,
                        public HasImpliedRows {
 public:
  /// All rows of `rows`; keep() drops some.
  Multibody(const Tree& tree, ConstraintRows rows, Forces forces,
            std::shared_ptr<const Geometry> geometry);
  /// A system as one, or null: for other libraries, which lack the type.
  static std::shared_ptr<const Multibody> of(const std::shared_ptr<const Mechanics>& system);
  /// Only these rows of each(), of which the holonomic ones go last.
  void keep(const std::vector<int>& rows);
  /// Rows that were dropped since those that are kept imply them.
  void imply(std::vector<int> rows);
  std::vector<ImpliedRow> implied_rows(double t, const double* g) const;
  std::string contradiction(double t, const double* g) const override;
  /// An input as the effort on a velocity of a joint, or as the rate prescribed there.
  struct Driver {
    int dof;
    bool rate;
  };
  /// With the inputs of a run, the first of them those of the drivers; without, they are zero.
  void drive(const std::vector<Driver>& drivers, const std::shared_ptr<const Inputs>& inputs);
  /// Is I(g) the same for all g, are A and V? Read off several poses that share nothing.
  void find_constants(const std::vector<std::vector<double>>& poses);

  int dim() const override { return tree_.dim(); }
  int constraint_count() const override { return static_cast<int>(kept_.size()); }
  int holonomic_rows() const override { return holonomic_; }
  bool constant_inertia() const override { return constant_inertia_; }
  bool constant_constraints() const override { return constant_rows_; }
  bool autonomous() const override;
  bool has_force() const override { return forces_.any(); }
  bool has_drift() const override {
    return rows_.ground.moves() || !rows_.prescribed.empty() || rows_.has_states();
  }
  bool constant_potential() const { return constant_potential_; }

  void inertia(const double* g, Matrix out) const override;
  void momentum(const double* g, ConstVector xi, Vector out, Vector inertial_force) const override;
  void constraints(double t, const double* g, Matrix a, Vector b) const override;
  void constraint_values(double t, const double* g, ConstVector xi, Vector out) const override;
  bool exact_rates() const override { return true; }
  void begin() const override;
  bool has_accelerations() const override;
  void accelerations(double t, const double* g, ConstVector xi, Vector out) const override;
  /// Empty where a prescribed rate changes with time.
  std::optional<graph::RowFields> row_fields() const override;
  graph::MotionTerms motion_terms(const graph::MotionVariables& at) const override;
  /// Throws std::domain_error as motion_terms().
  graph::SystemFormulas system_formulas(std::span<const graph::Number> variables) const override;
  void motion(const Geometry& geometry, double t, const double* g, ConstVector xi, Matrix inertia,
              Matrix a, Vector b, Vector rows, Vector change) const override;
  void holonomic(const double* g, Vector out) const override;
  void force(double t, const double* g, ConstVector xi, Vector out) const override;
  void inertial_force(const double* g, ConstVector xi, Vector out) const override;
  void applied_force(double t, const double* g, ConstVector xi, Vector out) const override;
  bool force_depends_on_velocity() const override { return forces_.any(); }
  double power(double t, const double* g, ConstVector xi) const override;
  double potential(const double* g) const override;

  /// Layout of the programs of lift; null where they do not cover the system.
  std::shared_ptr<const LiftLayout> lift_layout() const;
  /// Programs of the drawn pose, with which each run begins; near a state, with so many unknowns.
  std::shared_ptr<const LiftPrograms> lift_programs() const;
  std::shared_ptr<const LiftPrograms> lift_programs(const double* g, ConstVector xi,
                                                    size_t unknowns) const;

  const ConstraintRows& all_rows() const { return rows_; }
  const Forces& forces() const { return forces_; }
  /// Meanings of all rows, in the order of each().
  const std::vector<RowInfo>& row_info() const { return row_info_; }
  const std::vector<int>& kept() const { return kept_; }
  /// The kept rows that always hold, without contacts that may slide or open.
  std::vector<int> holding() const;
  const Geometry& geometry() const { return *geometry_; }
  /// The element of the drawn pose.
  const std::vector<double>& drawn() const { return tree_.drawn(); }
  /// The tree at g.
  const Tree& tree(const double* g) const {
    tree_.place(g);
    return tree_;
  }
  /// The force of the kept rows of a contact with these multipliers, in the world.
  Vec3 reaction(const std::string& part, const double* g,
                std::span<const double> multipliers) const;
  /// phi of all rows of each(), 0 where it is none, and their A.
  void look(double t, const double* g, Matrix a, Vector b, Vector phi) const;
  /// Measurement of a sensor at a point of a link as drawn (programs/sensor_formulas.hpp).
  std::function<void(std::span<const double> coordinates, std::span<const double> velocity,
                     std::span<const double> acceleration, std::span<double> out)>
  sensor(int link, const Vec3& at) const;
  /// Agreements of these rows, whose rank falls at the first of the poses
  /// (programs/agreement_formulas.hpp).
  std::vector<Agreement> find_agreements(const std::vector<int>& rows,
                                         const std::vector<std::vector<double>>& poses) const;

 private:
  MechanismParts parts() const { return {tree_, rows_, forces_, kept_, holonomic_, *geometry_}; }
  MechanismPrograms& programs() const;
  std::optional<MotionProgram> record(std::span<const double> state) const;
  struct RecordedPlace {
    std::vector<graph::Number> element, velocities, inputs;
    std::function<graph::Number(int link)> coordinate;  // of a hinge or slider
  };
  std::vector<graph::Number> recorded_state(const RecordedPlace& at) const;
  void forget_programs();
  bool rates_may_contradict() const;
  // The state of programs: what of it depends on g; on xi too; on t and all.
  const double* state(const double* g) const;
  const double* state(const double* g, ConstVector xi) const;
  const double* state(double t, const double* g, ConstVector xi) const;
  void look_at_agreements(const double* g, Matrix a, Vector phi) const;
  void find_places(std::span<double> state) const;
  void take_rates(double t) const;
  void take_signals(double t) const;

  mutable Tree tree_;
  ConstraintRows rows_;
  std::vector<RowInfo> row_info_;
  Forces forces_;
  std::shared_ptr<const Geometry> geometry_;
  std::vector<int> slots_;  // of each(): the row of A, or -1
  std::vector<int> kept_;   // their inverse
  std::vector<int> implied_;
  std::shared_ptr<const Inputs> inputs_;
  std::vector<Driver> drivers_;
  size_t driven_motors_ = 0;
  int holonomic_ = 0;
  bool constant_inertia_ = false, constant_rows_ = false, constant_potential_ = false;
  Eigen::MatrixXd inertia_, fixed_rows_;  // where they are constant
  mutable std::optional<MechanismPrograms> programs_;
  mutable std::optional<FilledProgram> rates_, agreements_;
  // The accelerations: the program with which each run begins, recorded at the drawn pose, and the
  // one in use.
  mutable std::optional<MotionProgram> first_motion_, motion_;
  mutable bool recorded_motion_ = false;
  mutable std::shared_ptr<const LiftPrograms> first_lift_;
  mutable std::vector<double> state_, coordinates_;
  mutable Eigen::VectorXd work_;
};

}  // namespace hamel::mechanisms
