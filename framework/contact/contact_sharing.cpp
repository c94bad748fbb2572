// The rows that are on and their reactions, where rows may depend on each other.
#include <algorithm>
#include <cmath>

#include <hamel/framework/contact/contact_dynamics.hpp>
#include <hamel/framework/lie/linear_solve.hpp>

namespace hamel {
namespace {

// Compliance of contacts beside the largest diagonal entry, at the end.
constexpr double kGivesWay = 1e-9;
// What is left of a row beside others, relative to it, that is round-off.
constexpr double kDependent = 1e-9;

}  // namespace

std::vector<int> ContactDynamics::rows(const ContactStates& states) const {
  std::vector<int> out = always_;
  for (int i = 0; i < count(); ++i) {
    const ContactMode mode = states[static_cast<size_t>(i)].mode;
    if (mode != ContactMode::open && law(i).normal) out.push_back(*law(i).normal);
    if (mode != ContactMode::rolls) continue;
    out.insert(out.end(), law(i).tangential.begin(), law(i).tangential.end());
  }
  std::sort(out.begin(), out.end());
  const size_t wanted = out.size();
  std::vector<int> kept;
  Eigen::MatrixXd basis(a_.cols(), static_cast<Eigen::Index>(wanted));
  const auto add = [&](int row) {
    const auto at = static_cast<Eigen::Index>(kept.size());
    Eigen::VectorXd rest = a_.row(row).transpose();
    const double length = rest.norm();
    for (int pass = 1; pass <= 2; ++pass)
      for (Eigen::Index j = 0; j < at; ++j) rest -= basis.col(j).dot(rest) * basis.col(j);
    if (!(rest.norm() > kDependent * length)) return;
    basis.col(at) = rest.normalized();
    kept.push_back(row);
  };
  for (const int row : always_) add(row);
  for (const int row : out)
    if (std::ranges::count(always_, row) == 0) add(row);
  std::sort(kept.begin(), kept.end());
  return kept;
}

void ContactDynamics::solve_rows(int m) {
  const int rank = pivots_.eliminate(k_map(m), multipliers_.head(m));
  if (rank < m) share(m, rank);
}

// l + Z y with K Z = 0, so that contacts give way by l/share each and what gives way is a motion of
// the bodies, in the range of R: z^T D l = 0 for all z with z^T R = 0, D = 1/share, of given loads
// 1/(mu load)^2: Z_l^T D Z y = -Z_l^T D l. Where K is symmetric that is the least sum of D l^2.
void ContactDynamics::share(int m, int rank) {
  const int open = m - rank;
  pivots_.find_null(k_map(m), rank, null_);
  left_null_ = null_;
  const auto has_normal = [this](const Row& row) { return law(row.contact).has_normal(); };
  if (std::ranges::any_of(on_, has_normal)) {  // else K is symmetric
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j)
        k_work_.data()[i + j * m] =
            row_times(on_[static_cast<size_t>(j)].row, responses_.col(i));  // K^T
    right_.col(0).head(m).setZero();
    if (pivots_.eliminate(k_map(m), right_.col(0).head(m)) == rank)
      pivots_.find_null(k_map(m), rank, left_null_);
  }
  Eigen::Map<Eigen::MatrixXd> equations(normal_equations_.data(), open, open);
  equations.setZero();
  work_m_.setZero();
  for (int pivot = 0; pivot < m; ++pivot) {
    const int i = pivots_.of(pivot);
    const ContactLaw& law = this->law(on_[static_cast<size_t>(i)].contact);
    const double bound = law.normal ? std::sqrt(law.share) : law.friction * law.load;
    const double weight = bound > 0 ? 1 / (bound * bound) : 1;
    for (int c = 0; c < open; ++c) {
      work_m_[c] -= weight * left_null_(i, c) * multipliers_[i];
      for (int d = 0; d < open; ++d) equations(c, d) += weight * left_null_(i, c) * null_(i, d);
    }
  }
  solve_linear(equations.data(), work_m_.data(), open, 1);
  for (int i = 0; i < m; ++i)
    for (int c = 0; c < open; ++c) multipliers_[i] += work_m_[c] * null_(i, c);
}

void ContactDynamics::give_way_by(double compliance, int m) {
  const double size = right_.col(0).head(m).maxCoeff();
  for (int i = 0; i < m; ++i) {
    const ContactLaw& law = this->law(on_[static_cast<size_t>(i)].contact);
    if (law.normal) k_(i, i) = right_(i, 0) + compliance * size / law.share;
  }
}

// Contacts that give way, where rows depend on each other, ever less; what the last do rigid ones
// do, whose impulses are the nearest to theirs.
ContactProblem::Outcome ContactDynamics::give_way(int m, bool near) {
  const auto g = k_.topLeftCorner(m, m);
  const auto c = c_.head(m);
  right_.col(0).head(m) = k_.diagonal().head(m);
  give_way_by(kGivesWay, m);
  ContactProblem::Outcome out = ContactProblem::Outcome::one;
  if (!near || !problem().refine(g, c, blocks_)) {
    for (double compliance = 1; compliance > kGivesWay; compliance /= 10) {
      give_way_by(compliance, m);
      out = compliance < 1 ? problem().solve_next(g, c, blocks_) : problem().solve(g, c, blocks_);
      if (out != ContactProblem::Outcome::one) return out;
    }
  }
  k_.diagonal().head(m) = right_.col(0).head(m);
  problem().refine(g, c, blocks_);
  return out;
}

}  // namespace hamel
