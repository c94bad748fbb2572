// Modes after a switch, and impacts.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/contact/contact_dynamics.hpp>

namespace hamel {
namespace {

// A rate of slip that is this part of the sum of its terms is round-off.
constexpr double kNoSlip = 1e-10;
// A force that is this part of the largest, or an acceleration, is round-off.
constexpr double kNoForce = 1e-9;

int direction_count(const ContactLaw& law) { return static_cast<int>(law.tangential.size()); }

// Contacts that were tried with static friction, and slide, into `told`. Are there any?
bool let_go(const std::vector<ContactLaw>& laws, const std::vector<ContactBlock>& blocks,
            const std::vector<int>& contacts, const ContactStates& states,
            std::vector<char>& told) {
  bool out = false;
  for (size_t k = 0; k < blocks.size(); ++k) {
    const auto i = static_cast<size_t>(contacts[k]);
    const bool tried = laws[i].holding() > laws[i].friction && blocks[k].tangential > 0;
    if (!tried || states[i].mode != ContactMode::slides) continue;
    told[i] = 1;
    out = true;
  }
  return out;
}

}  // namespace

void ContactDynamics::add_block(int i, bool slides, const Eigen::Vector2d& d) {
  const ContactLaw& law = this->law(i);
  ContactBlock block;
  block.first = static_cast<int>(on_.size());
  block.normal = law.normal.has_value();
  block.friction = slides ? law.friction : law.holding();
  block.bound = block.friction * law.load;
  block.tangential = slides ? 0 : direction_count(law);
  if (block.size() == 0) return;  // a given load that slides is a force
  if (law.normal) {
    if (slides) sliding_row(i, d, column_);
    else column_ = a_.row(*law.normal).transpose();
    respond(static_cast<int>(on_.size()));
    on_.push_back({*law.normal, i});
  }
  for (int j = 0; j < block.tangential; ++j) {
    const int row = law.tangential[static_cast<size_t>(j)];
    respond_to(row, static_cast<int>(on_.size()));
    on_.push_back({row, i});
  }
  blocks_.push_back(block);
  block_contacts_.push_back(i);
}

// Are rows of several contacts dependent? Then their reactions are not determined. Those of given
// loads may be: their problem is that of a convex function, and the motion is unique.
bool ContactDynamics::dependent() {
  if (blocks_.size() < 2) return false;
  const auto missing = [this](bool loads_alone) {
    Eigen::Index m = 0;
    for (const Row& row : on_) {
      if (loads_alone && law(row.contact).normal) continue;
      Eigen::Index k = 0;
      const auto i = &row - on_.data();
      for (size_t j = 0; j < on_.size(); ++j)
        if (!loads_alone || !law(on_[j].contact).normal)
          k_work_(m, k++) = k_(i, static_cast<Eigen::Index>(j));
      ++m;
    }
    if (m == 0) return m;
    auto& rank = problems_[at_end_ ? 1 : 0].rank;
    rank.compute(k_work_.topLeftCorner(m, m));
    rank.setThreshold(1e-10);
    return m - rank.rank();
  };
  const Eigen::Index all = missing(false);
  return all > 0 && all > missing(true);
}

void ContactDynamics::find_metric() {
  const auto m = static_cast<Eigen::Index>(on_.size());
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < m; ++j)
      k_(i, j) = row_times(on_[static_cast<size_t>(i)].row, responses_.col(j));
}

std::string ContactDynamics::solve_problem(const char* level, bool near) {
  const auto m = static_cast<Eigen::Index>(on_.size());
  const auto g = k_.topLeftCorner(m, m);
  const auto c = c_.head(m);
  shared_ = dependent();
  if (shared_ &&
      std::ranges::any_of(block_contacts_, [this](int i) { return !(law(i).share > 0); }))
    return fmt::format(
        "undetermined_reactions: the reactions of {} are not determined by the motion: their rows "
        "are dependent; leave out a contact, or let them share (distribution = "
        "\"equal_compliance\")",
        names_of_blocks());
  auto outcome = ContactProblem::Outcome::one;
  if (shared_) outcome = give_way(static_cast<int>(m), near);
  else if (!near || ConvexContacts::applies(g, blocks_) || !problem().refine(g, c, blocks_))
    outcome = problem().solve(g, c, blocks_);  // (of given loads that with the least sum)
  if (outcome == ContactProblem::Outcome::one) return "";
  const ContactLaw& law = this->law(block_contacts_.front());
  if (blocks_.size() > 1) {
    return fmt::format(
        "jammed: no {} of the contacts {} was found that satisfies Coulomb's law at t = {:.10g}",
        level, names_of_blocks(), time_);
  }
  const int count = problem().count();
  return fmt::format(
      "painleve: {} of contact '{}' {} Coulomb's law at t = {:.10g}, friction = {}, the "
      "coefficient of its normal reaction is {:.4g}: rigid bodies have no unique motion here; a "
      "smaller friction has",
      count > 1 ? fmt::format("{} {}s", count, level) : fmt::format("no {}", level), law.name,
      count > 1 ? "satisfy" : "satisfies", time_, law.friction, k_(0, 0));
}

