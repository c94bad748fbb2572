// Branches of steady motions along a parameter.
#include <algorithm>
#include <cmath>
#include <deque>

#include <hamel/framework/analysis/steady.hpp>
#include <hamel/framework/analysis/steady_crossings.hpp>
#include <hamel/framework/analysis/steady_kinds.hpp>

namespace hamel {
namespace {

using namespace reduced;

// Branch over the values: from the first on, or from a place beside a crossing, towards later
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

  SteadySweep result() {
    int zeros = -1;
    for (const auto& node : nodes_) {
      if (!node) continue;
      const int here = branch_.motion(*node, -1).family;
      zeros = zeros < 0 ? here : std::min(zeros, here);
    }
    zeros = std::max(0, zeros);
    Crossings crossings(branch_, zeros);
    std::vector<BranchMotion> run;
    const auto add = [&](const BranchNode& node) {
      run.push_back({node, branch_.motion(node, zeros)});
      return run.back().motion;
    };
    const auto close = [&] {
      for (const FoundCrossing& found : crossings.along(run))
        out_.crossings.push_back(classified(crossings, found, run));
      run.clear();
    };
    for (const auto& node : nodes_) {
      if (node && run.empty() && first_reached_ && !out_.ends.empty()) add(*first_reached_);
      if (!node) {
        if (!run.empty() && last_reached_) add(*last_reached_);
        close();
      }
      out_.motions.push_back(node ? add(*node) : SteadyMotion{});
    }
    close();
    return std::move(out_);
  }

 private:
  long count() const { return static_cast<long>(values_.size()); }

  SteadyCrossing classified(Crossings& crossings, const FoundCrossing& found,
                            const std::vector<BranchMotion>& run) {
    SteadyCrossing out = found.crossing;
    if (out.pair) return out;
    const double from = run.front().node.value, to = run.back().node.value;
    classify(branch_,
             {.near = found.node,
              .first = from,
              .last = to,
              .unstable_above = found.grows == (to > from),
              .on_branch = [&](double value) { return crossings.node_at(value); }},
             out);
    return out;
  }

  void follow(const BranchNode& from, long index, long step) {
    BranchNode here = from;
    for (; index >= 0 && index < count(); index += step) {
      const double value = values_[static_cast<size_t>(index)];
      BranchNode last;
      auto next = branch_.advance(here, value, last);
      if (!next) {
        const auto turn = branch_.turn(last, value);
        if (turn && !turn->turns) next = branch_.advance(turn->behind, value);
        if (!next) {
          (step > 0 ? last_reached_ : first_reached_) = last;
          end(last, value, turn, step > 0);
          return;
        }
      }
      nodes_[static_cast<size_t>(index)] = next;
      here = std::move(*next);
    }
  }

  // Why it went no further than a node.
  void end(const BranchNode& last, double value, const std::optional<Branch::Turn>& turn,
           bool towards_last) {
    SteadyEnd out;
    out.towards_last = towards_last;
    out.value = last.value;
    out.round_off = std::abs(value - last.value);
    if (turn && turn->turns) {
      out.value = turn->at.value;
      out.round_off = turn->round_off;
      out.kind = kind_of_turn(branch_, *turn);
      out.other =
          out.kind == Bifurcation::pitchfork ? main_branch(*turn) : place_of(branch_, turn->behind);
    }
    out_.ends.push_back(std::move(out));
  }

  // The branch of which this one is a half, beside its end, on the side where the half is not.
  std::optional<SteadyPlace> main_branch(const Branch::Turn& turn) {
    const double away = turn.at.value > turn.before.value ? 1 : -1;
    for (double part = 0.02; part > 1e-4; part /= 3) {
      BranchNode node = turn.at;
      node.value += away * part * branch_.scale();
      try {
        const auto there = branch_.equations(node.value);
        node.point = there->at(node.point.g, node.point.xi);
        there->find(node.point, branch_.held(), 20);
      } catch (const ConfigError&) {
        continue;  // out of the parameter's range
      }
      if (node.point.residual < kGood) return place_of(branch_, node);
    }
    return std::nullopt;
  }

  Branch& branch_;
  const std::vector<double>& values_;
  std::vector<std::optional<BranchNode>> nodes_;
  std::optional<BranchNode> first_reached_, last_reached_;  // beside ends
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

// Two branches between the same ends.
bool end_alike(const SteadySweep& a, const SteadySweep& b) {
  if (a.ends.size() != b.ends.size()) return false;
  const double scale = std::abs(a.values.back() - a.values.front());
  for (size_t i = 0; i < a.ends.size(); ++i) {
    const SteadyEnd &one = a.ends[i], &other = b.ends[i];
    const double close = 1e-6 * scale + 10 * (one.round_off + other.round_off);
    if (one.kind != other.kind || one.towards_last != other.towards_last) return false;
    if (!(std::abs(one.value - other.value) < close)) return false;
  }
  return true;
}

// Motions that are equal, or mirror images, wherever both are; of branches between two values,
// those with equal ends.
bool alike(const SteadySweep& a, const SteadySweep& b) {
  bool both = false, any = false;
  for (size_t i = 0; i < a.motions.size(); ++i) {
    any = any || a.motions[i].found || b.motions[i].found;
    if (!a.motions[i].found || !b.motions[i].found) continue;
    if (!alike(a.motions[i], b.motions[i])) return false;
    both = true;
  }
  return any ? both : end_alike(a, b);
}

void add_places(std::deque<SteadyPlace>& to, const SteadySweep& sweep) {
  for (const auto& crossing : sweep.crossings)
    if (crossing.other && crossing.kind != Bifurcation::family) to.push_back(*crossing.other);
  for (const auto& end : sweep.ends)
    if (end.other) to.push_back(*end.other);
}

}  // namespace

SteadySweep sweep_steady(const Registry& registry, const std::vector<double>& values,
                         const std::function<Simulation(double value)>& at, bool others) {
  if (values.empty()) return {};
  Branch branch(registry, at, values.front(), values.back());
  Sweep first(branch, values);
  first.from_start();
  SteadySweep out = first.result();
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
    Sweep sweep(branch, values);
    sweep.from_place(branch.node(place.value, equations->at(g, xi)));
    SteadySweep found = sweep.result();
    bool fresh = !alike(found, out);
    for (const SteadySweep& known : out.branches) fresh = fresh && !alike(found, known);
    if (!fresh) continue;
    add_places(places, found);
    out.branches.push_back(std::move(found));
  }
  return out;
}

}  // namespace hamel
