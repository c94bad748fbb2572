#include <hamel/systems/mechanisms/programs/lift_programs.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <hamel/framework/graph/number.hpp>
#include <hamel/systems/mechanisms/programs/lift_formulas.hpp>
#include <hamel/systems/mechanisms/programs/recorded_mechanism.hpp>
#include <hamel/systems/mechanisms/programs/step_motion.hpp>

namespace hamel::mechanisms {
namespace {

using Numbers = std::vector<Number>;
using Rows = LiftFormulas::Rows;
using Carried = LiftFormulas::Carried;

constexpr size_t kLongLift = 20'000;  // instructions: machine code of more takes seconds to make

Numbers add_inputs(graph::Recording& recording, size_t count) {
  Numbers out;
  for (size_t i = 0; i < count; ++i)
    out.push_back(recording.input("x" + std::to_string(recording.inputs().size())));
  return out;
}

void append(const Numbers& from, Numbers& to) { to.insert(to.end(), from.begin(), from.end()); }

std::shared_ptr<const graph::Program> program_of(const graph::Recording& recording,
                                                 const Numbers& outputs) {
  graph::Program::Outputs named;
  for (const Number& x : outputs) named.emplace_back("y" + std::to_string(named.size()), x);
  return std::make_shared<graph::Program>(recording, named);
}

}  // namespace

bool has_lift_programs(const MechanismParts& parts, size_t drivers) {
  const bool affine =
      std::ranges::any_of(parts.rows.couplings, [](const Coupling& c) { return c.affine; });
  return !parts.rows.ground.moves() && !parts.rows.ground.height && !affine &&
         parts.rows.agreements.empty() && parts.forces.forces.empty() &&
         parts.forces.motors.size() == drivers;
}

// Records the three programs; each in a recording of its own.
class LiftRecorder {
 public:
  LiftRecorder(const MechanismParts& parts, std::shared_ptr<const LiftLayout> layout,
               std::span<const double> state)
      : parts_(parts), layout_(*layout), at_(parts, layout_) {
    programs_.layout_ = std::move(layout);
    sizes().element = layout_.size();
    sizes().turning = layout_.turning_count();
    sizes().velocities = n();
    sizes().motors = parts.forces.motors.size();
    sizes().rates = parts.rows.prescribed.size();
    for (const Prescribed& p : parts.rows.prescribed) sizes().held += p.held >= 0;
    sizes().holonomic = static_cast<size_t>(parts.holonomic);
    for (const auto& place : states_near(parts, state)) {
      std::vector<double>& numbers = places_.emplace_back(layout_.size());
      layout_.unpack(place.data(), numbers.data());
      numbers.insert(numbers.end(), state.begin() + parts.tree.size(),
                     state.begin() + parts.tree.size() + parts.tree.dim());
    }
  }

  bool run(size_t unknowns) {
    if (!record_start() || !record_residual(unknowns) || !record_end()) return false;
    find_pivots();
    return true;
  }
  std::shared_ptr<const LiftPrograms> programs() const {
    return std::make_shared<LiftPrograms>(programs_);
  }

 private:
  LiftSizes& sizes() { return programs_.sizes_; }
  size_t n() const { return static_cast<size_t>(parts_.tree.dim()); }
  size_t phi_from() const { return parts_.kept.size() - static_cast<size_t>(parts_.holonomic); }

  // Pivots of a program at the first place.
  std::vector<double> pivots_of(const graph::Code& code, size_t v_at, size_t first,
                                size_t count) const {
    std::vector<double> x(code.program().inputs().size()), work(code.work_size()),
        y(code.program().outputs().size());
    const std::vector<double>& place = places_.front();
    const auto element = place.begin() + static_cast<std::ptrdiff_t>(layout_.size());
    std::copy(place.begin(), element, x.begin());
    std::copy(element, place.end(), x.begin() + static_cast<std::ptrdiff_t>(v_at));
    code(x.data(), y.data(), work.data());
    const auto at = y.begin() + static_cast<std::ptrdiff_t>(first);
    return {at, at + static_cast<std::ptrdiff_t>(count)};
  }
  void find_pivots() {
    const LiftSizes& size = programs_.sizes_;
    programs_.node_pivots_ = pivots_of(*programs_.start_, size.element,
                                       size.carried() + size.independent, size.node_pivots);
    programs_.middle_pivots_ =
        pivots_of(*programs_.residual_, size.residual_inputs() - size.velocities,
                  size.independent + size.rows + size.holonomic, size.middle_pivots);
  }

