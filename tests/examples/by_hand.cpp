// Stepping by hand, watching a run, and the result of a failed step.
#include <cmath>
#include <iostream>

#include <hamel/simulate.hpp>

int main() {
  // One step at a time, until the sleigh has turned a quarter.
  hamel::Run sleigh = hamel::simulate("chaplygin_sleigh").step(0.01).build();
  while (std::abs(sleigh.state().coordinates[0]) < 1.57) {
    if (const hamel::Status status = sleigh.step(); !status) {
      std::cerr << "step " << status.step << ": " << status.reason << "\n";
      return 1;
    }
  }
  const hamel::Snapshot& now = sleigh.state();
  std::cout << "a quarter turn at t = " << now.time << " s, " << now.step << " steps, heading "
            << now.coordinates[0] << ", energy " << now.energy << ", constraint residual "
            << now.constraint << "\n";

  // A run that an observer ends is a good run: every recorded state is shown to it.
  const auto watched = hamel::simulate("chaplygin_sleigh")
                           .observe([](const hamel::Snapshot& s) { return s.velocity[1] < 0; })
                           .run();
  std::cout << "the sleigh turns round at t = " << watched.last.time << ": "
            << watched.status.reason << "\n";

  // A run that cannot continue is not an exception. This step is so long that, once the sleigh
  // turns fast, one step would turn it by more than pi. The good steps are kept, and written like
  // any others.
  const auto failed = hamel::simulate("chaplygin_sleigh")
                          .start({.velocity = {0.05, -1, 0}})
                          .retraction("exp")
                          .step(1.5)
                          .until(60)
                          .run();
  std::cout << failed.report();

  // A run that cannot start is one exception, before anything runs, with every mistake in it.
  size_t mistakes = 0;
  try {
    hamel::simulate("suslof").scheme("lfit").s(1.5).step(0).run();
  } catch (const hamel::ConfigError& error) {
    mistakes = error.mistakes().size();
    std::cout << error.what() << "\n";
  }

  const bool good = std::abs(now.coordinates[0]) < 1.6 && now.constraint < 1e-12 && watched &&
                    watched.last.velocity[1] >= 0 && !failed && failed.steps > 0 &&
                    failed.status.step == failed.steps + 1 &&
                    failed.trajectory.rows() == static_cast<size_t>(failed.steps) + 1 &&
                    mistakes == 4;
  if (!good) std::cerr << "by_hand: not as commented\n";
  return good ? 0 : 1;
}
