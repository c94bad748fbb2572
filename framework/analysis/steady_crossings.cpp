#include <hamel/framework/analysis/steady_crossings.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hamel::reduced {
namespace {

using Complex = std::complex<double>;

// The two of some numbers that are closest to each other; false where there are none.
bool closest(const std::vector<Complex>& values, Complex& a, Complex& b) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < values.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      if (const double apart = std::abs(values[i] - values[j]); apart < least) {
        least = apart;
        a = values[i];
        b = values[j];
      }
    }
  }
  return std::isfinite(least);
}

}  // namespace

SteadyPlace place_of(Branch& branch, const BranchNode& node) {
  SteadyPlace out{.value = node.value, .element = {}, .velocity = {}};
  const auto equations = branch.equations(node.value);
  const Geometry& geometry = equations->geometry();
  out.element.resize(static_cast<size_t>(geometry.columns()));
  geometry.coordinates(node.point.g.data(), out.element.data());
  out.velocity.assign(node.point.xi.begin(), node.point.xi.end());
  return out;
}

std::vector<SteadyCrossing> Crossings::between(const BranchMotion& left,
                                               const BranchMotion& right) {
  out_.clear();
  known_ = {left, right};
  look(left, right);
  return std::move(out_);
}

// On the branch, from the nearest node that is known.
std::optional<BranchMotion> Crossings::on_branch(double value) {
  const auto nearest =
      std::min_element(known_.begin(), known_.end(), [&](const auto& a, const auto& b) {
        return std::abs(a.node.value - value) < std::abs(b.node.value - value);
      });
  const auto node = branch_.advance(nearest->node, value);
  if (!node) return std::nullopt;
  BranchMotion out{*node, branch_.equations(value)->motion(node->point, family_)};
  known_.push_back(out);
  return out;
}

// By real part the eigenvalue at each place is a continuous function of the value: each that
// changes its sign has a zero.
void Crossings::look(const BranchMotion& a, const BranchMotion& b) {
  if (a.motion.eigenvalues.size() != b.motion.eigenvalues.size()) return;
  const bool rises = b.motion.growing() > a.motion.growing();
  const SteadyMotion &growing = rises ? b.motion : a.motion, &still = rises ? a.motion : b.motion;
  const auto last = static_cast<size_t>(growing.growing());
  for (index_ = static_cast<size_t>(still.growing()); index_ < last; ++index_) {
    const Complex value = growing.eigenvalues[index_];
    const double known = growing.round_off[index_];
    pair_ = std::abs(value.imag()) > known && index_ + 1 < last;
    // Without damping each eigenvalue l has a mate -l*, and is on the axis where it does not grow.
    mirrored_ = std::abs(still.eigenvalues[index_].real()) <= still.round_off[index_] &&
                std::any_of(growing.eigenvalues.begin(), growing.eigenvalues.end(), [&](Complex x) {
                  return std::abs(x + std::conj(value)) < 10 * known + 1e-9 * std::abs(value);
                });
    locate(a, b);
    if (pair_) ++index_;
  }
}

// Zero at the crossing, positive where there is growth.
double Crossings::measure(const SteadyMotion& motion) const {
  const double real = motion.eigenvalues[index_].real();
  if (!mirrored_) return real;
  if (motion.growing() > static_cast<int>(index_)) return real * real;
  // Selects, of the eigenvalues on the axis, the two that are about to collide.
  std::vector<Complex> axis;
  for (size_t i = 0; i < motion.eigenvalues.size(); ++i) {
    const Complex x = motion.eigenvalues[i];
    if (std::abs(x.real()) > 10 * motion.round_off[i] + 1e-9 * std::abs(x)) continue;
    if (!pair_ || x.imag() > 0) axis.push_back(x);
  }
  Complex a, b;
  if (pair_)
    return closest(axis, a, b) ? ((a - b) * (a - b)).real() / 4
                               : -std::numeric_limits<double>::infinity();
  std::sort(axis.begin(), axis.end(),
            [](Complex x, Complex y) { return std::abs(x) < std::abs(y); });
  return axis.size() < 2 ? -std::numeric_limits<double>::infinity() : -(axis[0] * axis[1]).real();
}

// Error of measure(): that of the eigenvalues that cross.
double Crossings::error_at(const SteadyMotion& motion) const {
  double known = 1e-15;
  for (size_t i = 0; i < motion.eigenvalues.size(); ++i) {
    const double round_off = motion.round_off[i];
    if (std::abs(motion.eigenvalues[i].real()) > 10 * round_off) continue;
    known = std::max(known, mirrored_ ? round_off * round_off : round_off);
  }
  return known;
}