  // Values of the inputs at the places: the element and v where they are, else 0.
  std::vector<Sample> samples(size_t inputs, size_t element_at, size_t v_at) const {
    std::vector<Sample> out;
    for (const std::vector<double>& place : places_) {
      std::vector<double> values(inputs);
      const auto element = place.begin() + static_cast<std::ptrdiff_t>(layout_.size());
      std::copy(place.begin(), element, values.begin() + static_cast<std::ptrdiff_t>(element_at));
      std::copy(element, place.end(), values.begin() + static_cast<std::ptrdiff_t>(v_at));
      out.emplace_back(std::move(values));
    }
    return out;
  }
  void append_carried(const Carried& carried, const Frame& frame, Numbers& out) const {
    append(carried.momentum, out);
    append(carried.force, out);
    out.push_back(carried.energy);
    out.push_back(carried.force_size);
    for (const auto& [row, column] : moving_) out.push_back(frame.e[row][column]);
  }
  static std::vector<Numbers> coefficients(const Rows& rows) {
    std::vector<Numbers> out;
    for (const RecordedRow& row : rows) out.push_back(row.coefficients);
    return out;
  }
  static Numbers drifts(const Rows& rows) {
    Numbers out;
    for (const RecordedRow& row : rows) out.push_back(row.drift);
    return out;
  }
  std::shared_ptr<const graph::Code> code_of(const graph::Recording& recording,
                                             const Numbers& outputs) const {
    const auto program = program_of(recording, outputs);
    if (program->instructions().size() > kLongLift) return nullptr;
    return std::make_shared<graph::Code>(program);
  }

  bool record_start() {
    graph::Recording recording;
    const Numbers g = add_inputs(recording, layout_.size()), xi = add_inputs(recording, n()),
                  motors = add_inputs(recording, sizes().motors),
                  rates = add_inputs(recording, sizes().rates);
    const BodyFormulas here = at_.bodies(g, Numbers(n()));
    const Rows at = at_.rows(here, g, xi, rates, {});
    Frame frame = free_frame(n());
    if (!at.empty()) {
      std::vector<Sample> places = samples(recording.inputs().size(), 0, layout_.size());
      frame = eliminate(coefficients(at), drifts(at), places, /*lasting=*/true);
    }
    order_ = frame.order;
    pattern_ = frame.e;
    for (size_t column = 0; column < frame.independent.size(); ++column)
      for (size_t row = 0; row < n(); ++row)
        if (!frame.e[row][column].constant()) moving_.emplace_back(row, column);
    sizes().independent = frame.independent.size();
    sizes().moving = moving_.size();
    sizes().node_pivots = frame.pivots.size();
    const BodyFormulas::Matrix inertia = here.inertia();
    Numbers mu;
    for (const Numbers& row : inertia) mu.push_back(sum_of_products(row, xi));
    const Carried carried = at_.carry(here, frame, mu, at_.still_force(here, g, motors), &xi);
    Numbers out;
    append_carried(carried, frame, out);
    append(carried.diagonal, out);
    append(frame.pivots, out);
    programs_.start_ = code_of(recording, out);
    return programs_.start_ != nullptr;
  }

  bool record_residual(size_t unknowns) {
    graph::Recording recording;
    const Numbers g = add_inputs(recording, layout_.size());
    const Number h = add_inputs(recording, 1)[0];
    add_inputs(recording, sizes().motors + sizes().rates);  // of the end
    const Numbers moving = add_inputs(recording, moving_.size()),
                  target = add_inputs(recording, sizes().independent),
                  rates = add_inputs(recording, sizes().rates),
                  held = add_inputs(recording, sizes().held);
    const size_t first = recording.inputs().size();
    const Numbers x = add_inputs(recording, n()), any = add_inputs(recording, n());
    const Eliminated middle = eliminate_middle(g, h, x, any, rates, first, unknowns);
    const size_t pivots = middle.order.size();
    sizes().unknowns = n() - pivots;
    sizes().rows = middle.left.size();
    sizes().middle_pivots = middle.pivots.size();
    if (unknowns != 0 && sizes().unknowns != unknowns) return false;
    if (sizes().unknowns > LiftPrograms::kMostUnknowns ||
        sizes().unknowns != sizes().independent + sizes().rows + sizes().holonomic)
      return false;
    Numbers v = x;
    middle.complete(v);
    programs_.unknowns_.clear();
    for (size_t i = 0; i < n(); ++i)
      if (std::ranges::none_of(middle.order, [i](const Pivot& p) { return p.second == i; }))
        programs_.unknowns_.push_back(static_cast<int>(i));

    StepMotion step(layout_, g, v, h);
    auto [p, nu] = at_.bodies(step.middle(), v).momentum();
    for (Number& effort : nu) effort *= h;
    auto [mu0, mu1] = step.momenta(p, nu);
    const Numbers damped = at_.damping(g, v);
    for (size_t i = 0; i < n(); ++i) mu0[i] -= 0.5 * h * damped[i];
    Numbers out;
    for (size_t j = 0; j < sizes().independent; ++j) {
      Number sum = -target[j];
      for (size_t i = 0; i < n(); ++i) {
        const auto at = std::ranges::find(moving_, std::pair(i, j));
        const Number e = at == moving_.end() ? pattern_[i][j]
                                             : moving[static_cast<size_t>(at - moving_.begin())];
        sum += e * mu0[i];
      }
      out.push_back(sum);
    }
    for (const size_t i : middle.left) {
      Number sum = -middle.c[i];
      for (const int k : programs_.unknowns_)
        sum += middle.a[i][static_cast<size_t>(k)] * v[static_cast<size_t>(k)];
      out.push_back(sum);
    }
    if (sizes().holonomic > 0) {
      const BodyFormulas there = at_.bodies(step.end(), Numbers(n()));
      const Rows at = at_.rows(there, step.end(), any, rates, held);
      for (size_t i = phi_from(); i < at.size(); ++i) out.push_back(at[i].phi);
    }
    append(middle.pivots, out);
    for (const LiftLayout::Part& one : layout_.parts()) {
      if (one.kind != LiftLayout::Kind::turning) continue;
      out.push_back(step.end()[static_cast<size_t>(one.first) + 1]);
      out.push_back(step.end()[static_cast<size_t>(one.first) + 2]);
    }
    append(mu1, out);
    append(v, out);
    const auto program = program_of(recording, out);
    if (program->instructions().size() > kLongLift) return false;
    programs_.residual_ = std::make_shared<graph::Code>(program);
    programs_.lanes_ = std::make_shared<graph::Code>(program, LiftPrograms::kLanes);
    return true;
  }

