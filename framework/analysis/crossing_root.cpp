#include <hamel/framework/analysis/crossing_root.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace hamel::reduced {
namespace {

constexpr double kEnough = 1e-12;  // of the branch: an error that larger steps need not improve

// The two of some eigenvalues that are nearest to a value; -1 where there are none.
std::array<int, 2> two_nearest(const std::vector<Complex>& values, const std::vector<int>& among,
                               Complex to) {
  std::array<int, 2> out{-1, -1};
  const auto far = [&](int i) { return std::abs(values[static_cast<size_t>(i)] - to); };
  for (const int i : among) {
    if (out[0] < 0 || far(i) < far(out[0])) out = {i, out[0]};
    else if (out[1] < 0 || far(i) < far(out[1])) out[1] = i;
  }
  return out;
}

// The zero of the polynomial through four points nearest to x0, by Newton's method.
std::optional<double> zero_near(const std::array<double, 4>& x, std::array<double, 4> f, double x0,
                                double most) {
  for (size_t k = 1; k < 4; ++k)  // divided differences
    for (size_t i = 3; i >= k; --i) f[i] = (f[i] - f[i - 1]) / (x[i] - x[i - k]);
  double at = x0;
  for (int iteration = 0; iteration < 30; ++iteration) {
    double value = f[3], slope = 0;
    for (size_t i = 3; i-- > 0;) {
      slope = value + slope * (at - x[i]);
      value = f[i] + value * (at - x[i]);
    }
    if (!(std::abs(slope) > 0)) return std::nullopt;
    const double step = value / slope;
    at -= step;
    if (!(std::abs(at - x0) <= most)) return std::nullopt;
    if (std::abs(step) <= 1e-16 * most) break;
  }
  return at;
}

}  // namespace

// f is zero at the crossing and positive where there is growth.
CrossingRoot::Sample CrossingRoot::sample(const BranchMotion& at, Complex expected) const {
  const SteadyMotion& motion = at.motion;
  std::vector<int> all, axis;
  for (size_t i = 0; i < motion.eigenvalues.size(); ++i) {
    all.push_back(static_cast<int>(i));
    if (std::abs(motion.eigenvalues[i].real()) <= motion.round_off[i])
      axis.push_back(static_cast<int>(i));
  }
  const size_t nearest =
      rank_ ? *rank_ : static_cast<size_t>(two_nearest(motion.eigenvalues, all, expected)[0]);
  const Complex value = motion.eigenvalues[nearest];
  const double real = value.real(), error = motion.round_off[nearest];
  Sample out{at.node.value, real, error, {at, value}};
  if (!mirrored_) return out;
  if (std::abs(real) > error) {
    out.f = real * real;
    out.error = (2 * std::abs(real) + error) * error;
    out.point.eigenvalue = Complex(std::abs(real), value.imag());
    return out;
  }
  // On the axis: the two that collide.
  const auto [i, j] = two_nearest(motion.eigenvalues, axis, Complex(0, expected.imag()));
  if (j < 0) return out;
  const Complex x = motion.eigenvalues[static_cast<size_t>(i)],
                y = motion.eigenvalues[static_cast<size_t>(j)];
  const double gap = std::abs(x - y), known = motion.round_off[static_cast<size_t>(i)] +
                                              motion.round_off[static_cast<size_t>(j)];
  out.f = -gap * gap / 4;
  out.error = (2 * gap + known) * known / 4;
  out.point.eigenvalue = 0.5 * (x + y);
  return out;
}

// By real part the eigenvalue at each place is continuous, whatever else collides: where nothing
// but this eigenvalue, or this pair, crosses between two points, it is the one at that place.
void CrossingRoot::set_rank(const CurvePoint& a, const CurvePoint& b) {
  rank_.reset();
  const auto growing = [](const CurvePoint& point) {
    const auto& all = point.at.motion.eigenvalues;
    return std::count_if(all.begin(), all.end(), [](Complex x) { return x.real() > 0; });
  };
  const auto one = growing(a), other = growing(b);
  const Complex unstable = one > other ? a.eigenvalue : b.eigenvalue;
  const bool complex = unstable.imag() != 0;
  if (mirrored_ || std::abs(one - other) != (complex ? 2 : 1)) return;
  rank_ = static_cast<size_t>(std::min(one, other) + (complex && unstable.imag() < 0 ? 1 : 0));
}

std::optional<CrossingRoot::Sample> CrossingRoot::sample(double x, Complex expected) const {
  const auto at = on_branch_(x);
  if (!at || at->motion.eigenvalues.empty()) return std::nullopt;
  return sample(*at, expected);
}

