// Time to an accuracy: hamel's methods, Boost.odeint and SUNDIALS, in one run.
//
//   build/tests/benchmarks/accuracy [--quick] [system ...]
// The error is the largest difference of the element's columns and of xi at the end of the run from
// a reference: the equations reduced by hand (hand_reduced.hpp) in long double by Fehlberg's 7(8)
// at 1e-17. What hamel's own most accurate run differs from it by is printed first. Every method is
// scanned over its step or tolerance, and takes for each error the cheapest setting that reaches
// it; its time is the least of many repetitions, from the start to the end, with nothing recorded.
// SUNDIALS where libsundials-dev is installed (tools/setup --peers).
#include <boost/numeric/odeint.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <hamel/hamel.hpp>

#include "hand_reduced.hpp"
#ifdef HAMEL_HAS_SUNDIALS
#include "sundials_peers.hpp"
#endif

namespace {

using namespace hamel;  // a program, not a header
using namespace hamel::benchmarks;
using Answer = std::vector<double>;
using Clock = std::chrono::steady_clock;

constexpr double kErrors[] = {1e-4, 1e-6, 1e-8, 1e-10};
bool quick = false;

/// A method with its settings, steps or tolerances, from cheap to accurate.
struct Method {
  std::string family, name;
  std::vector<double> settings;
  std::function<void(double setting)> prepare;  // not timed
  std::function<bool()> run;                    // from the start to the end
  std::function<Answer()> answer;
};

/// What one setting of a method costs, and what it reaches.
struct Point {
  std::string name;
  double setting = 0, error = 0, seconds = std::numeric_limits<double>::infinity();
};
using Points = std::vector<std::pair<std::string, std::vector<Point>>>;  // of each family

double distance(const Answer& a, const Answer& b) {
  double out = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double d = std::abs(a[i] - b[i]);
    if (!(d <= out)) out = std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
  }
  return out;
}