std::string ContactDynamics::names_of_blocks() const {
  std::vector<std::string> names;
  for (const int i : block_contacts_) names.push_back(law(i).name);
  return fmt::format("{}", fmt::join(names, ", "));
}

bool ContactDynamics::slides_on(ContactState& state, int i, bool told) {
  if (direction_count(law(i)) == 0) {  // a stop: closed, no more
    state.mode = ContactMode::rolls;
    return false;
  }
  const Eigen::Vector2d s = slip(i);
  const bool slips = this->slips(state, i);
  if (state.begins && state.mode != ContactMode::slides) state.begins = false;
  if (slips && !state.begins) state.direction = s / s.norm();
  const bool slides = slips || state.begins || told || law(i).friction == 0;
  if (told && !slips) state.begins = direction_count(law(i)) == 2;
  directions_[static_cast<size_t>(i)] = state.direction;
  if (slides) state.mode = ContactMode::slides;
  return slides;
}

// Has a block of the solution, with rows that depend on others', a slip that is not round-off?
bool ContactDynamics::slips_at(const ContactBlock& block) const {
  const auto m = static_cast<Eigen::Index>(on_.size());
  double slip = 0, size = 0;
  for (Eigen::Index i = block.first + (block.normal ? 1 : 0); i < block.first + block.size(); ++i) {
    double gamma = c_[i], sum = std::abs(c_[i]);
    for (Eigen::Index j = 0; j < m; ++j) {
      gamma += k_(i, j) * problem().p()[j];
      sum += std::abs(k_(i, j) * problem().p()[j]);
    }
    slip = std::max(slip, std::abs(gamma));
    size = std::max(size, sum);
  }
  return slip > kNoSlip * size;
}

// The mode of a contact from the solution of its block.
void ContactDynamics::take_answer(ContactState& state, size_t block) const {
  const ContactBlock& of = blocks_[block];
  const ContactAnswer answer = problem().answers()[block];
  if (direction_count(law(block_contacts_[block])) == 0 && answer != ContactAnswer::opens) return;
  state.mode = answer == ContactAnswer::opens                         ? ContactMode::open
               : answer == ContactAnswer::sticks && of.tangential > 0 ? ContactMode::rolls
                                                                      : ContactMode::slides;
  if (state.mode != ContactMode::slides || of.tangential == 0) return;
  if (shared_ && !slips_at(of)) {  // on its rim, where others hold the rest
    state.mode = ContactMode::rolls;
    return;
  }
  Eigen::Vector2d d(0, 0);
  d.head(of.tangential) = -problem().p().segment(of.first + (of.normal ? 1 : 0), of.tangential);
  if (d.norm() > 0) state.direction = d / d.norm();
  state.begins = of.tangential == 2;
}

// Coulomb's law and (3) of contact i, behind accelerate(), with round-off.
bool ContactDynamics::lawful(const ContactStates& states, int i, double force, double closed) {
  const ContactState& state = states[static_cast<size_t>(i)];
  const double nothing = kNoForce * force;
  if (state.mode == ContactMode::open) {
    if (!law(i).normal || !(gap(i) < closed) || gap_rate(i) > 10 * state.no_slip) return true;
    const auto height = height_of_held(states, i);
    if (height) return *height * law(i).share >= -nothing;
    return gap_acceleration(i) >= -kNoForce * acceleration_scale(i);
  }
  if (law(i).normal && !(normal_reaction(i) >= -nothing)) return false;
  if (state.mode == ContactMode::rolls)
    return law(i).tangential.empty() || hold_left(i) >= -nothing;
  if (law(i).normal && !(coefficient(i) > 0)) return false;
  if (!state.begins) return slips(state, i) || law(i).friction == 0;
  const Eigen::Vector2d s = slip_rate(i);
  const double along = s.dot(state.direction), little = kNoForce * acceleration_scale(i);
  return along >= -little && (s - along * state.direction).norm() <= little;
}

