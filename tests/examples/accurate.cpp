// Steps chosen by the error, output at times of one's own, an event that stops a run and one that
// changes its state.
#include <hamel/simulate.hpp>

#include <cmath>
#include <iostream>

int main() {
  // Until the disk leaves the floor: the row of its normal reaction would have to pull.
  const auto fall = hamel::simulate("falling_disk")
                        .start({.velocity = {0.5, 0, 0, 0, 0, 0}})
                        .scheme("dop853")
                        .tolerance({.relative = 1e-10})
                        .output(0.05)
                        .stop_at({"contact_lost", "fallen"})
                        .until(2)
                        .run();
  std::cout << fall.report() << fall.trajectory.rows() << " rows\n\n";
  fall.write("fall.csv");

  // A sleigh in a lane 2 m wide: at each wall its velocity turns round.
  int hits = 0;
  const auto lane =
      hamel::simulate("chaplygin_sleigh")
          .start({.velocity = {1.5, 0.5, 0}})
          .scheme("tsit5")
          .tolerance({.relative = 1e-9})
          .on_event("y=1", [&](hamel::EventState& at) { ++hits, at.velocity[1] *= -1; })
          .on_event("y=-1", [&](hamel::EventState& at) { ++hits, at.velocity[1] *= -1; })
          .until(30)
          .run();
  std::cout << lane.report() << hits << " hits\n\n";

  // The same sleigh by reversible steps of lift, there and back.
  auto run =
      hamel::simulate("chaplygin_sleigh").scheme("lift").tolerance({.relative = 1e-6}).build();
  const auto start = run.state();
  bool ok = static_cast<bool>(run.step(2000));
  const double h = run.state().time;
  const auto middle = run.at(h - 2e-4);  // between the last two nodes
  run.turn_back();
  ok = ok && run.step(2000);
  const double away = hamel::euclidean_distance(run.state().coordinates, start.coordinates);
  std::cout << "2000 steps to t = " << h << " and back: " << away << " m away\n";

  double widest = 0;
  for (const double y : lane.trajectory.column("y")) widest = std::fmax(widest, std::abs(y));
  return fall && fall.events.size() == 1 && lane && hits > 0 && widest < 1 + 1e-9 && ok &&
                 away < 1e-9 && middle.time < h
             ? 0
             : 1;
}
