// The start of a member: coordinates and rotations that are varied, velocities with components
// given, velocities on an energy surface.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <hamel/framework/ensemble/member.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel::ensemble {
namespace {

using Kind = Target::Kind;

// A rotation uniform on SO(3), row by row, from a quaternion (Shoemake 1992).
void draw_rotation(Draws& random, std::span<double> r) {
  const double u = random.uniform(), a = 2 * std::numbers::pi * random.uniform(),
               b = 2 * std::numbers::pi * random.uniform();
  const double x = std::sqrt(1 - u) * std::sin(a), y = std::sqrt(1 - u) * std::cos(a),
               z = std::sqrt(u) * std::sin(b), w = std::sqrt(u) * std::cos(b);
  const double out[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                         2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                         2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
  std::copy(std::begin(out), std::end(out), r.begin());
}

}  // namespace

// I, A and b there.
void MemberRunner::matrices(const Start& start) const {
  const Mechanics& mechanics = *run_->system().mechanics;
  const Eigen::Index n = mechanics.dim(), k = mechanics.constraint_count();
  g_.resize(plan_.geometry->size());
  plan_.geometry->from_coordinates(start.configuration, g_.data());
  inertia_.resize(n, n);
  rows_.resize(k, n);
  drift_.setZero(k);
  mechanics.inertia(g_.data(), inertia_);
  mechanics.constraints(plan_.base.from, g_.data(), rows_, drift_);
}

Start MemberRunner::start_of(long member, Start start) {
  const Variations& variations = *plan_.variations;
  const std::vector<Target>& targets = variations.targets();
  for (size_t i = 0; i < targets.size(); ++i) {
    if (targets[i].kind == Kind::coordinate)
      start.configuration[targets[i].index] = variations.number(i, member);
    if (targets[i].kind == Kind::rotation) {
      Draws random = variations.draws(i, member);
      for (const size_t first : rotations_of(run_->system().group))
        draw_rotation(random, std::span(start.configuration).subspan(first, 9));
    }
    if (targets[i].kind != Kind::moved) continue;
    Draws random = variations.draws(i, member);
    const std::vector<double>& sigma = variations.all()[i].numbers;
    Eigen::VectorXd xi(run_->system().group.dim), turn(plan_.geometry->size());
    for (Eigen::Index j = 0; j < xi.size(); ++j)
      xi[j] = sigma[sigma.size() == 1 ? 0 : static_cast<size_t>(j)] * random.normal();
    g_.resize(turn.size());
    plan_.geometry->from_coordinates(start.configuration, g_.data());
    plan_.geometry->tau(xi.data(), turn.data());
    plan_.geometry->compose(g_.data(), turn.data(), g_.data());
    plan_.geometry->coordinates(g_.data(), start.configuration.data());
  }
  if (!given_.empty()) give_components(member, start);
  if (variations.any(Kind::energy)) put_on_energy(member, start);
  return start;
}

// From all xi with A xi = b and these components takes the one next to the start's in the metric I:
//   xi = xi0 + I^-1 C^T (C I^-1 C^T)^-1 (d - C xi0),  C = (A; e_j), d = (b; values).
GivenComponents MemberRunner::given_components(const Start& start) const {
  matrices(start);
  const Eigen::Index n = inertia_.rows(), k = rows_.rows(),
                     c = static_cast<Eigen::Index>(given_.size());
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(k + c, n),
                  right = Eigen::MatrixXd::Zero(k + c, c + 1);
  stacked.topRows(k) = rows_;
  right.col(0).head(k) = drift_;
  for (Eigen::Index j = 0; j < c; ++j) {
    const Target& target = plan_.variations->targets()[given_[static_cast<size_t>(j)]];
    stacked(k + j, static_cast<Eigen::Index>(target.index)) = 1;
    right(k + j, j + 1) = 1;
  }
  const Eigen::Map<const Eigen::VectorXd> velocity(start.velocity.data(), n);
  right.col(0) -= stacked * velocity;
  const Eigen::MatrixXd reach = dense::solve_symmetric(inertia_, stacked.transpose());
  const Eigen::MatrixXd moved = reach * dense::solve_symmetric(stacked * reach, right);
  const double off = (stacked * moved - right).cwiseAbs().maxCoeff();
  if (!(off < 1e-9 * (1 + right.cwiseAbs().maxCoeff()))) {
    std::vector<std::string> names;
    for (const size_t i : given_) names.push_back(plan_.variations->all()[i].name);
    throw ConfigError(
        {fmt::format("vary: {}: the constraint rows of {} leave no choice of {}", join(names),
                     run_->system().name, names.size() == 1 ? "it" : "them")});
  }
  return {velocity + moved.col(0), moved.rightCols(c)};
}

void MemberRunner::give_components(long member, Start& start) {
  const Mechanics& mechanics = *run_->system().mechanics;
  const Variations& variations = *plan_.variations;
  const bool same = mechanics.left_invariant() ||
                    (start.configuration == common_.configuration && !mechanics.has_drift());
  if (!components_ || !same) components_ = given_components(start);
  Eigen::VectorXd xi = components_->offset;
  for (size_t j = 0; j < given_.size(); ++j)
    xi +=
        components_->gain.col(static_cast<Eigen::Index>(j)) * variations.number(given_[j], member);
  start.velocity.assign(xi.begin(), xi.end());
}

// xi = E u sqrt(2 (energy - V)), E^T I E = Id, u uniform on the unit sphere.
void MemberRunner::put_on_energy(long member, Start& start) {
  matrices(start);
  const Variations& variations = *plan_.variations;
  const auto& targets = variations.targets();
  const auto i = static_cast<size_t>(std::ranges::find(targets, Kind::energy, &Target::kind) -
                                     targets.begin());
  const double energy = variations.all()[i].numbers[0],
               potential = run_->system().mechanics->potential(g_.data());
  if (energy < potential)
    throw ConfigError({fmt::format("start.velocity: the energy {} is below the potential, {:.6g}",
                                   energy, potential)});
  const Eigen::MatrixXd frame = hamel_frame(inertia_, rows_);
  Draws random = variations.draws(i, member);
  Eigen::VectorXd u(frame.cols());
  for (double& x : u) x = random.normal();
  const Eigen::VectorXd xi = frame * u * (std::sqrt(2 * (energy - potential)) / u.norm());
  start.velocity.assign(xi.begin(), xi.end());
}

}  // namespace hamel::ensemble