bool ContactDynamics::continue_in(ContactStates& states, double closed) {
  if (!accelerate(states)) return false;
  for (int i = 0; i < count(); ++i)
    if (states[static_cast<size_t>(i)].begins)
      states[static_cast<size_t>(i)].direction = first_direction(i);
  limit();
  double force = 0;
  for (int i = 0; i < count(); ++i)
    force = std::max({force, std::abs(normal_reaction(i)), tangential_reaction(i).norm()});
  bool out = true;
  for (int i = 0; i < count() && out; ++i) out = lawful(states, i, force, closed);
  return out;
}

std::string ContactDynamics::decide(ContactStates& states, const std::vector<char>& slides) {
  at_end_ = false;
  on_.clear();
  blocks_.clear();
  block_contacts_.clear();
  // Of loads that slide the friction is a force; of the others it is an unknown.
  ContactStates forces = states;
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    if (states[at].mode == ContactMode::open) continue;
    const bool known = slides_on(states[at], i, at < slides.size() && slides[at] != 0);
    forces[at] = states[at];
    if (!known) forces[at].mode = ContactMode::open;
  }
  free_acceleration(forces);
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    if (states[at].mode == ContactMode::open) continue;
    add_block(i, forces[at].mode != ContactMode::open, states[at].direction);
  }
  if (blocks_.empty()) return "";
  for (size_t i = 0; i < on_.size(); ++i)
    c_[static_cast<Eigen::Index>(i)] = row_times(on_[i].row, free_) - rates_[on_[i].row];
  find_metric();
  if (std::string why = solve_problem("acceleration"); !why.empty()) return why;
  for (size_t k = 0; k < blocks_.size(); ++k)
    take_answer(states[static_cast<size_t>(block_contacts_[k])], k);
  // Contacts that static friction does not hold slide; the others are decided again beside them.
  std::vector<char> told = slides;
  told.resize(states.size(), 0);
  return let_go(laws_, blocks_, block_contacts_, states, told) ? decide(states, told) : "";
}

// xi <- xi - M_A R^T (R M_A R^T)^-1 (R xi - b).
bool ContactDynamics::project(const std::vector<int>& rows, Eigen::VectorXd& xi) {
  const auto m = static_cast<int>(rows.size());
  for (int j = 0; j < m; ++j) respond_to(rows[static_cast<size_t>(j)], j);
  for (int i = 0; i < m; ++i) {
    const int row = rows[static_cast<size_t>(i)];
    multipliers_[i] = row_times(row, xi) - b_[row];
    for (int j = 0; j < m; ++j) k_work_.data()[i + j * m] = row_times(row, responses_.col(j));
  }
  if (m > 0) pivots_.eliminate(k_map(m), multipliers_.head(m));
  if (!multipliers_.head(m).allFinite()) return false;
  for (int j = 0; j < m; ++j) xi -= multipliers_[j] * responses_.col(j);
  return true;
}

bool ContactDynamics::stop(const ContactStates& states, int i, Eigen::VectorXd& xi) {
  std::vector<int> rows;
  for (int j = 0; j < count(); ++j) {
    const ContactMode mode = states[static_cast<size_t>(j)].mode;
    if (mode == ContactMode::open) continue;
    if (law(j).normal) rows.push_back(*law(j).normal);
    if (mode == ContactMode::rolls || j == i)
      rows.insert(rows.end(), law(j).tangential.begin(), law(j).tangential.end());
  }
  return project(rows, xi);
}

void ContactDynamics::rest(const ContactStates& states, int i, Eigen::VectorXd& xi) {
  const ContactLaw& law = this->law(i);
  const ContactState& state = states[static_cast<size_t>(i)];
  const Eigen::Vector2d s = slip(i);
  if (!slips(state, i)) {
    std::vector<int> rows = {*law.normal};
    rows.insert(rows.end(), law.tangential.begin(), law.tangential.end());
    project(rows, xi);
    return;
  }
  sliding_row(i, s / s.norm(), column_);
  respond(0);
  const double rate = row_times(*law.normal, xi) - b_[*law.normal];
  xi -= rate / row_times(*law.normal, responses_.col(0)) * responses_.col(0);
}

}  // namespace hamel