  // The rows of velocities at the middle, eliminated with pivots among those velocities that no
  // coefficient depends on. first: of v among the inputs.
  Eliminated eliminate_middle(const Numbers& g, const Number& h, const Numbers& x,
                              const Numbers& any, const Numbers& rates, size_t first,
                              size_t unknowns) const {
    const StepMotion step(layout_, g, x, h);
    Rows at = at_.rows(at_.bodies(step.middle(), Numbers(n())), step.middle(), any, rates, {});
    at.resize(phi_from());
    Numbers depends = drifts(at);
    for (const RecordedRow& row : at) append(row.coefficients, depends);
    const std::vector<bool> shapes = inputs_of(depends);
    std::vector<bool> allowed(n());
    for (size_t i = 0; i < n(); ++i) allowed[i] = !shapes[first + i];
    std::vector<Sample> places = samples(graph::Recording::current().inputs().size(), 0, first);
    const size_t most = unknowns == 0 ? at.size() : n() - std::min(unknowns, n()),
                 least = unknowns == 0 ? 0 : most;
    return eliminate_some(coefficients(at), drifts(at), places, allowed, least, most);
  }

  bool record_end() {
    graph::Recording recording;
    const Numbers turned = add_inputs(recording, 2 * sizes().turning),
                  mu1 = add_inputs(recording, n()), v = add_inputs(recording, n()),
                  g = add_inputs(recording, layout_.size());
    const Number h = add_inputs(recording, 1)[0];
    const Numbers motors = add_inputs(recording, sizes().motors),
                  rates = add_inputs(recording, sizes().rates);
    StepMotion step(layout_, g, v, h);
    Numbers& end = step.end();
    size_t next = 0;
    for (const LiftLayout::Part& one : layout_.parts()) {
      if (one.kind != LiftLayout::Kind::turning) continue;
      end[static_cast<size_t>(one.first) + 1] = turned[next++];
      end[static_cast<size_t>(one.first) + 2] = turned[next++];
    }
    const BodyFormulas there = at_.bodies(end, Numbers(n()));
    const Rows at = at_.rows(there, end, v, rates, {});
    const Frame frame =
        at.empty() ? free_frame(n()) : eliminate(coefficients(at), drifts(at), order_);
    if (frame.pivots.size() != sizes().node_pivots) return false;
    for (size_t i = 0; i < n(); ++i)  // as at the start
      for (size_t j = 0; j < sizes().independent; ++j)
        if (pattern_[i][j].constant() && !frame.e[i][j].is(pattern_[i][j].value())) return false;
    const Numbers still = at_.still_force(there, end, motors), damped = at_.damping(end, v);
    Numbers mu = mu1;
    for (size_t i = 0; i < n(); ++i) mu[i] += 0.5 * h * (still[i] + damped[i]);
    const Carried carried = at_.carry(there, frame, mu, still, nullptr);
    Numbers out = end;
    append(carried.xi, out);
    append_carried(carried, frame, out);
    append(frame.pivots, out);
    programs_.end_ = code_of(recording, out);
    return programs_.end_ != nullptr;
  }

  const MechanismParts& parts_;
  const LiftLayout& layout_;
  LiftFormulas at_;
  LiftPrograms programs_;
  std::vector<std::vector<double>> places_;  // element and xi
  std::vector<Pivot> order_;                 // of the frame at nodes
  std::vector<Numbers> pattern_;             // E, of which constants are read alone
  std::vector<std::pair<size_t, size_t>> moving_;
};

std::shared_ptr<const LiftPrograms> LiftPrograms::record(const MechanismParts& parts,
                                                         std::shared_ptr<const LiftLayout> layout,
                                                         std::span<const double> state,
                                                         size_t unknowns) {
  try {
    LiftRecorder recorder(parts, std::move(layout), state);
    return recorder.run(unknowns) ? recorder.programs() : nullptr;
  } catch (const std::domain_error&) {
    return nullptr;
  }
}

}  // namespace hamel::mechanisms
