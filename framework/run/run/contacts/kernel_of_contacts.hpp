// The parts that kernels of runs with contacts share: where they are, and how they begin anew. Not
// installed.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/run/run/contacts/run_contacts.hpp>

namespace hamel {

class KernelOfContacts : public Kernel {
 public:
  KernelOfContacts(SmoothKernels smooth, KernelSetup setup, std::shared_ptr<RunContacts> contacts)
      : smooth_(std::move(smooth)),
        setup_(std::move(setup)),
        contacts_(std::move(contacts)),
        time_(setup_.from),
        limit_(std::copysign(std::numeric_limits<double>::infinity(), setup_.step)),
        coordinates_(setup_.configuration),
        velocity_(setup_.velocity),
        g_(setup_.geometry->size()) {}
  void restart(double t, std::span<const double> coordinates, std::span<const double> velocity,
               double step) final;
  void turn_back() final;

 protected:
  // From time_, coordinates_ and velocity_: in the modes that are known, else in those of the
  // state.
  virtual void begin() = 0;
  // The state into g_, xi_ and dynamics().
  void evaluate_start();
  ContactDynamics& dynamics() const { return *contacts_->dynamics(); }
  int count() const { return dynamics().count(); }

  SmoothKernels smooth_;
  KernelSetup setup_;
  std::shared_ptr<RunContacts> contacts_;
  double time_, limit_;
  std::vector<double> coordinates_, velocity_;
  Eigen::VectorXd g_, xi_;
};

/// Kernels K of a run from those of its pieces. contacts: those of the run; null: a kernel
/// for itself, as dense output and measurements need one.
template <class K>
KernelFactory kernels_with_contacts(SmoothKernels smooth, std::shared_ptr<const Geometry> geometry,
                                    const SystemModel& system,
                                    std::shared_ptr<RunContacts> contacts) {
  auto model = std::make_shared<SystemModel>(system);
  return [smooth = std::move(smooth), geometry = std::move(geometry), model = std::move(model),
          contacts = std::move(contacts)](const KernelSetup& setup) -> std::unique_ptr<Kernel> {
    auto own = contacts != nullptr ? contacts : std::make_shared<RunContacts>(geometry, *model);
    own->drive(setup.inputs);
    return std::make_unique<K>(smooth, setup, std::move(own));
  };
}

}  // namespace hamel
