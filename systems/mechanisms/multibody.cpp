#include <hamel/systems/mechanisms/multibody.hpp>

#include <algorithm>
#include <cstring>

namespace hamel::mechanisms {

Multibody::Multibody(const Tree& tree, ConstraintRows rows, Forces forces,
                     std::shared_ptr<const Geometry> geometry)
    : trees_{tree, tree},
      rows_(std::move(rows)),
      row_info_(rows_.info()),
      forces_(std::move(forces)),
      geometry_(std::move(geometry)),
      coordinates_(static_cast<size_t>(geometry_->columns())),
      work_(tree.dim()) {
  rows_.find_fixed(tree);
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
  varies_.assign(row_info_.size(), 0);
  for (const int row : kept_) varies_[static_cast<size_t>(row)] = 1;
  fixed_rows_ = Eigen::MatrixXd::Zero(this->constraint_count(), dim());
}

void Multibody::drive(const std::vector<Driver>& drivers,
                      const std::shared_ptr<const Inputs>& inputs) {
  inputs_ = inputs;
  for (size_t i = 0; i < drivers.size(); ++i) {
    const auto at = [inputs, i](double t) { return inputs->at(t)[static_cast<Eigen::Index>(i)]; };
    if (!drivers[i].rate) {
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

Tree& Multibody::placed(const double* g) const {
  if (trees_[last_].placed_at(g)) return trees_[last_];
  last_ = 1 - last_;
  trees_[last_].place(g);
  return trees_[last_];
}

Tree& Multibody::turned(const double* g) const {
  Tree& tree = placed(g);
  tree.turn_inertia();
  return tree;
}

Tree& Multibody::carrying(const double* g) const {
  Tree& tree = placed(g);
  tree.accumulate_inertia();
  return tree;
}

void Multibody::inertia(const double* g, Matrix out) const {
  if (constant_inertia_) out = inertia_;
  else carrying(g).inertia(out);
}

void Multibody::momentum(const double* g, ConstVector xi, Vector out, Vector inertial_force) const {
  Tree& at = turned(g);
  at.move(xi);
  at.momentum(out, inertial_force);
}

namespace {

// Onto row `to`, which is 0.
HAMEL_FLATTEN void write(const Row& row, const Tree& tree, Mechanics::Matrix& a, int to) {
  if (row.dof >= 0) {
    a(to, row.dof) = 1;
    return;
  }
  double* const out = a.data() + to;
  const Eigen::Index stride = a.outerStride();
  tree.each_effect(row.link, row.wrench, [&](int i, double effect) { out[i * stride] = effect; });
  if (row.other == kGround) return;
  tree.each_effect(row.other, -row.other_wrench,
                   [&](int i, double effect) { out[i * stride] += effect; });
}

}  // namespace

// Rows that vary, of a tree that was placed; with rates one that moved and accelerated.
template <bool with_rates>
void Multibody::find_rows(const Tree& tree, double t, Matrix a, Vector b, double* rates) const {
  if (a.outerStride() == a.rows()) std::copy_n(fixed_rows_.data(), fixed_rows_.size(), a.data());
  else a = fixed_rows_;
  b.setZero();
  rows_.each<with_rates>(
      tree, t, [&](size_t i) { return varies_[i] != 0; },
      [&](size_t i, const Row& row) {
        write(row, tree, a, slots_[i]);
        b[slots_[i]] = row.drift;
        if constexpr (with_rates) rates[slots_[i]] = row.rate;
      });
}

void Multibody::constraints(double t, const double* g, Matrix a, Vector b) const {
  if (constant_rows_) {
    a = fixed_rows_;
    b.setZero();
  } else {
    find_rows<false>(placed(g), t, a, b, nullptr);
  }
}

void Multibody::constraint_values(double t, const double* g, ConstVector xi, Vector out) const {
  for (int i = 0; i < constraint_count(); ++i) {
    if (varies_[static_cast<size_t>(kept_[static_cast<size_t>(i)])] == 0)
      out[i] = fixed_rows_.row(i).dot(xi);
  }
  if (constant_rows_) return;
  Tree& at = placed(g);
  at.move(xi);
  rows_.each_velocity(
      at, t, xi.data(), [&](size_t i) { return varies_[i] != 0; },
      [&](size_t i, double value) { out[slots_[i]] = value; });
}

void Multibody::motion(const Geometry& /*geometry*/, double t, const double* g, ConstVector xi,
                       Matrix inertia, Matrix a, Vector b, Vector rows, Vector change) const {
  const bool moves = !constant_rows_ || !constant_inertia_ || forces_.any();
  Tree& at = constant_inertia_ && constant_potential_ ? placed(g) : carrying(g);
  if (moves) at.move(xi);
  if (!constant_rows_ || !constant_inertia_) at.accelerate();
  rows.setZero();
  if (!constant_rows_) find_rows<true>(at, t, a, b, rows.data());
  if (!constant_inertia_) {
    at.inertia(inertia);
    at.bias(forces_.gravity, change);
    if (!constant_potential_) forces_.add_spring_force(at, g, change);
  } else {
    work_ = inertia_.lazyProduct(xi);
    geometry_->ad_transpose(xi.data(), work_.data(), change.data());
    if (!constant_potential_) forces_.add_potential_force(at, g, change);
  }
  if (forces_.any()) add_force(at, t, g, xi, change);
}

void Multibody::look(double t, const double* g, Matrix a, Vector b, Vector phi) const {
  const Tree& at = placed(g);
  a.setZero();
  rows_.each(at, t, [&](size_t i, const Row& row) {
    const auto to = static_cast<Eigen::Index>(i);
    write(row, at, a, static_cast<int>(i));
    b[to] = row.drift;
    phi[to] = row.phi;
  });
}

Vec3 Multibody::reaction(size_t contact, const double* g,
                         std::span<const double> multipliers) const {
  const std::string& part = rows_.contacts[contact].name;
  const Tree& at = placed(g);
  Vec3 force = Vec3::Zero();
  rows_.each(at, 0, [&](size_t i, const Row& row) {
    const int slot = slots_[i];
    if (row_info_[i].part == part && slot >= 0 && row.dof < 0)
      force += multipliers[static_cast<size_t>(slot)] *
               (at.root_in_world(row.link).rotation * lower(row.wrench));
  });
  return force;
}

void Multibody::holonomic(const double* g, Vector out) const {
  if (holonomic_ == 0) return;
  const int before = constraint_count() - holonomic_;
  rows_.each_holonomic(
      placed(g), [&](size_t i) { return slots_[i] >= before; },
      [&](size_t i, double phi) { out[slots_[i] - before] = phi; });
}

void Multibody::add_force(const Tree& tree, double t, const double* g, ConstVector xi,
                          Vector out) const {
  SignalInput now{t, {}, {xi.data(), static_cast<size_t>(xi.size())}, {}};
  InputValues u;
  if (forces_.has_signals()) {
    geometry_->coordinates(g, coordinates_.data());
    now.coordinates = coordinates_;
    if (inputs_ != nullptr) u = inputs_->at(t);
    now.inputs = {u.data(), static_cast<size_t>(u.size())};
  }
  forces_.add_force(tree, now, out);
}

void Multibody::force(double t, const double* g, ConstVector xi, Vector out) const {
  inertial_force(g, xi, out);
  add_applied_force(t, g, xi, out);
}

void Multibody::applied_force(double t, const double* g, ConstVector xi, Vector out) const {
  out.setZero();
  add_applied_force(t, g, xi, out);
}

void Multibody::add_applied_force(double t, const double* g, ConstVector xi, Vector out) const {
  if (!constant_potential_) forces_.add_potential_force(carrying(g), g, out);
  if (!forces_.any()) return;
  Tree& at = placed(g);
  at.move(xi);
  add_force(at, t, g, xi, out);
}

void Multibody::inertial_force(const double* g, ConstVector xi, Vector out) const {
  if (constant_inertia_) {
    out.setZero();
    return;
  }
  Tree& at = turned(g);
  at.move(xi);
  at.momentum(work_, out);
}

double Multibody::power(double t, const double* g, ConstVector xi) const {
  if (!forces_.any()) return 0;
  Tree& at = placed(g);
  at.move(xi);
  work_.setZero();
  add_force(at, t, g, xi, work_);
  return work_.dot(xi);
}

double Multibody::potential(const double* g) const { return forces_.potential(carrying(g), g); }

void Multibody::find_constants(const std::vector<std::vector<double>>& poses) {
  const int n = dim(), k = constraint_count();
  Eigen::MatrixXd inertia(n, n), a(k, n), first_a(k, n);
  Eigen::VectorXd b(k), slope(n);
  // (A stiffness is there to act: only weight is looked at.)
  bool same_inertia = true, level = std::ranges::all_of(forces_.springs, [](const Spring&spring) {
                              return spring.stiffness == 0;
                            });
  std::vector<bool> same_row(static_cast<size_t>(k), !rows_.ground.moves());
  inertia_.resize(n, n);
  carrying(poses.front().data()).inertia(inertia_);
  // Round-off of each velocity is that of what it moves: a needle on a ship has its own.
  const Eigen::VectorXd own = inertia_.diagonal().cwiseMax(0).cwiseSqrt();
  const double near = 1e-13, weight = forces_.gravity.norm() * own.maxCoeff();
  constraints(0, poses.front().data(), first_a, b);
  for (const auto& pose : poses) {
    const Tree& at = carrying(pose.data());
    at.inertia(inertia);
    constraints(0, pose.data(), a, b);
    slope.setZero();
    forces_.add_potential_force(at, pose.data(), slope);
    same_inertia =
        same_inertia &&
        ((inertia - inertia_).array().abs() <= near * (own * own.transpose()).array()).all();
    for (int i = 0; i < k; ++i) {
      if (!((a.row(i) - first_a.row(i)).lpNorm<Eigen::Infinity>() <= near))
        same_row[static_cast<size_t>(i)] = false;
    }
    level = level && (slope.array().abs() <= near * weight * own.array()).all();
  }
  constant_inertia_ = same_inertia;
  constant_potential_ = level;
  constant_rows_ = holonomic_ == 0;
  const size_t prescribed =
      varies_.size() - rows_.prescribed.size();  // a rate of time from here on
  for (size_t i = 0; i < varies_.size(); ++i) {
    if (varies_[i] == 0) continue;
    const int row = slots_[i];
    if (i < prescribed && same_row[static_cast<size_t>(row)]) {
      varies_[i] = 0;
      fixed_rows_.row(row) = first_a.row(row);
    } else {
      constant_rows_ = false;
    }
  }
}

}  // namespace hamel::mechanisms
