// Which retraction wins at equal error, over all registered systems and mechanisms.
//
//   build/tests/benchmarks/retractions [--quick] [system ...]
// Each system moves for 5 s from its own start by dop853 at tolerances of 1e-4 to 1e-12, and by
// lift (s = 1/2) at steps of 0.08 to 6e-4 s. The error is the largest difference of coordinates and
// velocities at the end from dop853 at 1e-13; where the two retractions differ by more than 1e-9
// there, the motion is not resolved and the row is left out. Printed is the processor time to an
// error of 1e-6 (dop853) and 1e-3 (lift), log-log interpolated between settings, exp over cayley.
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <hamel/simulate.hpp>

#include "../framework/distances.hpp"

namespace {

constexpr double kUntil = 5;
bool quick = false;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<double> end_of(hamel::Run& run) {
  std::vector<double> out = run.state().coordinates;
  out.insert(out.end(), run.state().velocity.begin(), run.state().velocity.end());
  return out;
}

struct Point {
  double error, seconds;
};

/// The error of one run, and the least of the times of its repetitions.
Point measure(const hamel::Simulation& simulation, const std::vector<double>& reference) {
  const double none = std::numeric_limits<double>::infinity();
  Point out{none, none};
  hamel::Run run = simulation.build();
  const hamel::Start start = run.config().start;
  double spent = 0;
  for (int i = 0; i < (quick ? 1 : 50) && spent < 0.1; ++i) {
    run.restart(start);
    const double before = processor_seconds();
    if (!run.advance_to(kUntil).ok) return {none, none};
    const double seconds = processor_seconds() - before;
    spent += seconds;
    out = {hamel::test::largest_difference(end_of(run), reference),
           std::fmin(out.seconds, seconds)};
  }
  return out;
}

/// The time to an error, between the settings around it; infinite where none reaches it.
double time_to(double error, const std::vector<Point>& points) {
  for (size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].error <= error)) continue;
    if (i == 0 || !(points[i - 1].error > error) || std::isinf(points[i - 1].error))
      return points[i].seconds;
    const double part =
        std::log(error / points[i - 1].error) / std::log(points[i].error / points[i - 1].error);
    return points[i - 1].seconds * std::pow(points[i].seconds / points[i - 1].seconds, part);
  }
  return std::numeric_limits<double>::infinity();
}

double time_of(const hamel::Simulation& simulation, bool adaptive,
               const std::vector<double>& reference) {
  std::vector<Point> points;
  const double goal = adaptive ? 1e-6 : 1e-3;
  for (int i = 0; i < (adaptive ? 17 : 8); ++i) {
    hamel::Simulation made = simulation;
    if (adaptive) made.scheme("dop853").tolerance({.relative = 1e-4 * std::pow(10, -0.5 * i)});
    else made.scheme("lift").step(0.08 * std::pow(2, -i));
    points.push_back(measure(made, reference));
    if (points.back().error <= goal) break;
  }
  return time_to(goal, points);
}

struct Sum {
  double logs = 0;
  int count = 0;
  void add(double ratio) {
    if (!std::isfinite(ratio) || ratio <= 0) return;
    logs += std::log(ratio);
    ++count;
  }
  double mean() const { return std::exp(logs / count); }
};

}  // namespace

int main(int argc, char** argv) {
  std::set<std::string> wanted;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--quick") quick = true;
    else wanted.insert(word);
  }
  Sum explicit_ratio, implicit_ratio;
  std::printf("%-22s %12s %12s %8s %12s %12s %8s\n", "", "dop853", "exp", "ratio", "lift", "exp",
              "ratio");
  for (const std::string& name : hamel::systems()) {
    if (!wanted.empty() && !wanted.contains(name)) continue;
    try {
      std::vector<double> references[2];
      double times[2][2];
      const char* taus[] = {"cayley", "exp"};
      for (int i = 0; i < 2; ++i) {
        hamel::Run run = hamel::simulate(name)
                             .retraction(taus[i])
                             .scheme("dop853")
                             .tolerance({.relative = 1e-13})
                             .until(kUntil)
                             .build();
        const auto status = run.advance_to(kUntil);
        if (!status.ok) throw std::runtime_error(status.reason);
        references[i] = end_of(run);
      }
      const double resolved = hamel::test::largest_difference(references[0], references[1]);
      if (!(resolved < 1e-9)) {
        std::printf("%-22s left out: the references differ by %.1e\n", name.c_str(), resolved);
        continue;
      }
      for (int i = 0; i < 2; ++i) {
        const hamel::Simulation simulation =
            hamel::simulate(name).retraction(taus[i]).until(kUntil);
        times[0][i] = time_of(simulation, true, references[1]);
        times[1][i] = time_of(simulation, false, references[1]);
      }
      const double ratio[] = {times[0][1] / times[0][0], times[1][1] / times[1][0]};
      explicit_ratio.add(ratio[0]);
      implicit_ratio.add(ratio[1]);
      std::printf("%-22s %9.1f us %9.1f us %8.2f %9.1f us %9.1f us %8.2f\n", name.c_str(),
                  1e6 * times[0][0], 1e6 * times[0][1], ratio[0], 1e6 * times[1][0],
                  1e6 * times[1][1], ratio[1]);
    } catch (const std::exception& error) {
      std::printf("%-22s left out: %s\n", name.c_str(), error.what());
    }
    std::fflush(stdout);
  }
  std::printf("geometric mean of exp over cayley: dop853 %.2f (%d systems), lift %.2f (%d)\n",
              explicit_ratio.mean(), explicit_ratio.count, implicit_ratio.mean(),
              implicit_ratio.count);
  return 0;
}
