// A user's program by name, with every verb of <hamel/simulate.hpp>, and another unit of it that
// uses Eigen on its own account. Prints numbers that must not depend on the flags of this program.
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include <hamel/simulate.hpp>

double second_unit(int n);  // n, by Eigen's ways

namespace {

bool good = true;
void expect(bool condition, const char* what) {
  if (!condition) std::printf("FAILED: %s\n", what);
  good = good && condition;
}
void print(const char* name, const std::vector<double>& values) {
  std::printf("%s", name);
  for (const double x : values) std::printf(" %.17g", x);
  std::printf("\n");
}

void runs() {
  for (const char* name : {"suslov", "falling_disk", "kick_scooter", "se2*so2"}) {
    try {
      const auto result = hamel::simulate(name).step(0.01).until(1).run();
      expect(static_cast<bool>(result) && !result.report().empty() && !result.record().empty(),
             name);
      print(name, result.last.velocity);
    } catch (const hamel::ConfigError& error) {  // the library's exception, caught here
      expect(name == std::string("se2*so2") && error.mistakes().size() == 1, "refused");
    }
  }
}

void by_hand() {
  hamel::Run built = hamel::simulate("segway")
                         .step(0.001)
                         .input("left_torque", 0)
                         .events({"2_theta=0"})
                         .keep_rows(100)
                         .build();
  hamel::Run run = std::move(built);
  for (int k = 0; k < 20; ++k) {
    run.input("left_torque", 0.1 * k);
    expect(run.step(5).ok, "step");
  }
  expect(run.advance_to(0.2).ok && run.at(0.1995).time == 0.1995, "advance_to, at");
  expect(run.inputs() != nullptr && run.notes().size() < 10, "inputs, notes");
  run.restart(run.config().start);
  expect(run.state().time == 0 && run.step(10).ok, "restart");
  std::vector<hamel::Run> others;  // moved as it grows
  for (int k = 0; k < 3; ++k) {
    others.push_back(hamel::simulate("falling_disk").step(0.01).build());
    expect(others.front().step(2).ok, "move");
  }
  others.front().turn_back();
  expect(others.front().step(2).ok && others.front().stats().iterations > 0, "turn_back");
  const hamel::Result result = run.finish();
  expect(result.steps == 10 && result.trajectory.rows() == 11, "finish");
  print("by_hand", result.last.velocity);
}

void events_and_files() {
  const hamel::Result bounced =
      hamel::simulate("chaplygin_sleigh")
          .step(0.01)
          .until(4)
          .on_event("theta=0.5", [](hamel::EventState& s) { s.velocity[0] *= -0.5; })
          .observe([](const hamel::Snapshot& s) { return s.time < 3; })
          .progress([](double) {})
          .record_to("rows.csv")
          .run();
  expect(bounced.events.size() >= 1 && std::remove("rows.csv") == 0, "impact, record_to");
  print("bounced", bounced.last.velocity);
  const hamel::Result chosen =
      hamel::simulate("suslov").scheme("dop853").tolerance({1e-9}).output(0.1).until(2).run();
  chosen.write("rows.json");
  expect(std::remove("rows.json") == 0 && chosen.trajectory.has("xi1"), "write");
  print("chosen", chosen.trajectory.column("xi1"));
}

void studies_and_steady_motions() {
  hamel::StudyConfig config;
  config.until = 1;
  config.repeats = 1;
  config.systems.push_back({.label = "suslov", .name = "suslov"});
  config.axes["step"] = {0.1, 0.05};
  const hamel::StudyResult study = hamel::Study(hamel::registry(), config).threads(1).run();
  expect(study.complete && study.cells.size() == 2 && study.metrics[0].ok, "study");
  const hamel::SteadyMotion motion =
      hamel::steady_motion(hamel::registry(), hamel::simulate("bicycle").speed(5));
  expect(motion.found && !motion.eigenvalues.empty(), "steady");
}

void mechanism() {
  hamel::Mechanism m("scooter");
  const auto deck = m.body("deck", {.mass = 5, .at = {0.3, 0, 0.1}, .box = {0.8, 0.2, 0.05}});
  const auto fork = m.body("fork", {.mass = 2, .at = {0.7, 0, 0.4}, .inertia = {0.1, 0.1, 0.01}});
  m.planar("road", deck);
  m.hinge("steer", deck, fork, {.at = {0.7, 0, 0}, .axis = {0, 0, 1}});
  m.blade("rear", deck, {.at = {0, 0, 0}});
  m.blade("front", fork, {.at = {0.7, 0, 0}});
  m.motor("steer", [](const hamel::SignalInput& now) { return 0.25 - 0.5 * now.t; });
  m.start({{"speed", 2}, {"steer.angle", 0.25}});
  const hamel::Mechanism copy = m;
  const auto result = hamel::simulate(copy).scheme("lift").step(0.01).until(1).run();
  expect(static_cast<bool>(result), "mechanism");
}

void lists() {
  expect(hamel::schemes().size() >= 13 && !hamel::solvers().empty() && !hamel::groups().empty(),
         "lists");
  expect(hamel::retractions("so3").size() >= 2, "retractions");
  const hamel::SystemDescription disk = hamel::describe_system("falling_disk");
  expect(disk.group == "se3" && !disk.parameters.empty() && disk.velocities.size() == 6,
         "describe");
  expect(hamel::systems().size() >= 27, "systems");
}

}  // namespace

int main() {
  runs();
  by_hand();
  events_and_files();
  studies_and_steady_motions();
  mechanism();
  lists();
  return good && second_unit(40) == 40 ? 0 : 1;
}
