#include <hamel/framework/contact/convex_contacts.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace hamel {
namespace {

constexpr double kLastWeight = 1e-13, kTellingWeight = 1e-12;
constexpr int kSteps = 100;  // of Newton for one m, of which about 5 are taken

}  // namespace

ConvexContacts::ConvexContacts(int unknowns)
    : q_(unknowns, unknowns),
      hessian_(unknowns, unknowns),
      x_(unknowns),
      unit_(unknowns),
      linear_(unknowns),
      gradient_(unknowns),
      step_(unknowns) {}

bool ConvexContacts::applies(const Matrix& g, const Blocks& blocks) {
  for (const ContactBlock& block : blocks)
    if (block.normal && block.tangential > 0) return false;
  double most = 0, asymmetry = 0;
  for (Eigen::Index j = 0; j < g.cols(); ++j)
    for (Eigen::Index i = 0; i <= j; ++i) {
      most = std::max(most, std::abs(g(i, j)));
      asymmetry = std::max(asymmetry, std::abs(g(i, j) - g(j, i)));
    }
  return asymmetry <= 1e-10 * most;
}

// In units: of a bound itself, of a normal reaction what moves as much as the largest of bounds and
// of what c requires, in sqrt(G_ii) P_i.
void ConvexContacts::begin(const Matrix& g, const Vector& c, const Blocks& blocks, double least) {
  least_ = least;
  blocks_ = &blocks;
  size_ = static_cast<int>(c.size());
  m_ = 10;
  double most = 0;
  for (const ContactBlock& block : blocks)
    for (int i = block.first; i < block.first + block.size(); ++i) {
      const double moved = std::sqrt(g(i, i));
      most = std::max(most, block.normal ? 0 : moved * block.bound);
      if (moved > 0) most = std::max(most, std::abs(c[i]) / moved);
    }
  if (!(most > 0)) most = 1;
  for (const ContactBlock& block : blocks)
    for (int i = block.first; i < block.first + block.size(); ++i) {
      unit_[i] = !block.normal ? block.bound : g(i, i) > 0 ? most / std::sqrt(g(i, i)) : 1;
      x_[i] = block.normal ? 1 : 0;
    }
  double size = 0;
  for (int i = 0; i < size_; ++i) {
    linear_[i] = unit_[i] * c[i];
    size = std::max(size, std::abs(linear_[i]));
    for (int j = 0; j < size_; ++j) {
      q_(i, j) = unit_[i] * (g(i, j) + g(j, i)) / 2 * unit_[j];
      size = std::max(size, std::abs(q_(i, j)));
    }
  }
  if (!(size > 0)) size = 1;
  linear_.head(size_) /= size;
  q_.topLeftCorner(size_, size_) /= size;
  for (int i = 0; i < size_; ++i) q_(i, i) += least;
}

double ConvexContacts::room(const ContactBlock& block) const {
  double out = 1;
  for (int i = 0; i < block.tangential; ++i) out -= x_[block.first + i] * x_[block.first + i];
  return out;
}

void ConvexContacts::add_barrier(const ContactBlock& block) {
  const int first = block.first;
  if (block.normal) {
    gradient_[first] -= m_ / x_[first];
    hessian_(first, first) += m_ / (x_[first] * x_[first]);
    return;
  }
  const double inside = room(block);
  for (int i = first; i < first + block.tangential; ++i) {
    gradient_[i] += 2 * m_ * x_[i] / inside;
    hessian_(i, i) += 2 * m_ / inside;
    for (int j = first; j < first + block.tangential; ++j)
      hessian_(i, j) += 4 * m_ * x_[i] * x_[j] / (inside * inside);
  }
}

double ConvexContacts::centre() {
  auto h = hessian_.topLeftCorner(size_, size_);
  auto g = gradient_.head(size_);
  auto d = step_.head(size_);
  h = q_.topLeftCorner(size_, size_);
  g = linear_.head(size_);
  g.noalias() += q_.topLeftCorner(size_, size_).lazyProduct(x_.head(size_));
  for (const ContactBlock& block : *blocks_) add_barrier(block);
  d = g;
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(h);
  factors.solveInPlace(d);
  const double decrement = std::sqrt(std::max(0.0, d.dot(g)) / m_);
  double length = decrement > 0.25 ? 1 / (1 + decrement) : 1;
  const Eigen::Index inside = 60;
  for (Eigen::Index k = 0; k < inside; ++k, length /= 2) {  // round-off alone can leave the domain
    x_.head(size_) -= length * d;
    const bool stays = std::ranges::all_of(*blocks_, [this](const ContactBlock& block) {
      return block.normal ? x_[block.first] > 0 : room(block) > 0;
    });
    if (stays) break;
    x_.head(size_) += length * d;
  }
  return decrement;
}

bool ConvexContacts::follow() {
  if (m_ <= 1.01 * kLastWeight) return false;
  m_ /= 10;
  for (int k = 0; k < kSteps && centre() > 0.1; ++k) {
  }
  return x_.head(size_).allFinite();
}

bool ConvexContacts::tells() const { return m_ <= 1.01 * kTellingWeight; }

double ConvexContacts::pressed(const ContactBlock& block) const {
  return block.normal ? m_ / x_[block.first] : 2 * m_ / room(block);
}

double ConvexContacts::left(const ContactBlock& block) const {
  return block.normal ? x_[block.first] : room(block);
}

double ConvexContacts::certainty(size_t k) const {
  return std::abs(std::log(pressed((*blocks_)[k]) / left((*blocks_)[k])));
}

// By the multiplier 2 m/room of the bound, which is |gamma_t|: against the room, or what the least
// sum may make of it.
void ConvexContacts::tell(bool wary, Eigen::Ref<Eigen::VectorXd> p,
                          std::vector<ContactAnswer>& answers) const {
  p = unit_.head(size_).cwiseProduct(x_.head(size_));
  for (size_t k = 0; k < blocks_->size(); ++k) {
    const ContactBlock& block = (*blocks_)[k];
    const double room_left = left(block);
    const bool ends = pressed(block) > (wary ? std::min(room_left, 0.01 * least_) : room_left);
    if (block.normal) answers[k] = ends ? ContactAnswer::opens : ContactAnswer::sticks;
    else answers[k] = ends || !(block.bound > 0) ? ContactAnswer::slides : ContactAnswer::sticks;
  }
}

}  // namespace hamel
