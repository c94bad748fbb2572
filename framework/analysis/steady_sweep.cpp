// Branches of steady motions along a parameter.
#include <algorithm>
#include <cmath>
#include <deque>

#include <hamel/framework/analysis/steady.hpp>
#include <hamel/framework/analysis/steady_crossings.hpp>

namespace hamel {
namespace {

using namespace reduced;

// One branch over the values: from the first on, or from a place beside a crossing, towards later
// or earlier values.
class Sweep {
 public:
  Sweep(Branch& branch, const std::vector<double>& values) : branch_(branch), values_(values) {
    nodes_.resize(values.size());
    out_.values = values;
  }

  void from_start() {
    size_t first = 0;
    for (; first < values_.size(); ++first) {
      nodes_[first] = branch_.start(values_[first]);
      if (nodes_[first]) break;
    }
    if (first < values_.size()) {
      follow(*nodes_[first], static_cast<long>(first) + 1, 1);
      const auto backwards = *nodes_[first];
      follow(backwards, static_cast<long>(first) - 1, -1);
    }
  }
  // Both ways, as far as it goes.
  void from_place(const BranchNode& node) {
    out_.start = place_of(branch_, node);
    const bool rising = values_.back() > values_.front();
    long next = 0;
    while (next < count() && (values_[static_cast<size_t>(next)] < node.value) == rising) ++next;
    follow(node, next, 1);
    follow(node, next - 1, -1);
  }

  SteadySweep result(int family) {
    const auto motion_at = [&](const BranchNode& node, int zeros) {
      return branch_.equations(node.value)->motion(node.point, zeros);
    };
    int zeros = family;
    for (const auto& node : nodes_) {
      if (!node) continue;
      const int here = motion_at(*node, -1).family;
      zeros = zeros < 0 ? here : std::min(zeros, here);
    }
    Crossings crossings(branch_, std::max(0, zeros));
    std::optional<BranchMotion> before;
    for (const auto& node : nodes_) {
      SteadyMotion motion;
      std::optional<BranchMotion> here;
      if (node) {
        motion = motion_at(*node, std::max(0, zeros));
        here = BranchMotion{*node, motion};
      }
      if (before && here) {
        for (auto& crossing : crossings.between(*before, *here)) out_.crossings.push_back(crossing);
      }
      out_.motions.push_back(std::move(motion));
      before = std::move(here);
    }
    return std::move(out_);
  }

 private:
  long count() const { return static_cast<long>(values_.size()); }

  void follow(const BranchNode& from, long index, long step) {
    BranchNode here = from;
    for (; index >= 0 && index < count(); index += step) {
      const double value = values_[static_cast<size_t>(index)];
      BranchNode last;
      auto next = branch_.advance(here, value, last);
      if (!next) {
        if (step > 0 || !out_.end) end(last, value);
        return;
      }
      nodes_[static_cast<size_t>(index)] = next;
      here = std::move(*next);
    }
  }

  // Why it went no further than a node.
  void end(const BranchNode& last, double value) {
    SteadyEnd& out = out_.end.emplace();
    out.value = last.value;
    out.round_off = std::abs(value - last.value);
    const auto turn = branch_.turn(last, value);
    if (!turn) return;
    out.value = turn->at.value;
    out.round_off = turn->round_off;
    const bool held = branch_.held();
    const auto there = branch_.equations(out.value);
    // At a fold F_q is not in the range of F_z; where it is, another branch passes.
    const Matrix range = range_of(there->slope(turn->at.point, held), 1e-5);
    const Vector by_value = branch_.by_value(turn->at);
    const Vector left = by_value - range * (range.transpose() * by_value);
    const bool passes = left.norm() < 1e-3 * by_value.norm() || by_value.norm() < 1e-12;
    out.kind = passes ? Bifurcation::pitchfork : Bifurcation::fold;
    if (!passes) {
      out.other = place_of(branch_, turn->behind);
      return;
    }
    const Eigen::Index z = turn->at.tangent.size() - 1;
    Vector ahead = Vector::Unit(z + 1, z);
    ahead = branch_.node(out.value, turn->at.point, ahead).tangent;
    const double sign = (value > out.value) == (ahead[z] > 0) ? 1 : -1;
    if (const auto on = branch_.beside(turn->at, sign * 0.02 * ahead))
      out.other = place_of(branch_, *on);
  }

  Branch& branch_;
  const std::vector<double>& values_;
  std::vector<std::optional<BranchNode>> nodes_;
  SteadySweep out_;
};

bool alike(const SteadyMotion& a, const SteadyMotion& b) {
  if (!a.found || !b.found || a.eigenvalues.size() != b.eigenvalues.size()) return false;
  for (size_t i = 0; i < a.eigenvalues.size(); ++i) {
    const double close = 1e-6 + 10 * (a.round_off[i] + b.round_off[i]);
    if (!(std::abs(a.eigenvalues[i] - b.eigenvalues[i]) < close)) return false;
  }
  return true;
}

// The same motions, or their mirror images, wherever both are.
bool alike(const SteadySweep& a, const SteadySweep& b) {
  bool both = false;
  for (size_t i = 0; i < a.motions.size(); ++i) {
    if (!a.motions[i].found || !b.motions[i].found) continue;
    if (!alike(a.motions[i], b.motions[i])) return false;
    both = true;
  }
  return both;
}

void add_places(std::deque<SteadyPlace>& to, const SteadySweep& sweep) {
  for (const auto& crossing : sweep.crossings)
    if (crossing.other && crossing.kind != Bifurcation::family) to.push_back(*crossing.other);
  if (sweep.end && sweep.end->other) to.push_back(*sweep.end->other);
}

}  // namespace

SteadySweep sweep_steady(const Registry& registry, const std::vector<double>& values,
                         const std::function<Simulation(double value)>& at, bool others) {
  if (values.empty()) return {};
  Branch branch(registry, at, values.front(), values.back());
  Sweep first(branch, values);
  first.from_start();
  SteadySweep out = first.result(-1);
  if (!others) return out;
  constexpr size_t most = 20;  // branches
  std::deque<SteadyPlace> places;
  add_places(places, out);
  for (; !places.empty() && out.branches.size() < most; places.pop_front()) {
    const SteadyPlace place = places.front();
    const auto equations = branch.equations(place.value);
    Vector g(equations->geometry().size());
    equations->geometry().from_coordinates(place.element, g.data());
    const Vector xi = Eigen::Map<const Vector>(place.velocity.data(), equations->dim());
    const Vector sense = Vector::Unit(2 * equations->dim() + 1, 2 * equations->dim());
    Sweep sweep(branch, values);
    sweep.from_place(branch.node(place.value, equations->at(g, xi), sense));
    SteadySweep found = sweep.result(-1);
    bool fresh = std::any_of(found.motions.begin(), found.motions.end(),
                             [](const SteadyMotion& motion) { return motion.found; });
    fresh = fresh && !alike(found, out);
    for (const SteadySweep& known : out.branches) fresh = fresh && !alike(found, known);
    if (!fresh) continue;
    add_places(places, found);
    out.branches.push_back(std::move(found));
  }
  return out;
}

}  // namespace hamel
