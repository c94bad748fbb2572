// Growth of the processor time of a step with the number of bodies, as a table and as a plot.
//
//   build/tests/benchmarks/growth [--quick] [PLOT.svg]
// A time is the least of blocks in turns over all sizes, so that all see the same machine; each
// block takes 200 steps behind the first 20, which come from the start. The growth is the power of
// n between 30 and 60. --quick: one block.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <hamel/hamel.hpp>

#include "../systems/mechanism_systems.hpp"
#include "chains.hpp"

namespace {

using namespace hamel;  // a program, not a header

constexpr std::array<int, 9> kBodies = {2, 3, 5, 8, 12, 20, 30, 45, 60};

struct Curve {
  std::string name;
  std::vector<hamel::Run> runs;  // of each size
  std::vector<double> microseconds =
      std::vector<double>(kBodies.size(), std::numeric_limits<double>::infinity());
  double power() const { return std::log2(microseconds.back() / microseconds[kBodies.size() - 3]); }
};

Mechanism train(int bodies) {
  NTrailer system;
  system.trailers = bodies - 1;
  Mechanism out = by_parts::train(system);
  out.start({{"v1", 1}, {"hitch 1.angle", 0.3}});
  return out;
}

template <class Make>
Curve curve(const std::string& name, const std::string& scheme, double step, const Make& make) {
  Curve out{name + ", " + scheme, {}};
  for (const int n : kBodies)
    out.runs.push_back(Simulation(make(n)).scheme(scheme).step(step).build());
  return out;
}

void measure(Curve& curve, size_t i) {
  hamel::Run& run = curve.runs[i];
  constexpr long steps = 200;
  run.restart(run.config().start);
  if (!run.step(20)) throw std::runtime_error(curve.name + ": the first steps fail");
  const std::clock_t begin = std::clock();
  if (!run.step(steps)) throw std::runtime_error(curve.name + ": a step fails");
  const double spent = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  curve.microseconds[i] = std::min(curve.microseconds[i], 1e6 * spent / static_cast<double>(steps));
}

// ---- the plot: both axes logarithmic -----------------------------------------------------------

constexpr double kWidth = 680, kHeight = 400, kLeft = 58, kRight = 210, kTop = 16, kBottom = 40;
constexpr std::array<const char*, 5> kColours = {"#2f7fc1", "#d0692a", "#3d9150", "#9a5fc0",
                                                 "#b08900"};

struct Axes {
  double low, high;  // microseconds, powers of ten
  static double x(double n) {
    return kLeft + (kWidth - kLeft - kRight) * std::log(n / 2) / std::log(30.0);
  }
  double y(double time) const {
    return kHeight - kBottom -
           (kHeight - kTop - kBottom) * std::log(time / low) / std::log(high / low);
  }
};

std::string plot(const std::vector<Curve>& curves) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const Curve& c : curves) {
    least = std::min(least, *std::ranges::min_element(c.microseconds));
    most = std::max(most, *std::ranges::max_element(c.microseconds));
  }
  const Axes axes{std::pow(10, std::floor(std::log10(least))),
                  std::pow(10, std::ceil(std::log10(most)))};
  std::string out = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img">
<title>Time of a step against the number of bodies</title>
<style>
text {{ font: 12px system-ui, sans-serif; fill: #222 }} .grid {{ stroke: #ddd }} .paper {{ fill: #fff }}
polyline {{ fill: none; stroke-width: 1.8 }}
@media (prefers-color-scheme: dark) {{ text {{ fill: #ddd }} .grid {{ stroke: #444 }} .paper {{ fill: #16181b }} }}
</style>
<rect class="paper" width="{0}" height="{1}"/>
)",
      kWidth, kHeight);
  for (double decade = axes.low; decade < axes.high * 1.01; decade *= 10)
    out += fmt::format(
        "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text x=\"{3}\" "
        "y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
        kLeft, kWidth - kRight, axes.y(decade), kLeft - 6, axes.y(decade) + 4, decade);
  for (const int n : kBodies)
    out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", Axes::x(n),
                       kHeight - kBottom + 18, n);
  out += fmt::format(
      "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">bodies</text><text transform=\"translate(14 "
      "{}) rotate(-90)\" text-anchor=\"middle\">µs a step</text>\n",
      (kLeft + kWidth - kRight) / 2, kHeight - 6, (kTop + kHeight - kBottom) / 2);
  std::vector<size_t> order(curves.size());
  for (size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::sort(order, std::greater{}, [&](size_t k) { return curves[k].microseconds.back(); });
  double label = kTop;
  for (const size_t k : order) {
    const Curve& c = curves[k];
    std::string points;
    for (size_t i = 0; i < kBodies.size(); ++i)
      points += fmt::format("{:.1f},{:.1f} ", Axes::x(kBodies[i]), axes.y(c.microseconds[i]));
    label = std::max(label + 34, axes.y(c.microseconds.back()));
    out += fmt::format(
        "<polyline points=\"{0}\" stroke=\"{1}\"/><text x=\"{2}\" y=\"{3:.1f}\" style=\"fill: "
        "{1}\">{4}</text><text x=\"{2}\" y=\"{5:.1f}\">power {6:.2f} from 30 to 60</text>\n",
        points, kColours[k % kColours.size()], kWidth - kRight + 8, label, c.name, label + 15,
        c.power());
  }
  return out + "</svg>\n";
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::string path;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--quick") quick = true;
    else path = argv[i];
  }
  const auto by_name = [](int n) { return simulate("n_trailer").set("trailers", n - 1); };
  const auto by_parts = [](int n) { return simulate(train(n)); };
  const auto in_space = [](int n) { return simulate(benchmarks::snake(n)); };
  std::vector<Curve> curves;
  curves.push_back(curve("n_trailer", "lift", 0.01, by_name));
  curves.push_back(curve("trailers by parts", "lift", 0.01, by_parts));
  curves.push_back(curve("trailers by parts", "rkmk4", 0.01, by_parts));
  curves.push_back(curve("snake in space", "lift", 0.001, in_space));
  curves.push_back(curve("snake in space", "rkmk4", 0.001, in_space));
  for (int block = 0; block < (quick ? 1 : 12); ++block)
    for (Curve& c : curves)
      for (size_t i = 0; i < kBodies.size(); ++i) measure(c, i);
  std::printf("microseconds a step\n%-28s", "bodies");
  for (const int n : kBodies) std::printf("%9d", n);
  std::printf("   power from 30 to 60\n");
  for (const Curve& c : curves) {
    std::printf("%-28s", c.name.c_str());
    for (const double time : c.microseconds) std::printf("%9.2f", time);
    std::printf("   %.2f\n", c.power());
  }
  if (path.empty()) return 0;
  std::ofstream file(path);
  file << plot(curves);
  return file ? 0 : 1;
}
