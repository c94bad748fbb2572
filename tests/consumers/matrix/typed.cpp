// A user's own system through the typed door, compiled with the schemes for its types and by the
// library's schemes: every verb that carries objects between the program's templates and the
// library.
#include <cstdio>
#include <vector>

#include <Eigen/Dense>
#include <hamel/framework/analysis/analysis.hpp>
#include <hamel/hamel.hpp>

struct Sleigh {  // v2 = 0 at the blade
  using Group = hamel::SE2;
  double m = 1.0, J = 0.1, a = 0.2;
  auto inertia() const {
    return hamel::Mat<3, 3>{{J + m * a * a, 0, m * a}, {0, m, 0}, {m * a, 0, m}};
  }
  auto constraints() const { return hamel::Mat<1, 3>{0, 0, 1}; }
  static std::string name() { return "sleigh"; }
  hamel::Start start() const { return {.velocity = {0.9, 1, 0}}; }
  void fields(auto& f) { f("m", m, "kg"), f("J", J, "kg m^2"), f("a", a, "m"); }
};

namespace {

bool good = true;
void expect(bool condition, const char* what) {
  if (!condition) std::printf("FAILED: %s\n", what);
  good = good && condition;
}

// Runs by hand are built, moved and let go; a part of them is freed here that the library
// allocated, or the other way.
template <class Simulation>
void by_hand(const Simulation& simulation, const char* what) {
  std::vector<hamel::Run> runs;
  for (int k = 0; k < 3; ++k) runs.push_back(simulation.build());
  for (hamel::Run& run : runs) expect(run.step(10).ok, what);
  expect(runs[0].at(0.095).time == 0.095, what);
  expect(runs[1].advance_to(0.5).ok, what);
  runs[1].restart({.velocity = {0.5, 1, 0}});
  expect(runs[1].step().ok && runs[1].state().step == 1, what);
  runs[2].turn_back();
  expect(runs[2].step(10).ok && runs[2].system().name == "sleigh", what);
  runs[0] = std::move(runs[2]);
  const hamel::Result result = runs[0].finish();
  expect(result.steps == 20 && result.system->group.name == "se2", what);
}

void own_solver() {
  hamel::registry().add_solver("picard", "fixed-point iteration on F",
                               [](const hamel::Equation& equation, std::span<double> x, double) {
                                 Eigen::VectorXd f(static_cast<Eigen::Index>(x.size()));
                                 for (int k = 0; k < 50; ++k) {
                                   equation.evaluate(x, {f.data(), x.size()}, {});
                                   for (size_t i = 0; i < x.size(); ++i)
                                     x[i] -= 0.5 * f[static_cast<Eigen::Index>(i)];
                                 }
                               });
  expect(hamel::simulate(Sleigh{})
             .solver("picard")
             .step(0.01)
             .on_failure("retry:newton")
             .until(0.1)
             .build()
             .step()
             .ok,
         "own solver");
}

}  // namespace

int main() {
  using hamel::Cayley, hamel::Lift, hamel::Rkmk4;
  const auto typed = hamel::simulate<Lift, Cayley>(Sleigh{}).until(2);
  const auto pair = hamel::simulate<hamel::Dopri5, Cayley>(Sleigh{}).until(2);
  const auto named = hamel::simulate(Sleigh{}).step(0.01).until(2);
  const auto one = typed.run(), other = named.run();
  by_hand(hamel::simulate<Lift, Cayley>(Sleigh{}).step(0.01), "typed by hand");
  by_hand(hamel::simulate<Rkmk4, hamel::Exp>(Sleigh{}).step(0.01), "typed rkmk4 by hand");
  by_hand(hamel::simulate(Sleigh{}).step(0.01), "named by hand");
  expect(static_cast<bool>(hamel::Simulation(pair).tolerance({1e-8}).run()), "typed pair");
  expect(typed.run().events.empty() &&
             !hamel::Simulation(typed).events({"theta=0.5"}).run().events.empty(),
         "events");
  const auto bounce = [](hamel::EventState& s) { s.velocity[0] *= -0.5; };
  expect(static_cast<bool>(hamel::Simulation(typed).on_event("theta=0.5", bounce).run()), "impact");
  own_solver();

  hamel::Analysis analysis;
  hamel::add_system<Sleigh>(hamel::registry());
  analysis = hamel::analyse(hamel::registry(), "sleigh");
  const Eigen::MatrixXd frame = analysis.frame, copy = frame * 2;
  const double apart = std::abs(one.last.velocity[0] - other.last.velocity[0]);
  std::printf("%s%g %s\n", one.report().c_str(), apart, analysis.conserved[0].expression.c_str());
  expect(one && other && apart < 1e-12 && copy.cols() == 2, "typed and named");
  return good ? 0 : 1;
}
