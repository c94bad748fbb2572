// Time to an accuracy: hamel's methods, Boost.odeint and SUNDIALS, in one run.
//
//   build/tests/benchmarks/accuracy [--quick] [system ...]
// The error is the largest difference of the element's columns and of xi at the end of the run from
// a reference: the equations reduced by hand (hand_reduced.hpp) in long double by Fehlberg's 7(8)
// at 1e-17; of a mechanism, which nobody reduces by hand, hamel's dop853 at 1e-13, and then there
// are hamel's methods alone. What hamel's own most accurate run differs from it by is printed
// first. Every method is scanned over its step or tolerance, and takes for each error the cheapest
// setting that reaches it; its time is the least of many repetitions, from the start to the end,
// with nothing recorded. SUNDIALS where libsundials-dev is installed (tools/setup --peers).
#include <boost/numeric/odeint.hpp>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <hamel/hamel.hpp>

#include "accuracy_methods.hpp"
#include "hand_reduced.hpp"
#ifdef HAMEL_HAS_SUNDIALS
#include "sundials_peers.hpp"
#endif

namespace {

using namespace hamel;  // a program, not a header
using namespace hamel::benchmarks;

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

/// Scans the methods and prints the cheapest ways to each error; `what` names the reference.
void report(const std::string& name, double until, const Simulation& simulation,
            const std::vector<Method>& methods, const Answer& reference, const char* what) {
  Points points;
  double agreement = std::numeric_limits<double>::infinity();
  for (const Method& method : methods) {
    if (points.empty() || points.back().first != method.family)
      points.push_back({method.family, {}});
    for (const double setting : method.settings) {
      const Scanned point = measure(method, setting, reference);
      points.back().second.push_back(point);
      if (method.family == "hamel") agreement = std::min(agreement, point.error);
      if (point.error < kErrors[std::size(kErrors) - 1] || (quick && point.error < 1e-6)) break;
      if (point.seconds > 1) break;
    }
  }
  const double set_up = least_of_200([&] { (void)simulation.build(); });
  std::printf("\n%s, %g s; hamel's most accurate run differs from %s by %.1e\n", name.c_str(),
              until, what, agreement);
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

std::vector<Method> all_of_ours(const Simulation& simulation) {
  std::vector<Method> out;
  for (const Ours& method : kOurs) out.push_back(ours(simulation, method));
  return out;
}

template <class S, template <class> class ByHand>
void compare(const Case<S, ByHand>& it) {
  using boost::numeric::odeint::runge_kutta_dopri5;
  using boost::numeric::odeint::runge_kutta_fehlberg78;
  const ByHand<double> equations(it.system);
  const Answer reference = reference_of(ByHand<long double>(it.system), it.until);
  const Simulation simulation = it.simulation();
  std::vector<Method> methods = all_of_ours(simulation);
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

  report(it.name, it.until, simulation, methods, reference, "the reduction by hand");
}

/// A mechanism of the library from its start, by hamel's methods alone.
void compare_mechanism(const std::string& name, double until) {
  const Simulation simulation = simulate(name).until(until);
  const Method best = ours(simulation, {"dop853", "none", true});
  best.prepare(1e-13);
  if (!best.run()) throw std::runtime_error(name + ": the reference fails");
  const Answer reference = best.answer();
  // Not what is compared with itself.
  std::vector<Method> methods = all_of_ours(simulation);
  for (Method& method : methods) std::erase_if(method.settings, [](double x) { return x < 5e-13; });
  report(name, until, simulation, methods, reference, "dop853 at 1e-13");
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
  const std::pair<const char*, double> mechanisms[] = {
      {"kick_scooter", 2}, {"bicycle", 2}, {"car", 2}, {"ballbot", 1}};
  for (const auto& [name, until] : mechanisms) {
    if (asked(name)) compare_mechanism(name, until);
  }
  return 0;
}
