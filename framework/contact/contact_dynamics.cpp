#include <hamel/framework/contact/contact_dynamics.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <hamel/framework/lie/linear_solve.hpp>

namespace hamel {
namespace {

// A height that others hold gives way to its load by no more than this, of what it would alone.
constexpr double kHeld = 1e-9;
// Directions of several contacts that begin to slide turn by less than this in the last sweep: eps
// of (5) is small beside this part of a slip that has grown.
constexpr double kTurns = 1e-10;
constexpr int kSweeps = 200;

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
      pivots_(3 * count()),
      limit_(2 * count(), count()),
      problems_{Problem(3 * count(), count()), Problem(3 * count(), count())} {
  for (const ContactLaw& law : laws_) constant_loads_.push_back(law.load);
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
  right_.setZero(most, 4);
  null_.setZero(most, most);
  left_null_ = null_;
  work_m_.setZero(most);
  normal_equations_.setZero(most, most);
  directions_.resize(contacts, {1, 0});
  first_.resize(contacts, {1, 0});
  normal_.resize(contacts);
  coefficient_.resize(contacts);
  tangential_.resize(contacts);
  on_.reserve(static_cast<size_t>(most));
  blocks_.reserve(contacts);
  block_contacts_.reserve(contacts);
}

void ContactDynamics::find_loads(double t) {
  for (size_t i = 0; i < laws_.size(); ++i)
    if (laws_[i].load_input)
      laws_[i].load =
          constant_loads_[i] + (inputs_ == nullptr ? 0 : inputs_->at(t)[*laws_[i].load_input]);
}

void ContactDynamics::evaluate(double t, const double* g, const ConstVector& xi) {
  time_ = t;
  xi_ = xi;
  find_loads(t);
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

// |W xi| <= sqrt(2 E W M_A W^T) of a row, by Cauchy and Schwarz; of all of them.
double ContactDynamics::scale_at(int i, const Eigen::VectorXd& velocity) {
  metric_.momentum(velocity, work_);
  const double twice_energy = work_.dot(velocity);
  double reach = 0;
  const auto add = [&](int row) {
    respond_to(row, 0);
    reach += row_times(row, responses_.col(0));
  };
  for (const int row : law(i).tangential) add(row);
  if (law(i).normal) add(*law(i).normal);
  return std::sqrt(std::fmax(0, twice_energy * reach));
}

double ContactDynamics::friction_acceleration(int i) {
  double reach = 0;
  for (const int row : law(i).tangential) {
    respond_to(row, 0);
    reach += row_times(row, responses_.col(0));
  }
  return law(i).friction * (law(i).normal ? normal_reaction(i) : law(i).load) * reach;
}

void ContactDynamics::find_direction(const ContactStates& states, int i) {
  const ContactState& state = states[static_cast<size_t>(i)];
  const Eigen::Vector2d s = slip(i);
  const double size = s.norm();
  Eigen::Vector2d& out = directions_[static_cast<size_t>(i)];
  out = state.direction;
  if (!state.begins && size > state.no_slip)
    out = s.dot(state.direction) < 0 ? Eigen::Vector2d(-s / size) : s / size;
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
void ContactDynamics::free_acceleration(const ContactStates& states, int without) {
  force_ = change_;
  for (int i = 0; i < count(); ++i) {
    const ContactState& state = states[static_cast<size_t>(i)];
    if (law(i).normal || state.mode != ContactMode::slides || i == without) continue;
    sliding_row(i, direction(i), column_);
    force_ += column_;
  }
  metric_.solve(force_, always_rates_, free_);
}

void ContactDynamics::add_rows(int i, ContactMode mode) {
  if (mode == ContactMode::open) return;
  if (law(i).normal) {
    if (mode == ContactMode::slides) sliding_row(i, direction(i), column_);
    else column_ = a_.row(*law(i).normal).transpose();
    respond(static_cast<int>(on_.size()));
    on_.push_back({*law(i).normal, i});
  }
  if (mode != ContactMode::rolls) return;
  for (const int row : law(i).tangential) {
    respond_to(row, static_cast<int>(on_.size()));
    on_.push_back({row, i});
  }
}

// The contact problem of contact i with the others as they are: their multipliers, the first `m`,
// are eliminated. The direction stays where they leave its normal reaction open.
void ContactDynamics::find_first_direction(const ContactStates& states, int i) {
  on_.clear();
  for (int k = 0; k < count(); ++k)
    if (k != i) add_rows(k, states[static_cast<size_t>(k)].mode);
  const auto m = static_cast<int>(on_.size());
  add_rows(i, ContactMode::rolls);
  const int n = static_cast<int>(on_.size()) - m;
  const auto row_of = [&](int k) { return on_[static_cast<size_t>(k)].row; };
  for (int k = 0; k < m; ++k) {
    for (int l = 0; l < m; ++l) k_work_.data()[k + l * m] = row_times(row_of(k), responses_.col(l));
    for (int l = 0; l < n; ++l)
      right_.data()[k + l * m] = row_times(row_of(k), responses_.col(m + l));
    right_.data()[k + n * m] = row_times(row_of(k), free_) - rates_[row_of(k)];
  }
  if (m > 0) pivots_.eliminate(k_map(m), Eigen::Map<Eigen::MatrixXd>(right_.data(), m, n + 1));
  Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  for (int k = 0; k < n; ++k) {
    const int row = row_of(m + k);
    for (int l = 0; l <= n; ++l) {
      double sum =
          l < n ? row_times(row, responses_.col(m + l)) : row_times(row, free_) - rates_[row];
      for (int j = 0; j < m; ++j)
        sum -= row_times(row, responses_.col(j)) * right_.data()[j + l * m];
      if (l < n) g(k, l) = sum;
      else c[k] = sum;
    }
  }
  const bool normal = law(i).normal.has_value();
  // Three other legs hold its height: its load is shared, and not known here.
  if (normal && !(g(0, 0) > kHeld * row_times(row_of(m), responses_.col(m)))) return;
  solve_contact(g, c,
                {.first = 0,
                 .normal = normal,
                 .tangential = tangential_count(law(i)),
                 .friction = law(i).friction,
                 .bound = law(i).friction * law(i).load},
                solutions_);
  take_nearest_slide(i);
}

// The direction of the solution that slides and is nearest to the known one.
void ContactDynamics::take_nearest_slide(int i) {
  const bool normal = law(i).normal.has_value();
  Eigen::Vector2d& out = directions_[static_cast<size_t>(i)];
  const Eigen::Vector2d known = out;
  double nearest = 0;
  for (int k = 0; k < solutions_.count(); ++k) {
    if (solutions_[k].answer != ContactAnswer::slides) continue;
    const Eigen::Vector3d& p = solutions_[k].p;
    const Eigen::Vector2d d =
        normal ? Eigen::Vector2d(-p[1], -p[2]) : Eigen::Vector2d(-p[0], -p[1]);
    const double along = d.dot(known) / d.norm();
    if (!(along > nearest)) continue;
    nearest = along;
    out = d / d.norm();
  }
}

// The first directions of the contacts that begin to slide, once each; how far one turns, 0 where
// there is one alone.
double ContactDynamics::turn_first_directions(const ContactStates& states) {
  int several = 0;
  double turns = 0;
  for (int i = 0; i < count(); ++i) {
    const ContactState& state = states[static_cast<size_t>(i)];
    if (!state.begins || state.mode != ContactMode::slides) continue;
    ++several;
    const Eigen::Vector2d before = direction(i);
    if (!law(i).normal) free_acceleration(states, i);
    find_first_direction(states, i);
    if (!law(i).normal) free_acceleration(states);
    turns = std::max(turns, (direction(i) - before).norm());
  }
  return several > 1 ? turns : 0;
}

// d of (5), each beside those of the others until none turns any more, from the ones of the last
// node; then e, with the friction of given loads along it.
void ContactDynamics::find_first_directions(const ContactStates& states) {
  const auto begins = [&](int i) { return states[static_cast<size_t>(i)].begins; };
  bool any = false, given = false;
  for (int i = 0; i < count(); ++i) {
    any = any || begins(i);
    given = given || (begins(i) && !law(i).normal);
  }
  if (!any) return;
  for (int sweep = 0; sweep < kSweeps && turn_first_directions(states) > kTurns; ++sweep) {
  }
  for (int i = 0; i < count(); ++i) {
    if (!begins(i)) continue;
    const auto at = static_cast<size_t>(i);
    first_[at] = directions_[at];
    const Eigen::Vector2d e = slip(i) + states[at].ease * first_[at];
    if (states[at].ease > 0 && e.norm() > 0) directions_[at] = e / e.norm();
  }
  if (given) free_acceleration(states);
}

// The rows that are on and their responses, with directions of slip found and the acceleration
// without them in free_.
void ContactDynamics::set_up(const ContactStates& states) {
  for (int i = 0; i < count(); ++i) find_direction(states, i);
  free_acceleration(states);
  find_first_directions(states);
  on_.clear();
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    normal_[at] = coefficient_[at] = 0;
    tangential_[at].setZero();
    const auto first = static_cast<int>(on_.size());
    add_rows(i, states[at].mode);
    if (law(i).normal && states[at].mode != ContactMode::open)
      coefficient_[at] = row_times(*law(i).normal, responses_.col(first));
  }
}

// Multipliers of the rows that are on as reactions of their contacts.
void ContactDynamics::take_reactions(const ContactStates& states) {
  for (size_t i = 0; i < on_.size(); ++i) {
    const auto at = static_cast<size_t>(on_[i].contact);
    const double multiplier = multipliers_[static_cast<Eigen::Index>(i)];
    const ContactLaw& law = laws_[at];
    if (law.normal == on_[i].row) normal_[at] = multiplier;
    for (int j = 0; j < tangential_count(law); ++j)
      if (law.tangential[static_cast<size_t>(j)] == on_[i].row) tangential_[at][j] = multiplier;
  }
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    if (states[at].mode != ContactMode::slides) continue;
    if (!law(i).normal) normal_[at] = law(i).load;
    tangential_[at] = -law(i).friction * normal_[at] * direction(i);
  }
}

bool ContactDynamics::accelerate(const ContactStates& states) {
  set_up(states);
  const auto m = static_cast<int>(on_.size());
  for (int i = 0; i < m; ++i) {
    const int row = on_[static_cast<size_t>(i)].row;
    multipliers_[i] = rates_[row] - row_times(row, free_);
    for (int j = 0; j < m; ++j) k_work_.data()[i + j * m] = row_times(row, responses_.col(j));
  }
  const bool several = m > 0 && on_.front().contact != on_.back().contact;
  open_ = 0;
  limit_.begin(0);
  if (several) solve_rows(m);
  else if (m > 0) solve_linear(k_work_.data(), multipliers_.data(), m, 1);
  acceleration_ = free_;
  for (int i = 0; i < m; ++i) acceleration_ += multipliers_[i] * responses_.col(i);
  take_reactions(states);
  return acceleration_.allFinite();
}

const Eigen::VectorXd& ContactDynamics::reactions() {
  limit();
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

double ContactDynamics::reaction_power() const {
  double out = 0;
  for (int i = 0; i < count(); ++i) out += friction_power(i);
  return out;
}

}  // namespace hamel
