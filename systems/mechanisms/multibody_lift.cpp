// The programs of lift of a tree of bodies (programs/lift_programs.hpp).
#include <hamel/systems/mechanisms/multibody.hpp>

#include <algorithm>

namespace hamel::mechanisms {

std::shared_ptr<const Multibody> Multibody::of(const std::shared_ptr<const Mechanics>& system) {
  return std::dynamic_pointer_cast<const Multibody>(system);
}

std::shared_ptr<const LiftLayout> Multibody::lift_layout() const {
  return has_lift_programs(parts(), driven_motors_) ? LiftLayout::of(parts()) : nullptr;
}

std::shared_ptr<const LiftPrograms> Multibody::lift_programs() const {
  if (first_lift_ == nullptr)
    first_lift_ = lift_programs(tree_.drawn().data(), Eigen::VectorXd::Zero(dim()), 0);
  return first_lift_;
}

std::shared_ptr<const LiftPrograms> Multibody::lift_programs(const double* g, ConstVector xi,
                                                             size_t unknowns) const {
  auto layout = lift_layout();
  if (layout == nullptr) return nullptr;
  std::vector<double> there(state_.size());
  std::copy_n(g, tree_.size(), there.data());
  std::copy_n(xi.data(), dim(), there.data() + tree_.size());
  return LiftPrograms::record(parts(), std::move(layout), there, unknowns);
}

}  // namespace hamel::mechanisms
