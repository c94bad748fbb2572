// A multibody system at one place: all its rows, what agreements and sensors are made of.
#include <hamel/systems/mechanisms/multibody.hpp>

#include <algorithm>

#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/systems/mechanisms/programs/agreement_formulas.hpp>
#include <hamel/systems/mechanisms/programs/sensor_formulas.hpp>

namespace hamel::mechanisms {

namespace {

// Onto row `to`, which is 0.
HAMEL_FLATTEN void write(const Row& row, const Tree& tree, Mechanics::Matrix& a, int to) {
  if (row.dof >= 0) {
    a(to, row.dof) = 1;
    return;
  }
  for (const auto& [dof, coefficient] : row.coefficients) a(to, dof) += coefficient;
  double* const out = a.data() + to;
  const Eigen::Index stride = a.outerStride();
  tree.each_effect(row.link, row.wrench, [&](int i, double effect) { out[i * stride] = effect; });
  if (row.other == kGround) return;
  tree.each_effect(row.other, -row.other_wrench,
                   [&](int i, double effect) { out[i * stride] += effect; });
}

}  // namespace

std::vector<int> Multibody::holding() const {
  std::vector<int> out = kept_;
  std::erase_if(out, [this](int row) { return row_info_[static_cast<size_t>(row)].slips; });
  return out;
}

void Multibody::look(double t, const double* g, Matrix a, Vector b, Vector phi) const {
  const Tree& at = tree(g);
  a.setZero();
  b.setZero();  // of agreements too
  rows_.each(at, t, [&](size_t i, const Row& row) {
    const auto to = static_cast<Eigen::Index>(i);
    write(row, at, a, static_cast<int>(i));
    b[to] = row.drift;
    phi[to] = row.phi;
  });
  if (!rows_.agreements.empty()) look_at_agreements(g, a, phi);
}

void Multibody::look_at_agreements(const double* g, Matrix a, Vector phi) const {
  if (!agreements_) agreements_.emplace(record_agreements(parts()));
  const auto count = static_cast<Eigen::Index>(rows_.agreements.size());
  const Eigen::Index first =
      phi.size() - count - static_cast<Eigen::Index>(rows_.prescribed.size());
  Eigen::VectorXd values(count * (1 + dim()));
  (*agreements_)(state(g), values.data());
  phi.segment(first, count) = values.head(count);
  a.middleRows(first, count) = values.tail(count * dim()).reshaped(dim(), count).transpose();
}

std::function<void(std::span<const double>, std::span<const double>, std::span<const double>,
                   std::span<double>)>
Multibody::sensor(int link, const Vec3& at) const {
  return
      [program = record_sensor(parts(), link, at), geometry = geometry_,
       state = std::vector<double>(state_.size() + static_cast<size_t>(dim())),
       first = tree_.size()](std::span<const double> coordinates, std::span<const double> velocity,
                             std::span<const double> acceleration, std::span<double> out) mutable {
        geometry->from_coordinates(coordinates, state.data());
        std::ranges::copy(velocity, state.begin() + first);
        std::ranges::copy(acceleration, state.end() - static_cast<std::ptrdiff_t>(velocity.size()));
        program(state.data(), out.data());
      };
}

std::vector<Agreement> Multibody::find_agreements(
    const std::vector<int>& rows, const std::vector<std::vector<double>>& poses) const {
  if (rows_.ground.height) return {};  // not on uneven ground
  Eigen::MatrixXd inertia(dim(), dim());
  this->inertia(poses.front().data(), inertia);
  std::vector<std::vector<double>> states = poses;
  for (std::vector<double>& state : states) {
    state.resize(state_.size(), 0.0);
    find_places(state);
  }
  const MechanismParts some{tree_, rows_, forces_, rows, 0, *geometry_};
  return mechanisms::find_agreements(some, states, velocity_units(inertia));
}

Vec3 Multibody::reaction(const std::string& part, const double* g,
                         std::span<const double> multipliers) const {
  const Tree& at = tree(g);
  Vec3 force = Vec3::Zero();
  rows_.each(at, 0, [&](size_t i, const Row& row) {
    const int slot = slots_[i];
    if (row_info_[i].part == part && slot >= 0 && row.dof < 0)
      force += multipliers[static_cast<size_t>(slot)] *
               (at.root_in_world(row.link).rotation * lower(row.wrench));
  });
  return force;
}

}  // namespace hamel::mechanisms
