#include <hamel/framework/analysis/steady_crossings.hpp>

#include <algorithm>
#include <cmath>

#include <hamel/framework/analysis/crossing_root.hpp>

namespace hamel::reduced {
namespace {

constexpr int kDeepest = 8;  // halvings of a step

int sign_of(const SteadyMotion& motion, size_t place) {
  const double real = motion.eigenvalues[place].real(), error = motion.round_off[place];
  return real > error ? 1 : (real < -error ? -1 : 0);
}

// Whether a curve is followed without doubt through the middle of a step. A step along the axis
// leaves nothing to miss where errors cover all three.
bool followed(const SteadyMotion& a, const SteadyMotion& m, const SteadyMotion& b, size_t i,
              size_t j, size_t k) {
  const Complex la = a.eigenvalues[i], lm = m.eigenvalues[j], lb = b.eigenvalues[k];
  const double off = std::abs(lm - 0.5 * (la + lb));
  const double error = a.round_off[i] + m.round_off[j] + b.round_off[k];
  if (off <= error || off <= 0.25 * std::abs(lb - la)) return true;
  const double side = la.real() > 0 ? 1 : -1;
  return std::min({side * la.real(), side * lm.real(), side * lb.real()}) > 2 * off;
}

bool followed(const SteadyMotion& a, const SteadyMotion& m, const SteadyMotion& b) {
  const std::vector<int> first = matched(a.eigenvalues, m.eigenvalues),
                         second = matched(m.eigenvalues, b.eigenvalues);
  for (size_t i = 0; i < first.size(); ++i) {
    const auto j = static_cast<size_t>(first[i]);
    if (!followed(a, m, b, i, j, static_cast<size_t>(second[j]))) return false;
  }
  return true;
}

// Whether an eigenvalue l that grows has its mate -l*.
bool has_mate(const SteadyMotion& motion, size_t place) {
  const Complex value = motion.eigenvalues[place];
  const double error = motion.round_off[place];
  return std::any_of(motion.eigenvalues.begin(), motion.eigenvalues.end(), [&](Complex x) {
    return std::abs(x + std::conj(value)) < 10 * error + 1e-9 * std::abs(value);
  });
}

}  // namespace

std::vector<FoundCrossing> Crossings::along(const std::vector<BranchMotion>& nodes) {
  out_.clear();
  known_.clear();
  if (nodes.empty()) return {};
  known_.push_back(nodes.front());
  for (size_t k = 1; k < nodes.size(); ++k) refine(nodes[k - 1], nodes[k], kDeepest);
  std::vector<Bracket> brackets;
  for (const Curve& curve : curves()) add_brackets(curve, brackets);
  for (const Bracket& bracket : brackets) locate(bracket);
  const bool rising = nodes.back().node.value > nodes.front().node.value;
  std::stable_sort(out_.begin(), out_.end(), [&](const auto& a, const auto& b) {
    return rising ? a.crossing.value < b.crossing.value : a.crossing.value > b.crossing.value;
  });
  return std::move(out_);
}

std::optional<BranchNode> Crossings::node_at(double value) {
  const auto nearest =
      std::min_element(known_.begin(), known_.end(), [&](const auto& a, const auto& b) {
        return std::abs(a.node.value - value) < std::abs(b.node.value - value);
      });
  if (nearest->node.value == value) return nearest->node;
  return branch_.advance(nearest->node, value);
}

std::optional<BranchMotion> Crossings::on_branch(double value) {
  const auto node = node_at(value);
  if (!node) return std::nullopt;
  return BranchMotion{*node, branch_.motion(*node, family_)};
}

// Adds the nodes behind a, up to b.
void Crossings::refine(const BranchMotion& a, const BranchMotion& b, int depth) {
  const auto middle = on_branch(0.5 * (a.node.value + b.node.value));
  const size_t count = a.motion.eigenvalues.size();
  if (!middle || middle->motion.eigenvalues.size() != count ||
      b.motion.eigenvalues.size() != count) {
    known_.push_back(b);
  } else if (depth == 0 || followed(a.motion, middle->motion, b.motion)) {
    known_.push_back(*middle);
    known_.push_back(b);
  } else {
    refine(a, *middle, depth - 1);
    refine(*middle, b, depth - 1);
  }
}

std::vector<Crossings::Curve> Crossings::curves() const {
  const size_t count = known_.front().motion.eigenvalues.size();
  std::vector<Curve> out(count);
  for (size_t i = 0; i < count; ++i) out[i].push_back(i);
  for (size_t k = 1; k < known_.size(); ++k) {
    if (known_[k].motion.eigenvalues.size() != count) break;
    std::vector<Complex> expected;
    for (const Curve& curve : out) {
      const Complex last = known_[k - 1].motion.eigenvalues[curve[k - 1]];
      expected.push_back(last);
      if (k < 2) continue;
      const double q0 = known_[k - 2].node.value, q1 = known_[k - 1].node.value;
      const Complex before = known_[k - 2].motion.eigenvalues[curve[k - 2]];
      expected.back() += (last - before) * ((known_[k].node.value - q1) / (q1 - q0));
    }
    const std::vector<int> to = matched(expected, known_[k].motion.eigenvalues);
    for (size_t i = 0; i < count; ++i) out[i].push_back(static_cast<size_t>(to[i]));
  }
  return out;
}

// A change of the known sign; or, of a curve with a mate, what it does where it reaches the axis
// and where it leaves it.
void Crossings::add_brackets(const Curve& curve, std::vector<Bracket>& to) const {
  const auto point = [&](size_t k) { return Point{k, curve[k]}; };
  int last = 0;         // known sign
  size_t at = 0;        // its node
  bool joined = false;  // with a mate there
  for (size_t k = 0; k < curve.size(); ++k) {
    const int sign = sign_of(known_[k].motion, curve[k]);
    if (sign == 0) continue;
    const bool mated = has_mate(known_[k].motion, curve[k]);
    const bool from_axis = k > 0 && (last == 0 || k > at + 1);
    if (mated && (joined || last == 0)) {
      if (from_axis && last > 0) to.push_back({point(at), point(at + 1), true});
      if (from_axis && sign > 0) to.push_back({point(k), point(k - 1), true});
    } else if (last * sign < 0) {
      to.push_back({point(at), point(k), false});
    }
    last = sign;
    at = k;
    joined = mated;
  }
  if (last > 0 && joined && at + 1 < curve.size()) to.push_back({point(at), point(at + 1), true});
}

void Crossings::locate(const Bracket& bracket) {
  const auto point = [&](const Point& p) {
    const BranchMotion& m = known_[p.node];
    return CurvePoint{m, m.motion.eigenvalues[p.place]};
  };
  CrossingRoot root([this](double value) { return on_branch(value); }, bracket.mirrored);
  const auto found = root.find(point(bracket.from), point(bracket.to), known_.front().node.value,
                               known_.back().node.value);
  if (!found) return;
  // A pair is one crossing.
  if (found->pair && found->eigenvalue.imag() < 0) return;
  SteadyCrossing out;
  out.value = found->value;
  out.pair = found->pair;
  out.round_off = found->error;
  if (found->pair) out.kind = bracket.mirrored ? Bifurcation::hamiltonian_hopf : Bifurcation::hopf;
  const auto real = [&](const Point& p) { return point(p).eigenvalue.real(); };
  const bool forwards = bracket.from.node < bracket.to.node;
  out_.push_back({out, found->at.node, forwards == (real(bracket.to) > real(bracket.from))});
}

}  // namespace hamel::reduced
