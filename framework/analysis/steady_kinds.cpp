#include <hamel/framework/analysis/steady_kinds.hpp>

#include <algorithm>
#include <cmath>

namespace hamel::reduced {

SteadyPlace place_of(Branch& branch, const BranchNode& node) {
  SteadyPlace out{.value = node.value, .element = {}, .velocity = {}};
  const auto equations = branch.equations(node.value);
  const Geometry& geometry = equations->geometry();
  out.element.resize(static_cast<size_t>(geometry.columns()));
  geometry.coordinates(node.point.g.data(), out.element.data());
  out.velocity.assign(node.point.xi.begin(), node.point.xi.end());
  return out;
}

namespace {

class Classification {
 public:
  Classification(Branch& branch, const RealCrossing& real, SteadyCrossing& crossing)
      : branch_(branch), real_(real), crossing_(crossing) {}

  Bifurcation kind() {
    const auto sets = nodes_around();
    if (sets.size() < 2) return Bifurcation::undecided;
    BranchNode at = real_.near;
    at.value = crossing_.value;
    BifurcationEquation equation(branch_, at, sets.front());
    if (equation.kernel() == 0) return Bifurcation::none;
    if (equation.kernel() == 1) equation.centre(sets, crossing_.round_off);
    if (equation.kernel() != 1) return Bifurcation::undecided;
    const std::vector<BranchNode>& beside = sets.front();
    equation.expand(beside[1]);
    turning_ = (equation.slope_at(beside[2]) - equation.slope_at(beside[1])) /
               (beside[2].value - beside[1].value);
    const Estimate b = equation.quadratic(), c = equation.cubic();
    if (b.is_nonzero()) {
      find_other(equation, [&](double dq) { return -2 * turning_ / b.value * dq; });
      return Bifurcation::transcritical;
    }
    if (equation.quadratic_is_covered() && c.is_nonzero()) {
      const double side = -c.value / turning_ > 0 ? 1 : -1;
      crossing_.supercritical = (side > 0) == real_.unstable_above;
      find_other(equation, [&](double dq) {
        return dq * side > 0 ? std::sqrt(std::abs(6 * turning_ / c.value * dq)) : 0.0;
      });
      return Bifurcation::pitchfork;
    }
    const bool nothing = b.is_zero() && c.is_zero();
    return nothing && is_family(equation) ? Bifurcation::family : Bifurcation::undecided;
  }

 private:
  double room() const {
    return std::min(std::abs(crossing_.value - real_.first),
                    std::abs(real_.last - crossing_.value));
  }

  // Four nodes each, at distances h and 2h on both sides, the farthest first.
  std::vector<std::vector<BranchNode>> nodes_around() const {
    std::vector<std::vector<BranchNode>> out;
    const double span = std::abs(real_.last - real_.first);
    double h = std::min(0.05 * span, 0.49 * room());
    for (int k = 0; k < 5 && h > 1e3 * crossing_.round_off; ++k, h /= 4) {
      std::vector<BranchNode> nodes;
      for (const double shift : {-2 * h, -h, h, 2 * h})
        if (const auto node = real_.on_branch(crossing_.value + shift)) nodes.push_back(*node);
      if (nodes.size() == 4) out.push_back(std::move(nodes));
    }
    return out;
  }

  // A motion on the branch that crosses this one, a place `along` v from it at values beside the
  // crossing.
  template <class Along>
  void find_other(const BifurcationEquation& equation, Along&& along) {
    const double span = std::abs(real_.last - real_.first);
    double size = std::min(0.02 * span, 0.9 * room());
    for (int k = 0; k < 8 && size > 1e3 * crossing_.round_off; ++k, size /= 3) {
      for (const double dq : {size, -size}) {
        const double s = along(dq);
        const auto from = s == 0 ? std::nullopt : real_.on_branch(crossing_.value + dq);
        if (!from) continue;
        BranchNode node = *from;
        node.point = equation.displaced(*from, from->value, s);
        branch_.equations(node.value)->find(node.point, branch_.held(), 20);
        const double part = (equation.place_of(node) - equation.place_of(*from)) / s;
        if (!(node.point.residual < kGood && part > 0.5 && part < 2)) continue;
        crossing_.other = reduced::place_of(branch_, node);
        return;
      }
    }
  }

  // Motions at a distance along v, on both sides, at the value of the crossing itself.
  bool is_family(const BifurcationEquation& equation) {
    for (const double s : {-1.0, -0.3, 0.3, 1.0}) {
      BranchNode node = equation.at();
      node.point = equation.displaced(node, node.value, s);
      branch_.equations(node.value)->find(node.point, branch_.held(), 12);
      const double part = equation.place_of(node) / s;
      if (!(node.point.residual < kGood && part > 0.5 && part < 2)) return false;
      crossing_.other = reduced::place_of(branch_, node);
    }
    return true;
  }

  Branch& branch_;
  const RealCrossing& real_;
  SteadyCrossing& crossing_;
  double turning_ = 0;  // d
};

}  // namespace

void classify(Branch& branch, const RealCrossing& real, SteadyCrossing& crossing) {
  crossing.kind = Classification(branch, real, crossing).kind();
}

Bifurcation kind_of_turn(Branch& branch, const Branch::Turn& turn) {
  BifurcationEquation equation(branch, turn.at, {turn.before, turn.behind});
  if (equation.kernel() != 1) return Bifurcation::undecided;
  // The place is known to a small part of the step over the turn: a generous error.
  const double span = std::abs(equation.place_of(turn.behind) - equation.place_of(turn.before));
  equation.set_place_error(std::max(1e-4, 10 * turn.place_error) * span);
  equation.expand(turn.before);
  equation.expand_by_value();
  const Estimate b = equation.quadratic(), c = equation.cubic(), by_value = equation.by_value();
  if (by_value.is_nonzero() && b.is_nonzero()) return Bifurcation::fold;
  const bool on_another = by_value.is_zero() && b.is_zero() && c.is_nonzero();
  return on_another ? Bifurcation::pitchfork : Bifurcation::undecided;
}

}  // namespace hamel::reduced
