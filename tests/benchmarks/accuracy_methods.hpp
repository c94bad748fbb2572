// Methods scanned over their steps or tolerances, and those of hamel: what the benchmark accuracy
// measures.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hamel/hamel.hpp>

#include "../framework/distances.hpp"

namespace hamel::benchmarks {

using Answer = std::vector<double>;
using Clock = std::chrono::steady_clock;

constexpr double kErrors[] = {1e-4, 1e-6, 1e-8, 1e-10};
inline bool quick = false;

/// A method with its settings, steps or tolerances, from cheap to accurate.
struct Method {
  std::string family, name;
  std::vector<double> settings;
  std::function<void(double setting)> prepare;  // not timed
  std::function<bool()> run;                    // from the start to the end
  std::function<Answer()> answer;
};

/// What one setting of a method costs, and what it reaches.
struct Scanned {
  std::string name;
  double setting = 0, error = 0, seconds = std::numeric_limits<double>::infinity();
};
using Points = std::vector<std::pair<std::string, std::vector<Scanned>>>;  // of each family

inline double seconds_of(const std::function<bool()>& run, bool& good) {
  const auto begin = Clock::now();
  good = run();
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The least time of up to 200 repetitions within 30 ms.
inline Scanned measure(const Method& method, double setting, const Answer& reference) {
  Scanned point{method.name, setting};
  method.prepare(setting);
  bool good = true;
  double spent = point.seconds = seconds_of(method.run, good);
  point.error = good ? test::largest_difference(method.answer(), reference)
                     : std::numeric_limits<double>::infinity();
  if (!(point.error < 1)) return point;
  for (int i = 1; i < (quick ? 2 : 200) && spent < 0.03; ++i) {
    method.prepare(setting);
    const double seconds = seconds_of(method.run, good);
    point.seconds = std::min(point.seconds, seconds);
    spent += seconds;
  }
  return point;
}

inline double least_of_200(const std::function<void()>& act) {
  double out = std::numeric_limits<double>::infinity();
  bool good = true;
  for (int i = 0; i < 200; ++i) {
    out = std::min(out, seconds_of(
                            [&] {
                              act();
                              return true;
                            },
                            good));
  }
  return out;
}

inline std::vector<double> tolerances(double from, double to, int per_decade) {
  std::vector<double> out;
  const double ratio = std::pow(10, -1.0 / per_decade);
  for (double x = from; x >= to * 0.999; x *= ratio) out.push_back(x);
  return out;
}
inline std::vector<double> steps(double longest, double shortest) {
  std::vector<double> out;
  for (double h = longest; h >= shortest; h /= std::sqrt(2.0)) out.push_back(h);
  return out;
}

/// A method of hamel's.
struct Ours {
  std::string scheme, compose = "none";
  bool chosen = false;  // steps chosen by the error: its settings are tolerances
};
inline const std::vector<Ours> kOurs = {
    {"lift"},  {"lift", "suzuki4"},      {"lift", "kahan_li6"},   {"lift", "suzuki_umeno8"},
    {"rkmk4"}, {"dopri5", "none", true}, {"tsit5", "none", true}, {"dop853", "none", true}};

inline Method ours(const Simulation& simulation, const Ours& method) {
  auto run = std::make_shared<std::unique_ptr<hamel::Run>>();
  Method out;
  out.family = "hamel";
  out.name = method.compose == "none" ? method.scheme : method.scheme + " " + method.compose;
  out.settings = method.chosen ? tolerances(1e-2, 1e-13, 4) : steps(0.5, 2e-4);
  auto set_up = [simulation, method](double setting) {
    Simulation made = simulation;
    made.scheme(method.scheme).compose(method.compose);
    if (method.chosen) return made.tolerance({.relative = setting});
    const double until = made.config().until, count = std::ceil(until / setting);
    return made.step(until / count);
  };
  out.prepare = [run, set_up, built = 0.0](double h) mutable {
    if (built == h) return (*run)->restart((*run)->config().start);
    *run = std::make_unique<hamel::Run>(set_up(h).build());
    built = h;
  };
  out.run = [run, chosen = method.chosen] {
    const Config& config = (*run)->config();
    return (chosen ? (*run)->advance_to(config.until) : (*run)->step(config.steps())).ok;
  };
  out.answer = [run] {
    const Snapshot& end = (*run)->state();
    Answer answer = end.coordinates;
    answer.insert(answer.end(), end.velocity.begin(), end.velocity.end());
    return answer;
  };
  return out;
}

inline std::string microseconds(double seconds) {
  char out[32];
  std::snprintf(out, sizeof out, seconds < 1e-4 ? "%.1f us" : "%.0f us", 1e6 * seconds);
  return out;
}

/// Of each family for each error the cheapest point, and its time over hamel's.
inline void print(const Points& points) {
  std::printf("  %-20s", "error at most");
  for (const double error : kErrors) std::printf(" %-44.0e", error);
  std::printf("\n");
  std::vector<double> first;
  for (const auto& [family, all] : points) {
    std::printf("  %-20s", family.c_str());
    for (size_t i = 0; i < std::size(kErrors); ++i) {
      Scanned best;
      for (const Scanned& point : all) {
        if (point.error <= kErrors[i] && point.seconds < best.seconds) best = point;
      }
      if (first.size() <= i) first.push_back(best.seconds);
      char text[96] = "not reached";
      if (std::isfinite(best.seconds)) {
        char ratio[32] = "";
        if (std::isfinite(first[i]) && family != points.front().first)
          std::snprintf(ratio, sizeof ratio, " hamel/it %.2g", first[i] / best.seconds);
        std::snprintf(text, sizeof text, "%s%s%s (%.1e)", microseconds(best.seconds).c_str(), ratio,
                      best.name == family ? "" : (" " + best.name).c_str(), best.error);
      }
      std::printf(" %-44s", text);
    }
    std::printf("\n");
  }
}

}  // namespace hamel::benchmarks
