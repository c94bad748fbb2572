#include <hamel/framework/contact/contact_dynamics.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <hamel/framework/lie/linear_solve.hpp>

namespace hamel {
namespace {

std::vector<int> rows_of_none(const Mechanics& mechanics, const std::vector<ContactLaw>& laws) {
  std::vector<int> out;
  for (int row = 0; row < mechanics.constraint_count(); ++row) {
    const bool taken = std::any_of(laws.begin(), laws.end(), [&](const ContactLaw& law) {
      return law.normal == row || std::ranges::count(law.tangential, row) > 0;
    });
    if (!taken) out.push_back(row);
  }
  return out;
}

int tangential_count(const ContactLaw& law) { return static_cast<int>(law.tangential.size()); }

}  // namespace

ContactDynamics::ContactDynamics(std::shared_ptr<const Geometry> geometry,
                                 std::shared_ptr<const Mechanics> mechanics,
                                 std::vector<ContactLaw> laws)
    : geometry_(std::move(geometry)),
      mechanics_(std::move(mechanics)),
      laws_(std::move(laws)),
      always_(rows_of_none(*mechanics_, laws_)),
      metric_(mechanics_->dim(), static_cast<int>(always_.size())),
      problem_(3 * count(), count()) {
  const int n = mechanics_->dim(), k = mechanics_->constraint_count(), most = 3 * count();
  const auto contacts = static_cast<size_t>(count());
  a_.setZero(k, n);
  for (Eigen::VectorXd* v : {&b_, &rates_, &reactions_}) v->setZero(k);
  for (Eigen::VectorXd* v :
       {&xi_, &change_, &force_, &free_, &acceleration_, &row_, &column_, &work_})
    v->setZero(n);
  gaps_.setZero(mechanics_->holonomic_rows());
  always_rates_.setZero(static_cast<Eigen::Index>(always_.size()));
  no_rates_ = always_rates_;
  responses_.setZero(n, most);
  k_.setZero(most, most);
  multipliers_.setZero(most);
  c_ = multipliers_;
  k_work_ = k_;
  normal_.resize(contacts);
  coefficient_.resize(contacts);
  tangential_.resize(contacts);
  on_.reserve(static_cast<size_t>(most));
  blocks_.reserve(contacts);
  block_contacts_.reserve(contacts);
}

std::vector<int> ContactDynamics::rows(const ContactStates& states) const {
  std::vector<int> out = always_;
  for (int i = 0; i < count(); ++i) {
    const ContactMode mode = states[static_cast<size_t>(i)].mode;
    if (mode != ContactMode::open && law(i).normal) out.push_back(*law(i).normal);
    if (mode != ContactMode::rolls) continue;
    out.insert(out.end(), law(i).tangential.begin(), law(i).tangential.end());
  }
  std::sort(out.begin(), out.end());
  return out;
}

void ContactDynamics::evaluate(double t, const double* g, const ConstVector& xi) {
  time_ = t;
  xi_ = xi;
  const bool first = !metric_.known();
  if (first && mechanics_->constant_constraints()) mechanics_->constraints(t, g, a_, b_);
  if (first && mechanics_->constant_inertia()) mechanics_->inertia(g, metric_.inertia);
  mechanics_->motion(*geometry_, t, g, xi_, metric_.inertia, a_, b_, rates_, change_);
  mechanics_->holonomic(g, gaps_);
  const bool rows_change = first || !mechanics_->constant_constraints();
  for (size_t i = 0; i < always_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    metric_.a.row(at) = a_.row(always_[i]);
    metric_.b[at] = b_[always_[i]];
    always_rates_[at] = rates_[always_[i]];
  }
  metric_.factor(first || !mechanics_->constant_inertia(), !always_.empty() && rows_change);
}

double ContactDynamics::gap(int i) const {
  const int first = mechanics_->constraint_count() - mechanics_->holonomic_rows();
  return law(i).normal ? gaps_[*law(i).normal - first] : 0;
}
double ContactDynamics::gap_rate(int i) const {
  return law(i).normal ? row_times(*law(i).normal, xi_) - b_[*law(i).normal] : 0;
}
double ContactDynamics::gap_acceleration(int i) const {
  return law(i).normal ? row_times(*law(i).normal, acceleration_) - rates_[*law(i).normal] : 0;
}
Eigen::Vector2d ContactDynamics::slip_rate(int i) const {
  Eigen::Vector2d out(0, 0);
  for (int j = 0; j < tangential_count(law(i)); ++j) {
    const int row = law(i).tangential[static_cast<size_t>(j)];
    out[j] = row_times(row, acceleration_) - rates_[row];
  }
  return out;
}
Eigen::Vector2d ContactDynamics::slip(int i) const {
  Eigen::Vector2d out(0, 0);
  for (int j = 0; j < tangential_count(law(i)); ++j) {
    const int row = law(i).tangential[static_cast<size_t>(j)];
    out[j] = row_times(row, xi_) - b_[row];
  }
  return out;
}

// |s| <= sqrt(2 E T M_A T^T) of a direction, by Cauchy and Schwarz; of both directions.
double ContactDynamics::slip_scale(int i) {
  metric_.momentum(xi_, work_);
  const double twice_energy = work_.dot(xi_);
  double reach = 0;
  for (const int row : law(i).tangential) {
    respond_to(row, 0);
    reach += row_times(row, responses_.col(0));
  }
  return std::sqrt(std::fmax(0, twice_energy * reach));
}

Eigen::Vector2d ContactDynamics::direction(int i, const ContactState& state) const {
  const Eigen::Vector2d s = slip(i);
  const double size = s.norm();
  return size > state.no_slip ? Eigen::Vector2d(s / size) : state.direction;
}

void ContactDynamics::respond(int column) {
  metric_.solve(column_, no_rates_, row_);
  responses_.col(column) = row_;
}
void ContactDynamics::respond_to(int row, int column) {
  column_ = a_.row(row).transpose();
  respond(column);
}

// N - mu d^T T; without N the force of a given load.
void ContactDynamics::sliding_row(int i, const Eigen::Vector2d& d, Eigen::VectorXd& out) const {
  const ContactLaw& law = this->law(i);
  const double most = law.friction * (law.normal ? 1 : law.load);
  if (law.normal) out = a_.row(*law.normal).transpose();
  else out.setZero();
  for (int j = 0; j < tangential_count(law); ++j)
    out -= most * d[j] * a_.row(law.tangential[static_cast<size_t>(j)]).transpose();
}

// Without the reactions of contacts, but with the friction of given loads that slide.
void ContactDynamics::free_acceleration(const ContactStates& states, int slides) {
  force_ = change_;
  for (int i = 0; i < count(); ++i) {
    const ContactState& state = states[static_cast<size_t>(i)];
    if (law(i).normal || state.mode != ContactMode::slides) continue;
    sliding_row(i, i == slides ? state.direction : direction(i, state), work_);
    force_ += work_;
  }
  metric_.solve(force_, always_rates_, free_);
}

bool ContactDynamics::accelerate(const ContactStates& states) {
  on_.clear();
  free_acceleration(states, -1);
  for (int i = 0; i < count(); ++i) {
    const ContactState& state = states[static_cast<size_t>(i)];
    const auto at = static_cast<size_t>(i);
    normal_[at] = coefficient_[at] = 0;
    tangential_[at].setZero();
    if (state.mode == ContactMode::open) continue;
    if (law(i).normal) {
      if (state.mode == ContactMode::slides) sliding_row(i, direction(i, state), column_);
      else column_ = a_.row(*law(i).normal).transpose();
      respond(static_cast<int>(on_.size()));
      on_.push_back({*law(i).normal, i});
      coefficient_[at] =
          row_times(*law(i).normal, responses_.col(static_cast<int>(on_.size()) - 1));
    }
    if (state.mode != ContactMode::rolls) continue;
    for (const int row : law(i).tangential) {
      respond_to(row, static_cast<int>(on_.size()));
      on_.push_back({row, i});
    }
  }
  const auto m = static_cast<int>(on_.size());
  for (int i = 0; i < m; ++i) {
    const int row = on_[static_cast<size_t>(i)].row;
    multipliers_[i] = rates_[row] - row_times(row, free_);
    for (int j = 0; j < m; ++j) k_work_.data()[i + j * m] = row_times(row, responses_.col(j));
  }
  if (m > 0) solve_linear(k_work_.data(), multipliers_.data(), m, 1);
  acceleration_ = free_;
  for (int i = 0; i < m; ++i) acceleration_ += multipliers_[i] * responses_.col(i);
  for (int i = 0; i < m; ++i) {
    const auto at = static_cast<size_t>(on_[static_cast<size_t>(i)].contact);
    const ContactLaw& law = laws_[at];
    const int row = on_[static_cast<size_t>(i)].row;
    if (law.normal == row) normal_[at] = multipliers_[i];
    for (int j = 0; j < tangential_count(law); ++j)
      if (law.tangential[static_cast<size_t>(j)] == row) tangential_[at][j] = multipliers_[i];
  }
  for (int i = 0; i < count(); ++i) {
    const ContactState& state = states[static_cast<size_t>(i)];
    if (state.mode != ContactMode::slides) continue;
    const auto at = static_cast<size_t>(i);
    if (!law(i).normal) normal_[at] = law(i).load;
    tangential_[at] = -law(i).friction * normal_[at] * direction(i, state);
  }
  return acceleration_.allFinite();
}

const Eigen::VectorXd& ContactDynamics::reactions() {
  reactions_.setZero();
  // A^T l = I xi' - the forces, of which those of contacts are known.
  force_ = change_;
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    if (law(i).normal) {
      reactions_[*law(i).normal] = normal_[at];
      force_ += normal_[at] * a_.row(*law(i).normal).transpose();
    }
    for (int j = 0; j < tangential_count(law(i)); ++j) {
      const int row = law(i).tangential[static_cast<size_t>(j)];
      reactions_[row] = tangential_[at][j];
      force_ += tangential_[at][j] * a_.row(row).transpose();
    }
  }
  if (always_.empty()) return reactions_;
  metric_.solve(force_, always_rates_, row_);
  const auto& l = metric_.multipliers(force_, row_);
  for (size_t i = 0; i < always_.size(); ++i)
    reactions_[always_[i]] = l[static_cast<Eigen::Index>(i)];
  return reactions_;
}

