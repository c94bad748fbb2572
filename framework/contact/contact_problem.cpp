#include <hamel/framework/contact/contact_problem.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <hamel/framework/lie/linear_solve.hpp>

namespace hamel {
namespace {

constexpr int kSweeps = 4000, kLook = 20;
constexpr int kNewton = 20, kTurns = 60, kAllTurn = 20;
// Residuals of what is solved: of equations that repeat others what these leave has no solution,
// and is round-off, or what secants of a step (nonsmooth_press.cpp) have still to find.
constexpr double kSolved = 1e-13, kMostLeft = 1e-7,
                 kSize = 10;  // kSize: of rows in units of one term
constexpr size_t kTurned = 8;

double cross_of(double a0, double a1, double b0, double b1) { return a0 * b1 - a1 * b0; }

}  // namespace

ContactProblem::ContactProblem(int unknowns, int contacts)
    : p_(unknowns),
      before_(unknowns),
      residual_(unknowns),
      kept_(unknowns),
      start_(unknowns),
      jacobian_(unknowns, unknowns),
      null_(unknowns, unknowns),
      squares_(unknowns * unknowns),
      pivots_(unknowns),
      convex_(unknowns) {
  answers_.reserve(static_cast<size_t>(contacts));
  told_.reserve(static_cast<size_t>(contacts));
  doubtful_.reserve(static_cast<size_t>(contacts));
}

// The block as the others leave it.
void ContactProblem::look_at_block(const Matrix& g, const Vector& c, const ContactBlock& block) {
  const int n = block.size(), first = block.first;
  block_g_.topLeftCorner(n, n) = g.block(first, first, n, n);
  for (int i = 0; i < n; ++i) {
    double sum = c[first + i];
    for (int j = 0; j < size_; ++j)
      if (j < first || j >= first + n) sum += g(first + i, j) * p_[j];
    block_c_[i] = sum;
  }
}

// False where a contact has no solution.
bool ContactProblem::sweep(const Matrix& g, const Vector& c, const Blocks& blocks) {
  for (size_t k = 0; k < blocks.size(); ++k) {
    look_at_block(g, c, blocks[k]);
    solve_contact(block_g_, block_c_, blocks[k], solutions_);
    if (solutions_.count() == 0) return false;
    // Of several the nearest one: a contact does not leave its branch for a sweep's sake.
    const int n = blocks[k].size(), first = blocks[k].first;
    int best = 0;
    const auto distance = [&](int i) {
      return (solutions_[i].p.head(n) - p_.segment(first, n)).squaredNorm();
    };
    for (int i = 1; i < solutions_.count(); ++i)
      if (distance(i) < distance(best)) best = i;
    p_.segment(first, n) = solutions_[best].p.head(n);
    answers_[k] = solutions_[best].answer;
  }
  return true;
}

// What the answers require of P, and its derivative: P = 0; gamma = 0; gamma_n = 0 with P_t on the
// rim and along gamma_t.
void ContactProblem::equations(const Matrix& g, const Vector& c, const Blocks& blocks) {
  auto r = residual_.head(size_);
  auto j = jacobian_.topLeftCorner(size_, size_);
  r = c;
  r.noalias() += g.lazyProduct(p_.head(size_));
  j = g;
  for (size_t k = 0; k < blocks.size(); ++k) {
    const ContactBlock& block = blocks[k];
    const int n = block.size(), first = block.first, t = first + (block.normal ? 1 : 0);
    if (answers_[k] == ContactAnswer::sticks) continue;
    if (answers_[k] == ContactAnswer::opens || (!block.normal && !(block.bound > 0))) {
      r.segment(first, n) = p_.segment(first, n);
      j.middleRows(first, n).setZero();
      j.block(first, first, n, n).setIdentity();
      continue;
    }
    const double most = block.normal ? block.friction * p_[first] : block.bound;
    if (block.tangential == 1) {
      const double sign = p_[t] < 0 ? -1 : 1;
      r[t] = p_[t] - sign * most;
      j.row(t).setZero();
      j(t, t) = 1;
      if (block.normal) j(t, first) = -sign * block.friction;
    } else if (block.tangential == 2) {
      const double p0 = p_[t], p1 = p_[t + 1], g0 = r[t], g1 = r[t + 1];
      for (int i = 0; i < size_; ++i) j(t + 1, i) = cross_of(p0, p1, g(t, i), g(t + 1, i));
      j(t + 1, t) += g1;
      j(t + 1, t + 1) -= g0;
      r[t + 1] = cross_of(p0, p1, g0, g1);
      r[t] = (p0 * p0 + p1 * p1 - most * most) / 2;
      j.row(t).setZero();
      j(t, t) = p0;
      j(t, t + 1) = p1;
      if (block.normal) j(t, first) = -most * block.friction;
    }
  }
}

// The correction of P, into before_; of several the shortest. False where it is not finite.
bool ContactProblem::find_correction() {
  auto r = residual_.head(size_);
  auto j = jacobian_.topLeftCorner(size_, size_);
  for (int i = 0; i < size_; ++i) {
    const double row = j.row(i).cwiseAbs().maxCoeff();
    if (!(row > 0)) continue;
    j.row(i) /= row;
    r[i] /= row;
  }
  const int rank = pivots_.eliminate(j, r);
  const double most = p_.head(size_).lpNorm<Eigen::Infinity>();
  left_ = rank < size_ && most > 0 ? kSize * pivots_.left() / most : 0;
  before_.head(size_) = r;
  if (rank < size_) shorten(rank);
  return before_.head(size_).allFinite();
}

// Takes what has no effect out of the correction d: d - Z (Z^T Z)^-1 Z^T d.
void ContactProblem::shorten(int rank) {
  const int open = size_ - rank;
  pivots_.find_null(jacobian_.topLeftCorner(size_, size_), rank, null_);
  const auto z = null_.topLeftCorner(size_, open);
  Eigen::Map<Eigen::MatrixXd> squares(squares_.data(), open, open);
  squares.noalias() = z.transpose().lazyProduct(z);
  residual_.head(open).noalias() = z.transpose().lazyProduct(before_.head(size_));
  solve_linear(squares_.data(), residual_.data(), open, 1);
  before_.head(size_).noalias() -= z.lazyProduct(residual_.head(open));
}

// Newton on the equations of the active set; the better of before and after stays. most_left: of
// what these may leave beside a residual that is solved.
bool ContactProblem::improve(const Matrix& g, const Vector& c, const Blocks& blocks,
                             double most_left) {
  kept_.head(size_) = p_.head(size_);
  left_ = 0;
  double best = contact_residual(g, c, blocks, p_.head(size_));
  for (int k = 0; k < kNewton && best > 1e-15; ++k) {
    equations(g, c, blocks);
    if (!find_correction()) break;
    p_.head(size_) -= before_.head(size_);
    const double now = contact_residual(g, c, blocks, p_.head(size_));
    if (!(now < best)) {
      if (k > 2) break;
      continue;
    }
    best = now;
    kept_.head(size_) = p_.head(size_);
  }
  p_.head(size_) = kept_.head(size_);
  return best <= kSolved + std::min(left_, most_left);
}

// The active set by its own equations: their solution tells, by what P - gamma/G would be, which
// contacts do otherwise, and these turn, all of them or, where that goes round, the first one.
bool ContactProblem::settle(const Matrix& g, const Vector& c, const Blocks& blocks,
                            double most_left) {
  start_.head(size_) = p_.head(size_);
  told_ = answers_;
  for (int turn = 0; turn < kTurns; ++turn) {
    if (improve(g, c, blocks, most_left)) return true;
    for (int k = 0; k < kNewton; ++k) {
      equations(g, c, blocks);
      if (!find_correction()) break;
      p_.head(size_) -= before_.head(size_);
      if (before_.head(size_).norm() <= 1e-14 * p_.head(size_).norm()) break;
    }
    if (!p_.head(size_).allFinite() || !turn_contacts(g, c, blocks, turn < kAllTurn)) break;
  }
  p_.head(size_) = start_.head(size_);
  answers_ = told_;
  return false;
}

// Do any?
bool ContactProblem::turn_contacts(const Matrix& g, const Vector& c, const Blocks& blocks,
                                   bool all) {
  residual_.head(size_) = c;
  residual_.head(size_).noalias() += g.lazyProduct(p_.head(size_));
  bool out = false;
  for (size_t k = 0; k < blocks.size() && (all || !out); ++k) {
    const ContactBlock& block = blocks[k];
    const int first = block.first, t = first + (block.normal ? 1 : 0);
    const auto without = [&](int i) {
      return g(i, i) > 0 ? p_[i] - residual_[i] / g(i, i) : p_[i];
    };
    ContactAnswer next = ContactAnswer::sticks;
    const double pn = block.normal ? without(first) : 0;
    const double most = block.normal ? block.friction * pn : block.bound;
    Eigen::Vector2d pt(0, 0);
    for (int i = 0; i < block.tangential; ++i) pt[i] = without(t + i);
    const double length = pt.norm();
    if (block.normal && !(pn > 0)) next = ContactAnswer::opens;
    else if (block.tangential > 0 && length > most) next = ContactAnswer::slides;
    if (next == answers_[k]) continue;
    out = true;
    answers_[k] = next;
    if (block.normal) p_[first] = std::max(0., pn);
    const double part = next == ContactAnswer::opens ? 0 : length > most ? most / length : 1;
    p_.segment(t, block.tangential) = part * pt.head(block.tangential);
  }
  return out;
}

// Along the path of the convex problem until the equations of what it tells have a solution of (1)
// next to it; where bounds differ so much that none has, anywhere. Its equations leave nothing: a
// solution there always is.
bool ContactProblem::minimise(const Matrix& g, const Vector& c, const Blocks& blocks) {
  const auto ends = [&](bool wary, bool anywhere) {
    convex_.tell(wary, p_.head(size_), answers_);
    if (!improve(g, c, blocks, 0)) return false;
    const auto told = residual_.head(size_), now = p_.head(size_);
    convex_.tell(wary, residual_.head(size_), answers_);
    const double size = std::max(told.lpNorm<Eigen::Infinity>(), now.lpNorm<Eigen::Infinity>());
    return anywhere || (told - now).lpNorm<Eigen::Infinity>() <= 1e-3 * size;
  };
  for (const bool anywhere : {false, true})
    for (const double least : {1e-7, 1e-9, 1e-11}) {
      convex_.begin(g, c, blocks, least);
      while (convex_.follow())
        if (convex_.tells() && (ends(true, anywhere) || ends(false, anywhere))) return true;
    }
  convex_.tell(false, p_.head(size_), answers_);
  return settle(g, c, blocks, 0) || turn_some(g, c, blocks);
}

// Where bounds differ by orders of magnitude, what a contact presses on its rim is below the
// round-off of the whole path: what the path does not tell, of the least certain contacts.
bool ContactProblem::turn_some(const Matrix& g, const Vector& c, const Blocks& blocks) {
  const size_t turned = std::min(blocks.size(), kTurned);
  doubtful_.resize(blocks.size());
  std::iota(doubtful_.begin(), doubtful_.end(), size_t{0});
  std::ranges::sort(doubtful_, std::less{}, [this](size_t k) { return convex_.certainty(k); });
  for (unsigned some = 1; some < 1U << turned; ++some) {
    convex_.tell(false, p_.head(size_), answers_);
    for (size_t i = 0; i < turned; ++i) {
      if ((some >> i & 1U) == 0) continue;
      ContactAnswer& answer = answers_[doubtful_[i]];
      const bool normal = blocks[doubtful_[i]].normal;
      if (answer != ContactAnswer::sticks) answer = ContactAnswer::sticks;
      else answer = normal ? ContactAnswer::opens : ContactAnswer::slides;
    }
    if (improve(g, c, blocks, 0)) return true;
  }
  return false;
}

ContactProblem::Outcome ContactProblem::solve(const Matrix& g, const Vector& c,
                                              const Blocks& blocks) {
  size_ = static_cast<int>(c.size());
  p_.head(size_).setZero();
  answers_.assign(blocks.size(), ContactAnswer::opens);
  if (blocks.size() == 1) {
    look_at_block(g, c, blocks[0]);
    solve_contact(block_g_, block_c_, blocks[0], solutions_);
    if (solutions_.count() != 1 && !blocks[0].normal)
      return minimise(g, c, blocks) ? Outcome::one : Outcome::none;
    if (solutions_.count() == 0) return Outcome::none;
    p_.head(size_) = solutions_[0].p.head(size_);
    answers_[0] = solutions_[0].answer;
    return solutions_.count() == 1 ? Outcome::one : Outcome::several;
  }
  solutions_.clear();
  if (ConvexContacts::applies(g, blocks))
    return minimise(g, c, blocks) ? Outcome::one : Outcome::none;
  return sweeps(g, c, blocks, kLook);
}

ContactProblem::Outcome ContactProblem::solve_next(const Matrix& g, const Vector& c,
                                                   const Blocks& blocks) {
  if (blocks.size() < 2 || ConvexContacts::applies(g, blocks)) return solve(g, c, blocks);
  return sweeps(g, c, blocks, 1);
}

bool ContactProblem::refine(const Matrix& g, const Vector& c, const Blocks& blocks) {
  return size_ == c.size() && answers_.size() == blocks.size() && settle(g, c, blocks, kMostLeft);
}

// Sweeps until the equations of what the contacts then do have a solution, after so many for the
// first time.
ContactProblem::Outcome ContactProblem::sweeps(const Matrix& g, const Vector& c,
                                               const Blocks& blocks, int first_look) {
  for (int k = 1; k <= kSweeps; ++k) {
    kept_.head(size_) = p_.head(size_);
    if (!sweep(g, c, blocks)) return Outcome::none;
    const double moved = (p_ - kept_).head(size_).lpNorm<Eigen::Infinity>();
    double most = p_.head(size_).lpNorm<Eigen::Infinity>();
    for (const ContactBlock& block : blocks)
      if (!block.normal) most = std::max(most, block.bound);
    const bool settled = moved <= 1e-15 * most;
    if ((settled || k == first_look || k % kLook == 0) && settle(g, c, blocks, kMostLeft))
      return Outcome::one;
    if (settled) break;
  }
  return Outcome::none;
}

double contact_residual(const ContactProblem::Matrix& g, const ContactProblem::Vector& c,
                        const std::vector<ContactBlock>& blocks, const ContactProblem::Vector& p) {
  double out = 0, size = 0, force = p.lpNorm<Eigen::Infinity>();
  const auto gamma_of = [&](int i) {
    double sum = c[i];
    for (Eigen::Index j = 0; j < p.size(); ++j) sum += g(i, j) * p[j];
    return sum;
  };
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    double sum = std::abs(c[i]);
    for (Eigen::Index j = 0; j < p.size(); ++j) sum += std::abs(g(i, j) * p[j]);
    size = std::max(size, sum);
  }
  for (const ContactBlock& block : blocks) {  // a given bound has a size of its own
    if (block.normal || block.tangential == 0) continue;
    force = std::max(force, block.bound);
    size = std::max(size, std::abs(g(block.first, block.first)) * block.bound);
  }
  if (!(size > 0)) size = 1;
  if (!(force > 0)) force = 1;
  for (const ContactBlock& block : blocks) {
    const int t = block.first + (block.normal ? 1 : 0);
    const double pn = block.normal ? p[block.first] / force : 0;
    if (block.normal) {
      const double gn = gamma_of(block.first) / size;
      out = std::max({out, -pn, -gn, std::min(std::abs(pn), std::abs(gn))});
    }
    const double most = block.normal ? block.friction * pn : block.bound / force;
    double pt = 0, gt = 0, along = 0;
    for (int i = 0; i < block.tangential; ++i) {
      const double one = p[t + i] / force, left = gamma_of(t + i) / size;
      pt = std::hypot(pt, one);
      gt = std::hypot(gt, left);
      along += one * left;
    }
    out = std::max(out, pt - most);
    // Within the cone no slip is left; on its rim the slip is opposite to P_t.
    const double inside = std::min(gt, std::abs(most - pt));
    if (block.normal && !(pn > 0)) continue;  // open: free to slip
    if (!(most > 0)) continue;                // no friction
    const double opposite = pt > 0 ? gt + along / pt : gt;
    out = std::max({out, inside, std::min(opposite, gt)});
  }
  return out;
}

}  // namespace hamel
