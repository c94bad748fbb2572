// The rows that are on and their reactions, where rows may depend on each other.
#include <algorithm>
#include <cmath>
#include <limits>

#include <hamel/framework/contact/contact_dynamics.hpp>
#include <hamel/framework/lie/linear_solve.hpp>

namespace hamel {
namespace {

// Compliance of contacts beside the largest diagonal entry, at the end.
constexpr double kGivesWay = 1e-9;
// What is left of a row beside others, relative to it, that is round-off.
constexpr double kDependent = 1e-9;
// Reactions this near to the rims of their cones, relative to these, are on them at once.
constexpr double kOnRim = 1e-9;

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
  const int open = open_ = m - rank;
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

double ContactDynamics::holds(int i) const {
  const ContactLaw& law = this->law(i);
  return law.holding() * (law.normal ? normal_[static_cast<size_t>(i)] : law.load);
}

// Columns of null_ without the normal reactions, which stay as share() has them: how many are left,
// the first ones.
int ContactDynamics::keep_tangential(int m) {
  int left = open_;
  const double size = null_.topLeftCorner(m, open_).cwiseAbs().maxCoeff();
  for (int i = 0; i < m; ++i) {
    const Row& row = on_[static_cast<size_t>(i)];
    if (law(row.contact).normal != row.row) continue;
    int pivot = 0;
    for (int c = 1; c < left; ++c)
      if (std::abs(null_(i, c)) > std::abs(null_(i, pivot))) pivot = c;
    if (left == 0 || !(std::abs(null_(i, pivot)) > kDependent * size)) continue;
    --left;
    null_.col(pivot).head(m).swap(null_.col(left).head(m));
    for (int c = 0; c < left; ++c) {
      const double part = null_(i, c) / null_(i, left);
      null_.col(c).head(m) -= part * null_.col(left).head(m);
    }
  }
  return left;
}

// In units of the bounds, of which none is below a part of the largest.
void ContactDynamics::limit() {
  if (open_ == 0) return;
  const auto m = static_cast<int>(on_.size());
  const int left = keep_tangential(m);
  open_ = 0;
  if (left == 0) return;
  double most = 0;
  for (const Row& row : on_) most = std::max(most, holds(row.contact));
  if (!(most > 0)) return;
  limit_.begin(left);
  for (int i = 0; i < m; ++i) {
    const Row& row = on_[static_cast<size_t>(i)];
    const ContactLaw& law = this->law(row.contact);
    if (law.normal == row.row) continue;
    if (law.tangential.front() == row.row)
      limit_.add(row.contact, static_cast<int>(law.tangential.size()));
    const int at = limit_.rows() - (law.tangential.back() == row.row ? 1 : 2);
    const double bound = std::max(holds(row.contact), kDependent * most);
    limit_.u(at) = multipliers_[i] / bound;
    for (int c = 0; c < left; ++c) limit_.v(at, c) = null_(i, c) / bound;
  }
  limit_.solve();
  for (int i = 0; i < count(); ++i)
    if (limit_.has(i))
      tangential_[static_cast<size_t>(i)] =
          std::max(holds(i), kDependent * most) * limit_.reaction(i);
}

double ContactDynamics::hold_left(int i) {
  limit();
  if (limit_.has(i)) return holds(i) * (1 - limit_.factor());
  return holds(i) - tangential_[static_cast<size_t>(i)].norm();
}

bool ContactDynamics::yields_with(int i, int first) {
  limit();
  if (limit_.has(i)) return limit_.yields(i);
  return i == first || hold_left(i) <= kOnRim * holds(i);
}

// N_i = sum_j w_j N_j: the height sum_j w_j h_j of heights h_j = -l_j/share. w is the least-squares
// solution in the metric, R M_A R^T w = R M_A N_i^T, and what is left of N_i beside it is
// round-off. What sticks across does not give way: with it the height is held for good (a stop of
// a joint whose friction sticks).
std::optional<double> ContactDynamics::height_of_held(const ContactStates& states, int i) {
  limit();
  if (!law(i).normal || !(law(i).share > 0)) return {};
  if (const int m = hold(states, i, false); m > 0) {
    double height = 0;
    for (int j = 0; j < m; ++j) {
      const int of = on_[static_cast<size_t>(j)].contact;
      height -= multipliers_[j] * normal_reaction(of) / law(of).share;
    }
    return height;
  }
  if (!mechanics_->has_drift() && hold(states, i, true) > 0)
    return std::numeric_limits<double>::infinity();
  return {};
}

// The number of rows of closed contacts, N alone or with what sticks across, of which the normal
// row of contact i is a combination, w in multipliers_; 0 where it is none.
int ContactDynamics::hold(const ContactStates& states, int i, bool across) {
  const Row own = {*law(i).normal, i};
  on_.clear();
  for (int j = 0; j < count(); ++j) {
    const ContactMode mode = states[static_cast<size_t>(j)].mode;
    if (mode != ContactMode::open && law(j).normal) on_.push_back({*law(j).normal, j});
    if (!across || mode != ContactMode::rolls) continue;
    for (const int row : law(j).tangential) on_.push_back({row, j});
  }
  const auto m = static_cast<int>(on_.size());
  if (m < (across ? 1 : 2) || m + 1 > responses_.cols()) return 0;
  respond_to(own.row, m);
  auto w = multipliers_.head(m);
  for (int j = 0; j < m; ++j) {
    const int row = on_[static_cast<size_t>(j)].row;
    w[j] = row_times(row, responses_.col(m));
    respond_to(row, j);
  }
  for (int j = 0; j < m; ++j)
    for (int l = 0; l < m; ++l)
      k_work_.data()[j + l * m] = row_times(on_[static_cast<size_t>(j)].row, responses_.col(l));
  pivots_.eliminate(k_map(m), w);
  row_ = responses_.col(m);
  for (int j = 0; j < m; ++j) row_ -= w[j] * responses_.col(j);
  const double rest = row_times(own.row, row_), size = row_times(own.row, responses_.col(m));
  return std::abs(rest) <= kDependent * size ? m : 0;
}

void ContactDynamics::give_way_by(double compliance, int m) {
  const double size = right_.col(0).head(m).maxCoeff();
  for (int i = 0; i < m; ++i) {
    const Row& row = on_[static_cast<size_t>(i)];
    const ContactLaw& law = this->law(row.contact);
    if (law.normal == row.row) k_(i, i) = right_(i, 0) + compliance * size / law.share;
  }
}

// Contacts whose heights give way, where rows depend on each other, ever less; what the last do
// rigid ones do, whose impulses are the nearest to theirs. Across nothing gives way: what holds
// together is not to creep (limit_load.hpp).
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
