// The reactions of a run's constraints at its states, each solved once, for all: columns,
// contacts that may be lost, the balance of the energy, kept numbers of an ensemble. Not installed.
#pragma once

#include <memory>

#include <Eigen/Core>

#include <hamel/framework/loop/snapshot.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/framework/run/run/contacts/run_contacts.hpp>
#include <hamel/framework/schemes/dynamic_problem.hpp>

namespace hamel {

/// The element of a state: as its kernel kept it, or of its coordinates.
void load_element(const Geometry& geometry, const Snapshot& state, Eigen::VectorXd& out);

class Reactions {
 public:
  /// inputs: those of the run, null without.
  Reactions(std::shared_ptr<const Geometry> geometry, std::shared_ptr<const Mechanics> mechanics,
            std::shared_ptr<const Inputs> inputs, std::shared_ptr<RunContacts> contacts = nullptr);
  /// The contacts of the run, whose modes decide; null where no contact may slide or open.
  RunContacts* contacts() const { return contacts_.get(); }
  /// The multipliers lambda of A xi = b, k entries, by the equations of motion at an admissible
  /// state. They stay until the next state.
  const Eigen::VectorXd& at(const Snapshot& state);
  /// xi' there.
  const Eigen::VectorXd& acceleration(const Snapshot& state) {
    at(state);
    return contacts_ != nullptr ? contacts_->acceleration() : motion_.acceleration();
  }

 private:
  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Inputs> inputs_;
  std::shared_ptr<RunContacts> contacts_;
  EquationsOfMotion<DynamicProblem> motion_;
  // The last state, and the changes of the inputs up to there.
  double time_;
  Eigen::VectorXd g_, xi_;
  long changes_ = 0;
  Eigen::VectorXd other_;  // element of the next
  const Eigen::VectorXd* lambda_ = nullptr;
};

/// Null where a run has no rows, or a group that is not registered.
std::shared_ptr<Reactions> reactions_of(const std::shared_ptr<const Geometry>& geometry,
                                        const std::shared_ptr<const Mechanics>& mechanics,
                                        const std::shared_ptr<const Inputs>& inputs,
                                        const std::shared_ptr<RunContacts>& contacts = nullptr);

}  // namespace hamel
