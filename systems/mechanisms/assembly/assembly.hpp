// From the parts of a mechanism to a system, all of them checked. Not installed: the builder's own.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/mechanisms/multibody.hpp>
#include <hamel/systems/mechanisms/starts/poses.hpp>
#include <hamel/systems/mechanisms/starts/start_checks.hpp>
#include <hamel/systems/mechanisms/starts/starts.hpp>

namespace hamel {

class Assembly {
 public:
  explicit Assembly(const Mechanism& parts) : parts_(parts) {}
  /// Throws ConfigError with all mistakes.
  SystemModel model();
  /// Names, group and inputs alone. Mistakes are left to model().
  SystemModel outline();

 private:
  using Part = Mechanism::Part;
  using Joints = std::vector<const Mechanism::JointPart*>;
  void wrong(const Part& part, const std::string& kind, const std::string& text);
  void unknown(const Part& part, const std::string& kind, const std::string& what,
               const std::string& name, const std::vector<std::string>& known);
  void stop_at_mistakes() const;

  // Bodies and joints: the tree.
  void make_tree();
  void check_names();
  void check_numbers();
  void check_dimension();
  static bool has_spring(const Mechanism::JointPart& joint) {
    return joint.stiffness != 0 || joint.damping != 0;
  }
  void check_body(const Mechanism::BodyPart& body);
  Mat<3, 3> moments_of(const Mechanism::BodyPart& body);
  /// Inertia of bodies that are welded together, of which the whole must be a rigid body.
  mechanisms::Inertia inertia_of(const std::vector<const Mechanism::BodyPart*>& bodies);
  double extent() const;
  bool check_joint(const Mechanism::JointPart& joint);
  Joints joints_of_bodies();
  void link_bodies();
  /// A link without a body for each state, behind all others.
  void link_states();
  /// Adds the rows of states.
  void add_state_rates(std::vector<mechanisms::Coupling>& out);
  void link_from_ground(Joints waiting);
  void check_hinge_names();
  void link(const Mechanism::JointPart& part);
  void add_link(int parent, const std::shared_ptr<const mechanisms::Joint>& joint,
                const Mechanism::JointPart& part, const Point& axis, const std::string& suffix);
  /// Are these values of the fields of a kind of part? Else with mistakes.
  bool check_values(const Part& part, const std::string& kind, const std::vector<Field>& fields,
                    const Parameters& values);
  /// No direction of a contact is vertical.
  bool check_level(const Mechanism::ContactPart& part, const std::vector<Field>& fields);
  void name_columns();
  void state_inputs();
  void check_masses(const mechanisms::Tree& tree);

