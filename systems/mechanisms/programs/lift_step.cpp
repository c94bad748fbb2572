#include <hamel/systems/mechanisms/programs/lift_step.hpp>

#include <algorithm>
#include <utility>

namespace hamel::mechanisms {
namespace {
constexpr double kLostPivotOfStep = 0.1;  // of its first value
constexpr double kGoodPivotOfStep = 0.5;
constexpr size_t kMostRecorded = 64;

bool holds(const double* pivots, const std::vector<double>& first) {
  for (size_t i = 0; i < first.size(); ++i)
    if (!(pivots[i] * first[i] >= kLostPivotOfStep * first[i] * first[i])) return false;
  return true;
}
// Tests their sizes alone.
bool hold(const double* pivots, const std::vector<double>& first) {
  for (size_t i = 0; i < first.size(); ++i)
    if (!(std::abs(pivots[i]) >= kLostPivotOfStep * std::abs(first[i]))) return false;
  return true;
}
std::vector<double> sized_as(std::vector<double> sizes, const double* signs) {
  for (double& x : sizes) x = std::copysign(x, *signs++);
  return sizes;
}
bool are_good(const double* pivots, const std::vector<double>& first) {
  for (size_t i = 0; i < first.size(); ++i)
    if (!(std::abs(pivots[i]) >= kGoodPivotOfStep * std::abs(first[i]))) return false;
  return true;
}
}  // namespace

LiftWork::LiftWork(LiftProblem problem, std::shared_ptr<const Multibody> system,
                   std::shared_ptr<const LiftPrograms> programs)
    : problem_(std::move(problem)),
      system_(std::move(system)),
      carried_(static_cast<size_t>(problem_.state_size())),
      constant_inputs_(system_->autonomous()),
      a_(problem_.constraint_count(), problem_.dim()),
      b_(problem_.constraint_count()) {
  use({std::move(programs), {}, {}, {}});
}

void LiftWork::use(Recorded recorded) {
  now_ = std::move(recorded);
  programs_ = now_.programs;
  const LiftSizes& size = sizes();
  given_ = size.independent + size.rows + size.holonomic + size.middle_pivots;
  element_ = given_ + size.given();
  moving_ = element_ + size.element + 1 + size.motors + size.rates;
  target_ = moving_ + size.moving;
  middle_rates_ = target_ + size.independent;
  held_ = middle_rates_ + size.rates;
  v_ = held_ + size.held;
  block_.assign(v_ + 2 * size.velocities, 0.0);
  out_.assign(size.element + size.velocities + size.carried() + size.node_pivots, 0.0);
  start_.assign(size.element + size.velocities + size.motors + size.rates + size.carried() +
                    size.independent + size.node_pivots,
                0.0);
  work_.resize(std::max({programs_->start().work_size(), programs_->residual().work_size(),
                         programs_->end().work_size(), work_.size()}));
  lanes_in_.resize(LiftPrograms::kLanes * (block_.size() - element_));
  lanes_out_.resize(LiftPrograms::kLanes * programs_->residual().program().outputs().size());
  lanes_work_.resize(std::max(lanes_work_.size(), programs_->lanes().work_size()));
  fresh_ = true;
  known_ += 1;
}

// Inputs of the run at the end and the middle of the step.
void LiftWork::find_inputs(double t, double h) {
  double* out = block_.data() + element_ + sizes().element + 1;
  for (const Motor& motor : system_->forces().motors) *out++ = motor.effort({t + h, {}, {}, {}});
  double* middle = block_.data() + middle_rates_;
  for (const Prescribed& p : system_->all_rows().prescribed) {
    *out++ = p.rate(t + h);
    *middle++ = p.rate(t + h / 2);
  }
}

// Finds what the node carries from its velocity, where it does not know.
void LiftWork::find_carried(const Node& node) const {
  const LiftSizes& size = sizes();
  std::copy_n(node.g.data(), size.element, start_.data());
  std::copy_n(node.x.data(), size.velocities, start_.data() + size.element);
  double* given = start_.data() + size.element + size.velocities;
  for (const Motor& motor : system_->forces().motors) *given++ = motor.effort({node.t, {}, {}, {}});
  for (const Prescribed& p : system_->all_rows().prescribed) *given++ = p.rate(node.t);
  programs_->start()(start_.data(), given, work_.data());
  std::copy_n(given, size.carried(), carried_.data());
}

// Behind find_carried().
const double* LiftWork::node_pivots() const {
  return start_.data() + start_.size() - sizes().node_pivots;
}
const double* LiftWork::middle_pivots() const {
  return block_.data() + given_ - sizes().middle_pivots;
}

// Scales of the residuals at a node.
void LiftWork::find_weights(const Node& node) {
  const LiftSizes& size = sizes();
  const double* diagonal = node_pivots() - size.independent;
  std::vector<double>& weights = now_.weights;
  weights.assign(size.unknowns, 1.0);
  for (size_t i = 0; i < size.independent; ++i)
    weights[i] = diagonal[i] > 0 ? 1 / std::sqrt(diagonal[i]) : 1;
  if (size.rows + size.holonomic == 0) return;
  Metric<> place(problem_);
  place.set(problem_, node.t, node.g);
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(problem_.constraint_count()), xi(problem_.dim());
  const auto weight = [&](Eigen::Index row) {
    unit.setZero();
    unit[row] = 1;
    return std::sqrt(place.smallest(unit, xi));
  };
  const Eigen::Index held = problem_.holonomic_rows(), before = unit.size() - held;
  const size_t first = size.independent + size.rows;
  double largest = 0;
  for (Eigen::Index i = 0; i < before; ++i) largest = std::max(largest, weight(i));
  for (size_t i = size.independent; i < first; ++i) weights[i] = largest;
  for (Eigen::Index i = 0; i < held; ++i)
    weights[first + static_cast<size_t>(i)] = weight(before + i);
}

// At a node where a pivot is lost: programs of before, whose pivots are good there, or new ones.
void LiftWork::change_programs(const Node& node) {
  lost_ = false;
  const Recorded last = now_;
  for (const Recorded& one : before_) {
    if (one.programs == last.programs) continue;
    use(one);
    measure(node, 0);
    if (are_good(node_pivots(), one.node_pivots) && are_good(middle_pivots(), one.middle_pivots)) {
      now_.node_pivots = sized_as(one.node_pivots, node_pivots());
      now_.middle_pivots = sized_as(one.middle_pivots, middle_pivots());
      fresh_ = false;
      if (changed_) changed_();
      return;
    }
  }
  auto programs = system_->lift_programs(
      problem_.packed(node.g).data(), node.x.head(problem_.dim()), last.programs->sizes().unknowns);
  if (programs == nullptr) return use(last);
  use({std::move(programs), {}, {}, {}});
  if (changed_) changed_();
}

// The pivots of the programs at a node.
void LiftWork::measure(const Node& node, double h) {
  find_carried(node);
  find_held(node);
  find_inputs(node.t, h);
  put_in(node, carried_.data(), h);
  std::copy_n(node.x.data(), sizes().velocities, block_.data() + v_);
  programs_->residual()(block_.data() + element_, block_.data(), work_.data());
}

// Coordinates at which joints are held.
void LiftWork::find_held(const Node& node) {
  if (sizes().held == 0) return;
  const Tree& tree = system_->tree(problem_.packed(node.g).data());
  double* held = block_.data() + held_;
  for (const Prescribed& p : system_->all_rows().prescribed) {
    if (p.held < 0) continue;
    const Joint& joint = tree.joint(p.held);
    const double* element = tree.placed(p.held);
    *held++ = joint.coordinate(element) - ConstraintRows::beyond(p, joint, element);
  }
}

void LiftWork::put_in(const Node& node, const double* carried, double h) {
  const LiftSizes& size = sizes();
  double* b = block_.data();
  std::copy_n(node.g.data(), size.element, b + element_);
  b[element_ + size.element] = h;
  const double *momentum = carried, *force = momentum + size.independent,
               *rest = force + size.independent;
  for (size_t i = 0; i < size.independent; ++i) b[target_ + i] = momentum[i] + 0.5 * h * force[i];
  two_energy_ = rest[0];
  force_size_ = rest[1];
  std::copy_n(rest + 2, size.moving, b + moving_);
}

void LiftWork::take_up(const Node& node, double h) {
  if (lost_) [[unlikely]]
    change_programs(node);
  from_ = &node;
  h_ = h;
  if (fresh_) [[unlikely]] {
    measure(node, h);
    if (!hold(node_pivots(), programs_->node_pivots()) ||
        !hold(middle_pivots(), programs_->middle_pivots())) {  // of another place
      auto programs = system_->lift_programs(problem_.packed(node.g).data(),
                                             node.x.head(problem_.dim()), sizes().unknowns);
      if (programs != nullptr) {
        use({std::move(programs), {}, {}, {}});
        measure(node, h);
      }
    }
    find_weights(node);
    now_.node_pivots = sized_as(programs_->node_pivots(), node_pivots());
    now_.middle_pivots = sized_as(programs_->middle_pivots(), middle_pivots());
    if (before_.size() < kMostRecorded) before_.push_back(now_);
    fresh_ = false;
  }
  const double* carried = node.x.data() + sizes().velocities + 1;
  if (carried[-1] != known_) [[unlikely]] {
    find_carried(node);
    carried = carried_.data();
    find_held(node);
    find_inputs(node.t, h);
  } else if (!constant_inputs_) {
    find_inputs(node.t, h);
  }
  put_in(node, carried, h);
}

double LiftWork::scale_of_step() const {
  const double size =
      2 * std::sqrt(std::max(two_energy_, 0.0)) + std::abs(h_) * std::sqrt(force_size_);
  return size > 0 ? size * size : problem_.dim();
}

void LiftWork::evaluate(const double* x) const {
  double* v = block_.data() + v_;
  for (const int i : programs_->unknowns()) v[i] = *x++;
  programs_->residual()(block_.data() + element_, block_.data(), work_.data());
}

const double* LiftWork::shift(const double* x, Eigen::Index first, Eigen::Index count,
                              double* shifts) const {
  constexpr size_t lanes = LiftPrograms::kLanes;
  const std::vector<int>& unknowns = programs_->unknowns();
  double* v = block_.data() + v_;
  for (size_t i = 0; i < unknowns.size(); ++i) v[unknowns[i]] = x[i];
  for (size_t i = element_; i < block_.size(); ++i)
    std::fill_n(lanes_in_.data() + lanes * (i - element_), lanes, block_[i]);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto i = static_cast<size_t>(unknowns[static_cast<size_t>(first + k)]);
    const double here = x[first + k], there = here + 1e-7 * (1 + std::abs(here));
    shifts[k] = there - here;
    lanes_in_[lanes * (v_ - element_ + i) + static_cast<size_t>(k)] = there;
  }
  programs_->lanes()(lanes_in_.data(), lanes_out_.data(), lanes_work_.data());
  return lanes_out_.data();
}

bool LiftWork::reach(Node& next) const {
  const LiftSizes& size = sizes();
  programs_->end()(block_.data() + given_, out_.data(), work_.data());
  const double* out = out_.data();
  std::copy_n(out, size.element, next.g.data());
  problem_.layout().count_turns(from_->g.data(), block_.data() + element_ - size.velocities, h_,
                                next.g.data());
  out += size.element;
  double* x = next.x.data();
  std::copy_n(out, size.velocities, x);
  x[size.velocities] = known_;
  out += size.velocities;
  std::copy_n(out, size.carried(), x + size.velocities + 1);
  next.t = from_->t + h_;
  if (!holds(middle_pivots(), now_.middle_pivots) || !holds(out + size.carried(), now_.node_pivots))
      [[unlikely]]
    lost_ = true;
  return true;
}

double LiftWork::row_size(size_t i) const {
  if (i == 0) problem_.constraints(from_->t, from_->g, a_, b_);
  return a_.row(a_.rows() - problem_.holonomic_rows() + static_cast<Eigen::Index>(i)).lpNorm<1>();
}

}  // namespace hamel::mechanisms
