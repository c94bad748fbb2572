// Steady motions along a parameter, and where their stability changes.
#include <algorithm>
#include <cmath>

#include <hamel/framework/analysis/steady.hpp>

namespace hamel {
namespace {

// Between values with different numbers of unstable eigenvalues: halved until one crossing is left, then the real part
// that changes its sign by the Illinois method. Where it is zero on one side, as an imaginary pair of a system without
// damping, by halving.
class Crossings {
 public:
  Crossings(const std::function<SteadyMotion(double)>& at, std::vector<SteadySweep::Crossing>& out)
      : at_(at), out_(out) {}

  void look(double a, const SteadyMotion& left, double b, const SteadyMotion& right,
            int depth = 0) {
    if (depth == 0) from_ = a, to_ = b;
    if (left.eigenvalues.size() != right.eigenvalues.size()) return;  // not found at one of them
    const int jump = std::abs(right.growing() - left.growing());
    if (jump == 0) return;
    const size_t index = static_cast<size_t>(std::min(left.growing(), right.growing()));
    const bool pair =
        jump == 2 && left.eigenvalues[index].imag() != 0 && right.eigenvalues[index].imag() != 0;
    if (jump > 1 && !pair && depth < 40) {
      const double middle = 0.5 * (a + b);
      const SteadyMotion there = at_(middle);
      look(a, left, middle, there, depth + 1);
      look(middle, there, b, right, depth + 1);
      return;
    }
    const double fa = left.eigenvalues[index].real(), fb = right.eigenvalues[index].real();
    const bool touches =
        std::abs(fa) < left.round_off[index] || std::abs(fb) < right.round_off[index];
    if (!touches) out_.push_back({root(a, fa, b, fb, index), pair});
    else if (fa > fb) out_.push_back({edge(b, a, from_, index), pair});
    else out_.push_back({edge(a, b, to_, index), pair});
  }

 private:
  double root(double a, double fa, double b, double fb, size_t index) {
    int side = 0;
    for (int k = 0; k < 80 && wide(a, b); ++k) {
      double x = (fb * a - fa * b) / (fb - fa);
      if (k % 8 == 7 || !(x > std::min(a, b) && x < std::max(a, b))) x = 0.5 * (a + b);
      const SteadyMotion there = at_(x);
      if (!there.found) return x;
      const double fx = there.eigenvalues[index].real();
      if (std::abs(fx) < 1e-14) return x;
      if ((fx > 0) == (fb > 0)) {
        b = x;
        fb = fx;
        if (side == 1) fa /= 2;
        side = 1;
      } else {
        a = x;
        fa = fx;
        if (side == -1) fb /= 2;
        side = -1;
      }
    }
    return std::abs(fa) < std::abs(fb) ? a : b;
  }

  // From where the real part is 0 to where it grows. Halving finds where it is more than round-off; if it rises in proportion
  // from there, the line through two of its values has the zero; if like a root, what was found is close enough.
  // end: of the interval, on the side that grows.
  double edge(double still, double grows, double end, size_t index) {
    while (wide(still, grows)) {
      const double x = 0.5 * (still + grows);
      const SteadyMotion there = at_(x);
      if (!there.found) return x;
      (there.growing() > static_cast<int>(index) ? grows : still) = x;
    }
    const double most = 1e-6 * (1 + std::abs(grows));
    const double w = std::clamp(end - grows, -most, most) / 2;
    if (w == 0) return grows;
    const SteadyMotion near = at_(grows + w), far = at_(grows + 2 * w);
    if (!near.found || !far.found) return grows;
    const double f = near.eigenvalues[index].real(),
                 slope = (far.eigenvalues[index].real() - f) / w;
    const double zero = grows + w - f / slope;
    return std::abs((zero - grows) * slope) < 4 * near.round_off[index] ? zero : grows;
  }
  static bool wide(double a, double b) {
    return std::abs(b - a) > 1e-12 * (1 + std::abs(a) + std::abs(b));
  }

  const std::function<SteadyMotion(double)>& at_;
  std::vector<SteadySweep::Crossing>& out_;
  double from_ = 0, to_ = 0;  // where it was first looked
};

}  // namespace

SteadySweep sweep_steady(const std::vector<double>& values,
                         const std::function<SteadyMotion(double value, int family)>& at) {
  SteadySweep out;
  out.values = values;
  std::vector<int> families;
  for (const double value : values) {
    if (const SteadyMotion motion = at(value, -1); motion.found) families.push_back(motion.family);
  }
  const int family = families.empty() ? 0 : *std::min_element(families.begin(), families.end());
  for (const double value : values) out.motions.push_back(at(value, family));
  const std::function<SteadyMotion(double)> there = [&](double value) { return at(value, family); };
  Crossings crossings(there, out.crossings);
  for (size_t i = 1; i < values.size(); ++i) {
    crossings.look(values[i - 1], out.motions[i - 1], values[i], out.motions[i]);
  }
  return out;
}

}  // namespace hamel
