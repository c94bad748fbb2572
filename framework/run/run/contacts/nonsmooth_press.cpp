// Impulses at the beginning of a step of the scheme nonsmooth.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/run/run/contacts/nonsmooth_kernel.hpp>

namespace hamel {
namespace {

// Secants of P; changes of gamma, relative to its terms, that end them (below them is what gap/h
// and slip are known to), and that still will do.
constexpr int kSecants = 40;
constexpr double kSolved = 1e-14, kWillDo = 1e-11;
// Moves of gamma whose secant is not round-off.
constexpr double kSecant = 1e-6;

}  // namespace

Status NonsmoothKernel::take_step(const Eigen::VectorXd& p, Nearby to) {
  pushed_ = xi_ + given_;
  for (Eigen::Index i = 0; i < p.size(); ++i) pushed_ += p[i] * responses_.col(i);
  put_lift(to, std::span(pushed_.data(), velocity_.size()), length_);
  const Status status = lift_->advance(1);
  if (!status.ok) return status;
  fresh_ = false;
  lift_->node(end_);
  setup_.geometry->from_coordinates(end_.coordinates, g1_.data());
  dynamics().mechanics().holonomic(g1_.data(), gaps_);
  return status;
}

// An input that jumps or bends within a step ends it there.
Status NonsmoothKernel::find_length() {
  length_ = left_;
  first_ = Nearby::node;
  if (setup_.inputs == nullptr || !setup_.inputs->breaks()) return {};
  const Status status = lift_->advance(1);  // from the node
  first_ = Nearby::step;
  length_ = lift_->time() - time_;
  return status;
}

Status NonsmoothKernel::find_gamma(Eigen::VectorXd& out) {
  const Mechanics& system = dynamics().mechanics();
  const double h = end_.time - time_;
  setup_.geometry->inverse(g_.data(), middle_.data());
  setup_.geometry->compose(middle_.data(), g1_.data(), middle_.data());
  if (!setup_.geometry->tau_inverse(middle_.data(), moved_.data()))
    return fail("nonsmooth: the step leaves the domain of the retraction");
  half_ = moved_ / 2;
  setup_.geometry->tau(half_.data(), middle_.data());
  setup_.geometry->compose(g_.data(), middle_.data(), middle_.data());
  system.constraints(time_ + h / 2, middle_.data(), a_, b_);
  const int first = system.constraint_count() - system.holonomic_rows();
  round_off_ = 0;
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const int row = rows_of_p_[static_cast<size_t>(i)].row;
    round_off_ = std::max(round_off_, place_scale(row));
    if (row >= first) out[i] = gaps_[row - first] / h;
    else out[i] = a_.row(row).dot(moved_) / h - b_[row];
  }
  round_off_ *= 4 * std::numeric_limits<double>::epsilon() / std::abs(h);
  return {};
}

// A displacement that a row has where each angle moves by 1 and each place by its distance from the
// origin: its round-off is that of the row's.
double NonsmoothKernel::place_scale(int row) const {
  double length = 0;
  for (const size_t i : lengths_) length = std::max(length, std::abs(end_.coordinates[i]));
  double out = 0;
  for (Eigen::Index j = 0; j < a_.cols(); ++j)
    out += std::abs(a_(row, j)) * (is_place_[static_cast<size_t>(j)] != 0 ? length : 1);
  return out;
}