double ContactDynamics::reaction_power() {
  double out = 0;
  for (int i = 0; i < count(); ++i) out += tangential_[static_cast<size_t>(i)].dot(slip(i));
  return out;
}

// ---- one set of modes ---------------------------------------------------------------------------

ModeMechanics::ModeMechanics(std::shared_ptr<ContactDynamics> dynamics,
                             std::shared_ptr<const ContactStates> states)
    : dynamics_(std::move(dynamics)), states_(std::move(states)), rows_(dynamics_->rows(*states_)) {
  const int k = full().constraint_count(), first = k - full().holonomic_rows();
  for (const int row : rows_)
    if (row >= first) gaps_.push_back(row - first);
  all_rows_.resize(k, dim());
  all_b_.resize(k);
  all_gaps_.resize(k - first);
}

void ModeMechanics::constraints(double t, const double* g, Matrix a, Vector b) const {
  full().constraints(t, g, all_rows_, all_b_);
  for (size_t i = 0; i < rows_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    a.row(at) = all_rows_.row(rows_[i]);
    b[at] = all_b_[rows_[i]];
  }
}

void ModeMechanics::holonomic(const double* g, Vector out) const {
  full().holonomic(g, all_gaps_);
  for (size_t i = 0; i < gaps_.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = all_gaps_[gaps_[i]];
}

void ModeMechanics::accelerations(double t, const double* g, ConstVector xi, Vector out) const {
  dynamics_->evaluate(t, g, xi);
  dynamics_->accelerate(*states_);
  out = dynamics_->acceleration();
}

}  // namespace hamel
