#include <hamel/systems/mechanisms/multibody.hpp>

#include <algorithm>
#include <cstring>

namespace hamel::mechanisms {

Multibody::Multibody(Tree tree, Rows rows, Forces forces, std::shared_ptr<const Geometry> geometry)
    : tree_(std::move(tree)),
      rows_(std::move(rows)),
      forces_(std::move(forces)),
      geometry_(std::move(geometry)),
      placed_(tree_.drawn()),
      coordinates_(static_cast<size_t>(geometry_->columns())),
      work_(tree_.dim()) {
  std::vector<int> all(rows_.words().size());
  for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  keep(all);
}

void Multibody::keep(const std::vector<int>& rows) {
  const std::vector<RowWords> words = rows_.words();
  slots_.assign(words.size(), -1);
  kept_.clear();
  for (const bool holonomic : {false, true}) {
    for (const int row : rows) {
      if (words[static_cast<size_t>(row)].holonomic != holonomic) continue;
      slots_[static_cast<size_t>(row)] = static_cast<int>(kept_.size());
      kept_.push_back(row);
      holonomic_ = holonomic ? holonomic_ + 1 : 0;
    }
  }
}

void Multibody::drive(const std::vector<Driver>& drivers,
                      const std::shared_ptr<const Inputs>& inputs) {
  inputs_ = inputs;
  for (size_t i = 0; i < drivers.size(); ++i) {
    const auto at = [inputs, i](double t) { return inputs->at(t)[static_cast<Eigen::Index>(i)]; };
    if (!drivers[i].rate) {
      forces_.motors.push_back(
          {inputs->fields()[i].name, drivers[i].dof, [at](const Now& now) { return at(now.t); }});
      continue;
    }
    for (Prescribed& p : rows_.prescribed)
      if (p.dof == drivers[i].dof) p.rate = at;
  }
}

const Tree& Multibody::tree(const double* g) const {
  const size_t bytes = placed_.size() * sizeof(double);
  if (std::memcmp(placed_.data(), g, bytes) != 0) {
    std::memcpy(placed_.data(), g, bytes);
    tree_.place(g);
  }
  return tree_;
}

const Tree& Multibody::carrying(const double* g) const {
  tree(g);
  tree_.carry();
  return tree_;
}

void Multibody::inertia(const double* g, Matrix out) const {
  if (constant_inertia_) out = inertia_;
  else carrying(g).inertia(out);
}

void Multibody::write(const Row& row, Matrix a, int to) const {
  a.row(to).setZero();
  if (row.dof >= 0) {
    a(to, row.dof) = 1;
    return;
  }
  tree_.add_wrench(row.link, row.wrench, a.row(to));
  tree_.add_wrench(row.other, row.other_wrench, a.row(to), -1);
}

void Multibody::constraints(double t, const double* g, Matrix a, Vector b) const {
  size_t i = 0;
  rows_.each(tree(g), t, [&](const Row& row) {
    const int to = slots_[i++];
    if (to < 0) return;
    write(row, a, to);
    b[to] = row.drift;
  });
}

void Multibody::look(double t, const double* g, Matrix a, Vector b, Vector phi) const {
  int i = 0;
  rows_.each(tree(g), t, [&](const Row& row) {
    write(row, a, i);
    b[i] = row.drift;
    phi[i++] = row.phi;
  });
}

Vec3 Multibody::reaction(size_t contact, const double* g,
                         std::span<const double> multipliers) const {
  const std::string& part = rows_.contacts[contact].name;
  const std::vector<RowWords> words = rows_.words();
  Vec3 force = Vec3::Zero();
  size_t i = 0;
  rows_.each(tree(g), 0, [&](const Row& row) {
    const int at = slots_[i];
    if (words[i++].part == part && at >= 0 && row.dof < 0)
      force += multipliers[static_cast<size_t>(at)] *
               (tree_.root_in_world(row.link).rotation * lower(row.wrench));
  });
  return force;
}

void Multibody::holonomic(const double* g, Vector out) const {
  if (holonomic_ == 0) return;
  const int before = rows() - holonomic_;
  size_t i = 0;
  rows_.each(tree(g), 0, [&](const Row& row) {
    const int to = slots_[i++];
    if (to >= before) out[to - before] = row.phi;
  });
}

void Multibody::add_force(double t, const double* g, ConstVector xi, Vector out) const {
  Now now{t, {}, {xi.data(), static_cast<size_t>(xi.size())}, {}};
  InputValues u;
  if (forces_.has_signals()) {
    geometry_->coordinates(g, coordinates_.data());
    now.coordinates = coordinates_;
    if (inputs_ != nullptr) u = inputs_->at(t);
    now.inputs = {u.data(), static_cast<size_t>(u.size())};
  }
  forces_.add_force(tree_, now, out);
}

void Multibody::force(double t, const double* g, ConstVector xi, Vector out) const {
  out.setZero();
  if (constant_inertia_ && constant_potential_) tree(g);
  else carrying(g);
  const bool moves = !constant_inertia_ || forces_.any();
  if (moves) tree_.move(xi);
  if (!constant_potential_) forces_.add_potential_force(tree_, g, out);
  if (!constant_inertia_) tree_.add_inertial_force(out);
  if (forces_.any()) add_force(t, g, xi, out);
}

void Multibody::inertial_force(const double* g, ConstVector xi, Vector out) const {
  out.setZero();
  if (constant_inertia_) return;
  carrying(g);
  tree_.move(xi);
  tree_.add_inertial_force(out);
}

double Multibody::power(double t, const double* g, ConstVector xi) const {
  if (!forces_.any()) return 0;
  tree(g);
  tree_.move(xi);
  work_.setZero();
  add_force(t, g, xi, work_);
  return work_.dot(xi);
}

double Multibody::potential(const double* g) const { return forces_.potential(carrying(g), g); }

void Multibody::look_for_constants(const std::vector<std::vector<double>>& poses) {
  const int n = dim(), k = rows();
  Eigen::MatrixXd inertia(n, n), a(k, n), first_a(k, n);
  Eigen::VectorXd b(k), slope(n);
  bool same_inertia = true, same_rows = holonomic_ == 0 && !has_drift(), level = true;
  inertia_.resize(n, n);
  carrying(poses.front().data()).inertia(inertia_);
  constraints(0, poses.front().data(), first_a, b);
  for (const auto& pose : poses) {
    carrying(pose.data()).inertia(inertia);
    constraints(0, pose.data(), a, b);
    slope.setZero();
    forces_.add_potential_force(tree_, pose.data(), slope);
    const double size = inertia_.lpNorm<Eigen::Infinity>();
    same_inertia = same_inertia && (inertia - inertia_).lpNorm<Eigen::Infinity>() <= 1e-13 * size;
    if (k > 0) same_rows = same_rows && (a - first_a).lpNorm<Eigen::Infinity>() <= 1e-13;
    level = level && slope.lpNorm<Eigen::Infinity>() <= 1e-13 * size;
  }
  constant_inertia_ = same_inertia;
  constant_rows_ = same_rows;
  constant_potential_ = level;
}

}  // namespace hamel::mechanisms