// Rows of P, and G with what the secants of the last step have found beside its own; P itself goes
// on from there, where the rows were these.
void NonsmoothKernel::begin_press() {
  dynamics().set_up_impulses(contacts_->states(), on_, length_ / 2, true);
  const int m = dynamics().impulse_count();
  given_ = dynamics().given_change();
  responses_.resize(xi_.size(), m);
  rows_before_.swap(rows_of_p_);
  rows_of_p_.resize(static_cast<size_t>(m));
  for (int i = 0; i < m; ++i) {
    responses_.col(i) = dynamics().impulse_response(i);
    const int contact = dynamics().impulse_contact(i);
    rows_of_p_[static_cast<size_t>(i)] = {dynamics().impulse_row(i), contact,
                                          contacts_->states()[static_cast<size_t>(contact)].mode};
  }
  dynamics().impulse_metric(metric_);
  own_metric_ = metric_;
  if (rows_of_p_ == rows_before_ && beside_.rows() == m) {
    // (A G that is not the rows' own would hide that they depend on each other.)
    if (!dynamics().impulses_depend(metric_)) metric_ += beside_;
    now_ = 2 * p_ - p_before_;  // the next of a line
    if (steady_ == 0) now_ = p_;
    ++steady_;
    p_before_ = p_;
    p_ = now_;
    return;
  }
  steady_ = 0;
  fresh_ = true;
  for (Eigen::VectorXd* v : {&p_, &p_before_, &now_, &move_, &missed_, &best_, &c_, &gamma_})
    v->setZero(m);
  beside_.setZero(m, m);
}

// The impulses P of the contacts that are on, and the step behind them: from those of the step
// before, and where these lead nowhere from none.
Status NonsmoothKernel::press() {
  Status status = find_impulses();
  if (status.ok || steady_ == 0) return status;
  forget_steps();
  return find_impulses();
}

void NonsmoothKernel::forget_steps() {
  rows_of_p_.clear();
  fresh_ = true;
  dynamics().forget_impulses();
}

Status NonsmoothKernel::find_impulses() {
  dynamics().evaluate(time_, g_.data(), xi_);
  double speed = 0;  // that the energy allows
  for (int i = 0; i < count(); ++i)
    if (on_[static_cast<size_t>(i)] != ImpulseOf::none)
      speed = std::max(speed, dynamics().speed_scale(i));
  begin_press();
  Status status = take_step(p_, first_);
  if (!status.ok || p_.size() == 0) return status;
  if (status = find_gamma(gamma_); !status.ok) return status;
  double least = std::numeric_limits<double>::infinity();
  bool found = false;
  for (int k = 0; k < kSecants; ++k) {
    c_.noalias() = gamma_ - metric_.lazyProduct(p_);
    states_ = contacts_->states();
    const bool several = rows_of_p_.front().contact != rows_of_p_.back().contact;
    const bool near = k > 0 || (steady_ > 0 && several);  // of one all solutions are counted
    if (std::string why = dynamics().solve_impulses(metric_, c_, near, states_); !why.empty())
      return fail(why);
    move_ = dynamics().impulses() - p_;
    p_ += move_;
    status = take_step(p_, Nearby::step);
    if (!status.ok) return status;
    ++iterations_;
    if (status = find_gamma(now_); !status.ok) return status;
    turned_.noalias() = metric_.lazyProduct(move_);
    missed_ = now_ - gamma_ - turned_;
    const double size = std::max(c_.lpNorm<Eigen::Infinity>(), speed);
    const double error = size > 0 ? missed_.lpNorm<Eigen::Infinity>() / size : 0;
    gamma_ = now_;
    const double will_do = size > 0 ? std::max(kWillDo, round_off_ / size) : kWillDo;
    found = found || error <= will_do;
    if (error < least) {
      least = error;
      best_ = p_;
    } else if (found) {
      break;
    }
    if (error <= kSolved) break;
    if (dynamics().shared() || !(turned_.lpNorm<Eigen::Infinity>() > kSecant * size)) continue;
    c_ = metric_.diagonal().cwiseProduct(move_);
    metric_.noalias() += (missed_ / c_.dot(move_)) * c_.transpose();
  }
  if (!found)
    return fail(fmt::format("nonsmooth: the impulses of the step were not found in {} secants: "
                            "smaller steps",
                            kSecants),
                least);
  beside_ = metric_ - own_metric_;
  if (p_ == best_) return status;
  p_ = best_;
  return take_step(p_, Nearby::step);
}

}  // namespace hamel