// Regula falsi (Illinois), to a millionth of the step: the rest is interpolated.
void CrossingRoot::close_in(Sample& low, Sample& high) const {
  const double width = std::abs(high.x - low.x);
  double f0 = low.f, f1 = high.f, last = low.x;
  for (int k = 0, side = 0; k < 60; ++k) {
    double x = (f1 * low.x - f0 * high.x) / (f1 - f0);
    const bool inside = x > std::min(low.x, high.x) && x < std::max(low.x, high.x);
    if (!inside || k % 6 == 5) x = 0.5 * (low.x + high.x);
    if (std::abs(x - last) < 1e-6 * width || std::abs(high.x - low.x) < 1e-6 * width) break;
    last = x;
    const double part = (x - low.x) / (high.x - low.x);
    const auto there =
        sample(x, low.point.eigenvalue + part * (high.point.eigenvalue - low.point.eigenvalue));
    if (!there) break;
    if ((there->f > 0) == (high.f > 0)) {
      high = *there, f1 = there->f;
      if (side == 1) f0 /= 2;
      side = 1;
    } else {
      low = *there, f0 = there->f;
      if (side == -1) f1 /= 2;
      side = -1;
    }
  }
}

// By values at -2h, -h, h, 2h from a sample near the crossing; slope: of the eigenvalue.
std::optional<CrossingRoot::Root> CrossingRoot::interpolated(const Sample& near, Complex slope,
                                                             double h) const {
  std::array<double, 4> x{}, f{}, imaginary{};
  double noise = 0, imaginary_error = 0;
  constexpr std::array<double, 4> places{-2, -1, 1, 2};
  for (size_t i = 0; i < 4; ++i) {
    const double shift = places[i] * h;
    const auto there = sample(near.x + shift, near.point.eigenvalue + slope * shift);
    if (!there) return std::nullopt;
    x[i] = there->x;
    f[i] = there->f;
    imaginary[i] = there->point.eigenvalue.imag();
    noise = std::max(noise, there->error);
    for (size_t k = 0; k < there->point.at.motion.eigenvalues.size(); ++k)
      if (std::abs(there->point.at.motion.eigenvalues[k] - there->point.eigenvalue) <=
          2 * there->point.at.motion.round_off[k])
        imaginary_error = std::max(imaginary_error, there->point.at.motion.round_off[k]);
  }
  if ((f[0] > 0) == (f[3] > 0)) return std::nullopt;
  const auto value = zero_near(x, f, near.x, 2 * h);
  if (!value) return std::nullopt;
  const double steepness = std::abs(f[3] - f[0]) / (4 * h);
  return Root{*value, noise / std::max(1e-300, steepness),
              std::min(std::abs(imaginary[1]), std::abs(imaginary[2])), imaginary_error};
}

std::optional<CrossingRoot::Found> CrossingRoot::find(const CurvePoint& a, const CurvePoint& b,
                                                      double first, double last) {
  set_rank(a, b);
  Sample low = sample(a.at, a.eigenvalue), high = sample(b.at, b.eigenvalue);
  const double width = std::abs(high.x - low.x);
  const Complex slope =
      mirrored_ ? Complex(0) : (high.point.eigenvalue - low.point.eigenvalue) / (high.x - low.x);
  const double steepness = std::abs((high.f - low.f) / (high.x - low.x));
  if ((low.f > 0) != (high.f > 0)) close_in(low, high);
  const Sample& near = std::abs(low.f) < std::abs(high.f) ? low : high;
  Found out{.value = near.x,
            .error = std::abs(high.x - low.x) + near.error / std::max(1e-300, steepness),
            .at = near.point.at,
            .eigenvalue = near.point.eigenvalue,
            .pair = false};
  double imaginary = std::abs(near.point.eigenvalue.imag()), imaginary_error = near.error;
  // Steps from small to large: the error is what the next smaller one changes.
  const double room = std::min(std::abs(near.x - first), std::abs(last - near.x)) / 2;
  const double most = std::min(0.05 * std::abs(last - first), room);
  std::optional<Root> before;
  bool crosses = false;
  for (double h = most / 4096; h <= most && h > 1e-9 * std::abs(last - first); h *= 4) {
    if (crosses && out.error < kEnough * std::abs(last - first)) break;
    const auto root = interpolated(near, slope, h);
    if (root && before) {
      const double error = std::abs(root->value - before->value) + root->error;
      if (!crosses || error < out.error) {
        out.value = root->value;
        out.error = error;
        imaginary = root->imaginary;
        imaginary_error = root->imaginary_error;
      }
      crosses = true;
    }
    before = root;
  }
  if (mirrored_ && !crosses) return std::nullopt;
  out.error = std::min(out.error, width);
  out.error = std::max(out.error, 4e-16 * (std::abs(first) + std::abs(last)));
  out.pair = imaginary > imaginary_error;
  return out;
}

}  // namespace hamel::reduced
