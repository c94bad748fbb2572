#include <hamel/systems/mechanisms/multibody.hpp>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <hamel/systems/mechanisms/programs/force_formulas.hpp>

namespace hamel::mechanisms {

Multibody::Multibody(const Tree& tree, ConstraintRows rows, Forces forces,
                     std::shared_ptr<const Geometry> geometry)
    : tree_(tree),
      rows_(std::move(rows)),
      row_info_(rows_.info()),
      forces_(std::move(forces)),
      geometry_(std::move(geometry)),
      coordinates_(static_cast<size_t>(geometry_->columns())),
      work_(2 * tree.dim() + static_cast<Eigen::Index>(row_info_.size())) {
  rows_.find_links(tree);
  std::vector<int> all(row_info_.size());
  for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  keep(all);
}

void Multibody::keep(const std::vector<int>& rows) {
  slots_.assign(row_info_.size(), -1);
  kept_.clear();
  holonomic_ = 0;
  for (const bool holonomic : {false, true}) {
    for (const int row : rows) {
      if (row_info_[static_cast<size_t>(row)].holonomic != holonomic) continue;
      slots_[static_cast<size_t>(row)] = static_cast<int>(kept_.size());
      kept_.push_back(row);
      if (holonomic) ++holonomic_;
    }
  }
  forget_programs();
}

void Multibody::drive(const std::vector<Driver>& drivers,
                      const std::shared_ptr<const Inputs>& inputs) {
  inputs_ = inputs;
  drivers_ = drivers;
  driven_motors_ = 0;
  for (size_t i = 0; i < drivers.size(); ++i) {
    const auto at = [inputs, i](double t) { return inputs->at(t)[static_cast<Eigen::Index>(i)]; };
    if (!drivers[i].rate) {
      ++driven_motors_;
      forces_.motors.push_back({inputs->fields()[i].name, drivers[i].dof,
                                [at](const SignalInput& now) { return at(now.t); }, false});
      continue;
    }
    for (Prescribed& p : rows_.prescribed)
      if (p.dof == drivers[i].dof) {
        p.rate = at;
        p.slope = [inputs, i](double t) {
          return inputs->slopes_at(t)[static_cast<Eigen::Index>(i)];
        };
      }
  }
  forget_programs();
}

bool Multibody::autonomous() const {
  if (inputs_ != nullptr && std::ranges::any_of(inputs_->tables(), [](const InputTable& table) {
        return !table.times.empty();
      }))
    return false;
  return !forces_.time_dependent() &&
         std::ranges::none_of(rows_.prescribed,
                              [](const Prescribed& p) { return p.time_dependent; });
}

// ---- programs -----------------------------------------------------------------------------------

void Multibody::forget_programs() {
  programs_.reset();
  rates_.reset();
  agreements_.reset();
  first_motion_.reset();
  motion_.reset();
  recorded_motion_ = false;
  first_lift_.reset();
  state_.assign(parts().state_size(), 0.0);
}

MechanismPrograms& Multibody::programs() const {
  if (!programs_) programs_.emplace(parts());
  return *programs_;
}

// Feet of contacts and coordinates of couplings.
void Multibody::find_places(std::span<double> state) const {
  if (!rows_.coupled_links.empty()) parts().find_coupled(state);
  if (!rows_.ground.height) return;
  tree_.place(state.data());
  parts().find_feet(state);
}

const double* Multibody::state(const double* g) const {
  std::copy_n(g, tree_.size(), state_.data());
  find_places(state_);
  return state_.data();
}

const double* Multibody::state(const double* g, ConstVector xi) const {
  state(g);
  std::copy_n(xi.data(), dim(), state_.data() + tree_.size());
  return state_.data();
}

const double* Multibody::state(double t, const double* g, ConstVector xi) const {
  state(g, xi);
  take_signals(t);
  take_rates(t);
  return state_.data();
}

// Reads the element and the velocity that are there.
void Multibody::take_signals(double t) const {
  const size_t signals = count_signals(forces_);
  if (signals == 0) return;
  const double* const g = state_.data();
  const auto first = static_cast<size_t>(tree_.size()), n = static_cast<size_t>(dim());
  SignalInput now{t, {}, {state_.data() + first, n}, {}};
  InputValues u;
  if (forces_.has_signals()) {
    geometry_->coordinates(g, coordinates_.data());
    now.coordinates = coordinates_;
    if (inputs_ != nullptr) u = inputs_->at(t);
    now.inputs = {u.data(), static_cast<size_t>(u.size())};
  }
  find_signals(forces_, tree_, g, now, state_.data() + first + n);
}

void Multibody::take_rates(double t) const {
  double* out = state_.data() + state_.size() - 3 * rows_.prescribed.size();
  for (const Prescribed& p : rows_.prescribed) *out++ = p.rate(t);
  for (const Prescribed& p : rows_.prescribed) *out++ = ConstraintRows::slope(p, t);
}

// ---- Mechanics ----------------------------------------------------------------------------------

void Multibody::inertia(const double* g, Matrix out) const {
  if (constant_inertia_) {
    out = inertia_;
    return;
  }
  const auto n = static_cast<size_t>(dim()), stride = static_cast<size_t>(out.outerStride());
  programs().inertia(state(g), out.data(), [&](size_t i) { return i % n + i / n * stride; });
}

void Multibody::momentum(const double* g, ConstVector xi, Vector out, Vector inertial_force) const {
  programs().momentum(state(g, xi), work_.data());
  out = work_.head(dim());
  inertial_force = work_.segment(dim(), dim());
}

void Multibody::constraints(double t, const double* g, Matrix a, Vector b) const {
  if (constant_rows_) {
    a = fixed_rows_;
    b.setZero();
    return;
  }
  const auto k = static_cast<size_t>(constraint_count());
  const auto stride = static_cast<size_t>(a.outerStride());
  state(g);
  take_rates(t);
  programs().rows(state_.data(), a.data(), [&](size_t i) { return i % k + i / k * stride; });
  programs().drift(state_.data(), b.data());
}

void Multibody::constraint_values(double t, const double* g, ConstVector xi, Vector out) const {
  state(g, xi);
  take_rates(t);
  programs().row_values(state_.data(), out.data());
}

void Multibody::motion(const Geometry& /*geometry*/, double t, const double* g, ConstVector xi,
                       Matrix inertia, Matrix a, Vector b, Vector rows, Vector change) const {
  if (!constant_inertia_) this->inertia(g, inertia);
  if (!constant_rows_) constraints(t, g, a, b);
  if (!rates_) rates_.emplace(record_rates(parts()));
  (*rates_)(state(t, g, xi), work_.data());
  rows = work_.head(constraint_count());
  change = work_.segment(constraint_count(), dim());
}

void Multibody::holonomic(const double* g, Vector out) const {
  if (holonomic_ == 0) return;
  double* gap = state_.data() + state_.size() - rows_.prescribed.size();
  for (const Prescribed& p : rows_.prescribed)
    *gap++ =
        p.held >= 0 ? ConstraintRows::beyond(p, tree_.joint(p.held), g + tree_.element(p.held)) : 0;
  state(g);
  if (!rows_.couplings.empty()) parts().find_closures(state_);
  programs().holonomic(state_.data(), out.data());
}

void Multibody::force(double t, const double* g, ConstVector xi, Vector out) const {
  applied_force(t, g, xi, out);
  if (constant_inertia_) return;
  programs().inertial_force(state_.data(), work_.data());
  out += work_.head(dim());
}

void Multibody::inertial_force(const double* g, ConstVector xi, Vector out) const {
  if (constant_inertia_) out.setZero();
  else programs().inertial_force(state(g, xi), out.data());
}

void Multibody::applied_force(double t, const double* g, ConstVector xi, Vector out) const {
  state(g, xi);
  take_signals(t);
  programs().applied_force(state_.data(), out.data());
}

double Multibody::power(double t, const double* g, ConstVector xi) const {
  if (!forces_.any()) return 0;
  state(g, xi);
  take_signals(t);
  programs().given_force(state_.data(), work_.data());
  return work_.head(dim()).dot(xi);
}

double Multibody::potential(const double* g) const {
  double out = 0;
  state(g);
  find_coordinates(forces_, tree_, g, state_.data() + tree_.size() + dim());
  programs().potential(state_.data(), &out);
  return out;
}

bool Multibody::has_accelerations() const {
  return dim() - constraint_count() <= MotionProgram::kMostIndependent;
}

void Multibody::begin() const { motion_ = first_motion_; }

std::optional<MotionProgram> Multibody::record(std::span<const double> state) const {
  try {
    return MotionProgram(parts(), state);
  } catch (const std::domain_error&) {
    return std::nullopt;
  }
}

void Multibody::accelerations(double t, const double* g, ConstVector xi, Vector out) const {
  state(t, g, xi);
  if (!recorded_motion_) {
    std::vector<double> drawn = tree_.drawn();
    drawn.resize(state_.size(), 0.0);
    find_places(drawn);
    motion_ = first_motion_ = record(drawn);
    recorded_motion_ = true;
  }
  if (motion_ && (*motion_)(state_.data(), out.data())) return;
  motion_ = record(state_);
  if (motion_ && (*motion_)(state_.data(), out.data())) return;
  out.setConstant(std::numeric_limits<double>::quiet_NaN());  // the rows depend on each other
}

void Multibody::find_constants(const std::vector<std::vector<double>>& poses) {
  const int n = dim(), k = constraint_count();
  Eigen::MatrixXd inertia(n, n), a(k, n), first_a(k, n);
  Eigen::VectorXd b(k), weight(n);
  // (A stiffness is there to act: only weight is looked at.)
  bool same_inertia = true, same_rows = !has_drift() && holonomic_ == 0;
  bool level = std::ranges::all_of(forces_.springs,
                                   [](const Spring& spring) { return spring.stiffness == 0; });
  constant_inertia_ = constant_rows_ = false;
  Eigen::MatrixXd first(n, n);
  this->inertia(poses.front().data(), first);
  // Round-off of each velocity is that of what it moves: a needle on a ship has its own.
  const Eigen::VectorXd own = first.diagonal().cwiseMax(0).cwiseSqrt();
  const double near = 1e-13, heaviest = forces_.gravity.norm() * own.maxCoeff();
  constraints(0, poses.front().data(), first_a, b);
  for (const auto& pose : poses) {
    this->inertia(pose.data(), inertia);
    constraints(0, pose.data(), a, b);
    programs().weight(state(pose.data()), weight.data());
    same_inertia =
        same_inertia &&
        ((inertia - first).array().abs() <= near * (own * own.transpose()).array()).all();
    same_rows = same_rows && (a - first_a).lpNorm<Eigen::Infinity>() <= near;
    level = level && (weight.array().abs() <= near * heaviest * own.array()).all();
  }
  constant_inertia_ = same_inertia;
  constant_potential_ = level;
  constant_rows_ = same_rows;
  inertia_ = first;
  fixed_rows_ = first_a;
}

}  // namespace hamel::mechanisms