// The zero of the line through both points; the middle if that zero is not between them.
static double secant(double x0, double f0, double x1, double f1) {
  const double x = (f1 * x0 - f0 * x1) / (f1 - f0);
  return x > std::min(x0, x1) && x < std::max(x0, x1) ? x : 0.5 * (x0 + x1);
}

void Crossings::locate(const BranchMotion& a, const BranchMotion& b) {
  BranchMotion low = a, high = b;
  double x0 = a.node.value, x1 = b.node.value, f0 = measure(a.motion), f1 = measure(b.motion);
  const double scale = branch_.scale() + std::abs(x0) + std::abs(x1);
  double slope = (f1 - f0) / (x1 - x0);
  for (int k = 0, side = 0; k < 80 && std::abs(x1 - x0) > 1e-13 * scale; ++k) {
    const double x = k % 6 == 5 ? 0.5 * (x0 + x1) : secant(x0, f0, x1, f1);
    if (x == x0 || x == x1) break;
    const auto there = on_branch(x);
    if (!there) break;
    const double f = measure(there->motion);
    if ((f > 0) == (f1 > 0)) {
      if (std::abs(x1 - x) > 1e-7 * scale) slope = (f1 - f) / (x1 - x);
      x1 = x, f1 = f, high = *there;
      if (side == 1) f0 /= 2;
      side = 1;
    } else {
      if (std::abs(x0 - x) > 1e-7 * scale) slope = (f0 - f) / (x0 - x);
      x0 = x, f0 = f, low = *there;
      if (side == -1) f1 /= 2;
      side = -1;
    }
    if (f == 0) break;
  }
  const BranchMotion& at =
      std::abs(measure(low.motion)) < std::abs(measure(high.motion)) ? low : high;
  const double imaginary = std::abs(at.motion.eigenvalues[index_].imag());
  pair_ = pair_ && (mirrored_ || imaginary > at.motion.round_off[index_]);  // else one no longer
  SteadyCrossing out{.value = at.node.value, .pair = pair_, .other = {}};
  const double error = error_at(at.motion) + std::abs(measure(at.motion));
  out.round_off =
      std::max(1e-14 * scale, std::min(scale, error / std::max(1e-300, std::abs(slope))));
  classify(out, at);
  out_.push_back(out);
}

void Crossings::classify(SteadyCrossing& crossing, const BranchMotion& at) {
  if (pair_) {
    crossing.kind = mirrored_ ? Bifurcation::hamiltonian_hopf : Bifurcation::hopf;
    return;
  }
  crossing.kind = Bifurcation::none;
  const BranchNode& node = at.node;
  const auto nearby = on_branch(node.value + 1e-3 * (known_.front().node.value - node.value));
  if (!nearby) return;
  const bool held = branch_.held();
  const auto here = branch_.equations(node.value), there = branch_.equations(nearby->node.value);
  const auto at_crossing = here->singular(node.point, held),
             beside = there->singular(nearby->node.point, held);
  const Eigen::Index known = (beside.values.array() < kNull * beside.size).count();
  Eigen::Index count = known;
  while (count < beside.values.size() && at_crossing.values[count] < 0.01 * beside.values[count])
    ++count;
  if (count == known) return;
  const Matrix kernel = here->beside(node.point, at_crossing, count),
               generic = there->beside(nearby->node.point, beside, known);
  const Matrix fresh = range_of(kernel - generic * (generic.transpose() * kernel), 0.1, 1);
  if (fresh.cols() == 0) return;
  for (const double e : {0.02, 0.005}) {
    Vector v(fresh.rows() + 1);
    v << e * fresh.col(0), 0;
    const auto one = branch_.beside(node, v), two = branch_.beside(node, -v);
    if (!one && !two) continue;
    const double d1 = one ? (one->value - node.value) / branch_.scale() : 0,
                 d2 = two ? (two->value - node.value) / branch_.scale() : 0;
    const double flat = std::max(1e-5 * e * e, 3 * crossing.round_off / branch_.scale());
    if (std::max(std::abs(d1), std::abs(d2)) < flat) crossing.kind = Bifurcation::family;
    else if (one && two && d1 * d2 < 0) crossing.kind = Bifurcation::transcritical;
    else crossing.kind = Bifurcation::pitchfork;
    crossing.other = place_of(branch_, one ? *one : *two);
    return;
  }
}

}  // namespace hamel::reduced