  // Contacts, loops, forces and the start.
  /// The link of a body; kGround, with a mistake, where there is none of this name.
  int link_of(const Part& part, const std::string& kind, const std::string& body);
  /// Refuses a body that does not move; an unknown one is a mistake of link_of.
  void check_moves(const Part& part, const std::string& kind, const std::string& body);
  /// The link of a joint with one velocity; -1, with a mistake, where there is none of this name.
  int joint_of(const Part& part, const std::string& kind);
  mechanisms::Vec3 direction(const Part& part, const std::string& kind, const std::string& what,
                             const Point& given);
  mechanisms::ConstraintRows rows();
  mechanisms::Ground ground();
  mechanisms::RollingSurface surface(const Mechanism::LoopPart& part);
  /// Refuses a ground on which a contact has no single point where it is drawn.
  void check_feet(mechanisms::ConstraintRows rows, mechanisms::Tree tree);
  /// With mistakes, none.
  std::vector<mechanisms::Coupling> couplings();
  std::optional<mechanisms::Coupling> coupling(const Mechanism::CouplingPart& part,
                                               const std::string& kind, const std::string& key);
  std::optional<mechanisms::Coupling> gear(const Mechanism::CouplingPart& part);
  mechanisms::Forces forces();
  // Contacts that slide and open (assembly_contacts.cpp).
  void check_friction(const Part& part, const std::string& kind, const ContactOptions& options);
  void check_joint_friction(const Mechanism::JointPart& part);
  void check_share(const Part& part, const std::string& kind, const ContactOptions& options);
  void check_distribution();
  void check_brakes();
  void check_taken(const std::string& name);
  /// Dry friction, brakes and stops of joints, and walls, as couplings that do not always hold.
  std::vector<mechanisms::Coupling> slipping_couplings();
  std::optional<mechanisms::Coupling> wall(const Mechanism::WallPart& part);
  std::optional<mechanisms::Coupling> row_of_wall(const Mechanism::WallPart& part,
                                                  Mechanism::CouplingPart row,
                                                  const std::string& key);
  std::optional<mechanisms::Coupling> slip_of_wall(const Mechanism::WallPart& part);
  /// Is this the name of a row of the friction or of a stop of a joint?
  static bool is_of_joint(const std::string& row, const Mechanism::JointPart& part);
  /// The laws of the kept rows.
  void state_contacts(const mechanisms::Multibody& system);
  static int kept_place(const mechanisms::Multibody& system, size_t row);
  /// Law of a contact whose rows, the last of them its height, begin at `row`.
  void add_law(const mechanisms::Multibody& system, const std::string& name,
               const ContactOptions& options, size_t row, size_t rows, double load);
  void add_law(const mechanisms::Coupling& coupling, int place);
  /// Normal forces of contacts without a height, N: given, or of statics in the drawn pose.
  std::vector<double> loads(const mechanisms::Multibody& system);
  void find_loads(const mechanisms::Multibody& system, int root, std::vector<double>& loads);
  Eigen::VectorXd shares_of(const std::vector<size_t>& contacts) const;
  /// The system of these parts, with the rows that are independent and, where wheels have to agree
  /// on a turning centre, those of this agreement.
  std::shared_ptr<mechanisms::Multibody> system_of(mechanisms::ConstraintRows rows,
                                                   mechanisms::Forces forces);
  /// giving_way: rows that are no rows of the system.
  void find_rows(const std::shared_ptr<mechanisms::Multibody>& system,
                 const std::vector<int>& giving_way);
  void check_contacts(const mechanisms::Multibody& system);
  std::vector<mechanisms::RowLabel> rows_in_words(
      const std::vector<mechanisms::RowInfo>& rows) const;
  /// slipping: rows of contacts that constrain, where they hold.
  void look_at_redundant(const mechanisms::Redundancy& redundancy, const std::vector<int>& slipping,
                         const std::vector<mechanisms::RowInfo>& words);
  void look_at_repeat(int row, const mechanisms::Repeat& repeat,
                      const std::vector<mechanisms::RowLabel>& rows, bool drop);
  void look_at_idle_loops(const mechanisms::Redundancy& redundancy,
                          const std::vector<int>& slipping,
                          const std::vector<mechanisms::RowInfo>& words, bool drop);
  std::vector<double> start_configuration(const mechanisms::Multibody& system,
                                          const mechanisms::Starts& starts) const;
  void check_prescribed(const mechanisms::Starts& starts);
  void start(const std::shared_ptr<const mechanisms::Starts>& starts);
  mechanisms::StartChecks start_checks(const mechanisms::Tree& tree);
  void check_motions(const mechanisms::Multibody& system,
                     const std::vector<mechanisms::RowLabel>& rows);
  /// Notes on wheels that cannot roll, a root that cannot move or turn, and supports without load.
  void note_what_stands(const mechanisms::Multibody& system,
                        const mechanisms::Redundancy& redundancy);
  std::vector<std::string> body_names() const;
  std::vector<mechanisms::Multibody::Driver> drivers(const mechanisms::Tree& tree);

  /// The sensors of the model, and its outputs.
  void sense(const mechanisms::Multibody& system);
  void add_outputs();
  void draw(const std::shared_ptr<mechanisms::Multibody>& system);
  void draw_ground(const Expression& height);
  void draw_couplings(const std::shared_ptr<mechanisms::Multibody>& system);
  /// Shapes of a body by its data, of its contacts and rods to its joints, from its mass centre.
  double drawn_scale() const;
  std::vector<BodyShape> shapes_of(const Mechanism::BodyPart& body,
                                   const std::vector<mechanisms::Contact>& contacts) const;

  const Mechanism& parts_;
  std::vector<std::string> mistakes_;
  std::map<std::string, const Mechanism::BodyPart*> bodies_;  // by name
  double extent_ = 0;                                         // m
  SystemModel model_;
  std::vector<mechanisms::Link> links_;
  std::map<int, std::vector<const Mechanism::BodyPart*>> link_bodies_;  // but of the ground
  std::vector<std::string> link_names_;                                 // of their joints
  std::vector<const Mechanism::JointPart*> link_joints_;
  std::deque<Mechanism::JointPart> state_joints_;
  std::map<std::string, int> body_links_;  // the ground is kWorld
  // Rows and starts of the system.
  std::vector<mechanisms::RowLabel> rows_said_;  // of all rows
  std::shared_ptr<mechanisms::Starts> starts_;
  mechanisms::Redundancy redundancy_;
};

}  // namespace hamel