double seconds_of(const std::function<bool()>& run, bool& good) {
  const auto begin = Clock::now();
  good = run();
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The least time of up to 200 repetitions within 30 ms.
Point measure(const Method& method, double setting, const Answer& reference) {
  Point point{method.name, setting};
  method.prepare(setting);
  bool good = true;
  double spent = point.seconds = seconds_of(method.run, good);
  point.error =
      good ? distance(method.answer(), reference) : std::numeric_limits<double>::infinity();
  if (!(point.error < 1)) return point;
  for (int i = 1; i < (quick ? 2 : 200) && spent < 0.03; ++i) {
    method.prepare(setting);
    const double seconds = seconds_of(method.run, good);
    point.seconds = std::min(point.seconds, seconds);
    spent += seconds;
  }
  return point;
}

double least_of_200(const std::function<void()>& act) {
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

std::vector<double> tolerances(double from, double to, int per_decade) {
  std::vector<double> out;
  const double ratio = std::pow(10, -1.0 / per_decade);
  for (double x = from; x >= to * 0.999; x *= ratio) out.push_back(x);
  return out;
}
std::vector<double> steps(double longest, double shortest) {
  std::vector<double> out;
  for (double h = longest; h >= shortest; h /= std::sqrt(2.0)) out.push_back(h);
  return out;
}

/// One system: a run of hamel's, and its equations reduced by hand.
template <class S, template <class> class ByHand>
struct Case {
  std::string name;
  S system;
  double until;
  Start start;

  Simulation simulation() const {
    Simulation out = simulate(S::name());
    detail::FieldReader fields;
    S copy = system;
    copy.fields(fields);
    for (const Field& field : fields.fields) out.set(field.name, field.value);
    return out.start(start).until(until);
  }
};

/// A method of hamel's.
struct Ours {
  std::string scheme, compose = "none";
  bool chosen = false;  // steps chosen by the error: its settings are tolerances
};
const std::vector<Ours> kOurs = {
    {"lift"},  {"lift", "suzuki4"},      {"lift", "kahan_li6"},   {"lift", "suzuki_umeno8"},
    {"rkmk4"}, {"dopri5", "none", true}, {"tsit5", "none", true}, {"dop853", "none", true}};

Method ours(const Simulation& simulation, const Ours& method) {
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

/// An embedded pair of odeint's with its own step control.
template <template <class...> class Stepper, class Equations>
Method odeint(const std::string& name, const Equations& equations, double until) {
  using State = typename Equations::State;
  auto y = std::make_shared<State>();
  auto tolerance = std::make_shared<double>();
  Method out;
  out.family = out.name = name;
  out.settings = tolerances(1e-2, 1e-13, 4);
  out.prepare = [tolerance](double setting) { *tolerance = setting; };
  out.run = [=] {
    using namespace boost::numeric::odeint;
    *y = equations.start();
    integrate_adaptive(make_controlled<Stepper<State>>(*tolerance, *tolerance),
                       std::cref(equations), *y, 0.0, until, 0.01);
    return true;
  };
  out.answer = [=] { return equations.answer(*y); };
  return out;
}

#ifdef HAMEL_HAS_SUNDIALS
template <class Peer>
Method sundials_method(const std::string& name, std::shared_ptr<Peer> peer, double until) {
  auto tolerance = std::make_shared<double>();
  Method out;
  out.family = out.name = name;
  out.settings = tolerances(1e-2, 1e-13, 4);
  out.prepare = [tolerance](double setting) { *tolerance = setting; };
  out.run = [=] { return (*peer)(*tolerance, until); };
  out.answer = [=] { return peer->answer(); };
  return out;
}
#endif

template <class Equations>
Answer reference_of(const Equations& equations, double until) {
  using namespace boost::numeric::odeint;
  using State = typename Equations::State;
  using Stepper = runge_kutta_fehlberg78<State, long double, State, long double>;
  State y = equations.start();
  integrate_adaptive(make_controlled<Stepper>(1e-17L, 1e-17L), std::cref(equations), y, 0.0L,
                     static_cast<long double>(until), 0.001L);
  return equations.answer(y);
}

std::string microseconds(double seconds) {
  char out[32];
  std::snprintf(out, sizeof out, seconds < 1e-4 ? "%.1f us" : "%.0f us", 1e6 * seconds);
  return out;
}

/// Of each family for each error the cheapest point, and its time over hamel's.
void print(const Points& points) {
  std::printf("  %-20s", "error at most");
  for (const double error : kErrors) std::printf(" %-44.0e", error);
  std::printf("\n");
  std::vector<double> first;
  for (const auto& [family, all] : points) {
    std::printf("  %-20s", family.c_str());
    for (size_t i = 0; i < std::size(kErrors); ++i) {
      Point best;
      for (const Point& point : all) {
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

template <class S, template <class> class ByHand>
void compare(const Case<S, ByHand>& it) {
  using boost::numeric::odeint::runge_kutta_dopri5;
  using boost::numeric::odeint::runge_kutta_fehlberg78;
  const ByHand<double> equations(it.system);
  const Answer reference = reference_of(ByHand<long double>(it.system), it.until);
  const Simulation simulation = it.simulation();
  std::vector<Method> methods;
  for (const Ours& method : kOurs) methods.push_back(ours(simulation, method));
  methods.push_back(odeint<runge_kutta_dopri5>("odeint dopri5", equations, it.until));
  methods.push_back(odeint<runge_kutta_fehlberg78>("odeint fehlberg78", equations, it.until));
#ifdef HAMEL_HAS_SUNDIALS
  using Ode = SundialsOde<ByHand<double>>;
  methods.push_back(sundials_method("ARKODE 5(4)", std::make_shared<Ode>(equations, 5), it.until));
  methods.push_back(sundials_method("CVODE Adams", std::make_shared<Ode>(equations, 0), it.until));
  const hamel::Run built = simulation.build();
  methods.push_back(sundials_method(
      "IDA, multipliers",
      std::make_shared<Multipliers<S>>(built.system(), it.system, built.config().start), it.until));
#endif

  Points points;
  double agreement = std::numeric_limits<double>::infinity();
  for (const Method& method : methods) {
    if (points.empty() || points.back().first != method.family)
      points.push_back({method.family, {}});
    for (const double setting : method.settings) {
      const Point point = measure(method, setting, reference);
      points.back().second.push_back(point);
      if (method.family == "hamel") agreement = std::min(agreement, point.error);
      if (point.error < kErrors[std::size(kErrors) - 1] || (quick && point.error < 1e-6)) break;
      if (point.seconds > 1) break;
    }
  }
  const double set_up = least_of_200([&] { (void)simulation.build(); });
  std::printf("\n%s, %g s; hamel's most accurate run differs from the reduction by hand by %.1e\n",
              it.name.c_str(), it.until, agreement);
  print(points);
  hamel::Run run = simulation.build();
  const Start start = run.config().start;
  const double again = least_of_200([&] {
    run.restart(start);
    run.step();
  });
  std::printf(
      "  setting a run up takes %s, starting it again from another state, with a step, %s\n",
      microseconds(set_up).c_str(), microseconds(again).c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::set<std::string> wanted;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--quick") quick = true;
    else wanted.insert(word);
  }
  const auto asked = [&](const char* name) { return wanted.empty() || wanted.contains(name); };
  Suslov suslov;
  suslov.moments = {2, 0.3, 0.5, 3, 0.4, 4};
  if (asked("suslov")) {
    compare(
        Case<Suslov, SuslovByHand>{"suslov, full inertia", suslov, 20, {.velocity = {1, 0.5, 0}}});
  }
  if (asked("chaplygin_sleigh"))
    compare(Case<ChaplyginSleigh, SleighByHand>{"chaplygin_sleigh", {}, 20, {}});
  if (asked("falling_disk")) compare(Case<FallingDisk, DiskByHand>{"falling_disk", {}, 5, {}});
  if (asked("rattleback")) compare(Case<Rattleback, RattlebackByHand>{"rattleback", {}, 5, {}});
  return 0;
}
