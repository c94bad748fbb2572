// Derivatives of a run: along it, of one number at its end, and from state to state.
#include <hamel/simulate.hpp>

#include <cmath>
#include <fstream>
#include <iostream>
#include <variant>
#include <vector>

int main() {
  const auto sleigh = hamel::simulate("chaplygin_sleigh")
                          .set("offset", 0.2)  // m
                          .start({.velocity = {1, 1, 0}})
                          .scheme("dop853")
                          .tolerance({.relative = 1e-10})
                          .output(0.5)
                          .until(4);

  // How the whole motion depends on the offset and on the first turning rate.
  const hamel::Sensitivities along = sleigh.sensitivities({"offset", "start.omega"});
  std::ofstream("derivatives.csv") << along.rows.csv();

  // Where the sleigh ends, and what moves this place most.
  const hamel::Gradient far =
      sleigh.gradient("sqrt(x^2 + y^2)", {"mass", "inertia", "offset", "start.v1", "start.omega"});
  if (!far.status.ok) return 1;
  std::cout << far.value << " m away\n";
  for (size_t i = 0; i < far.names.size(); ++i)
    std::cout << "  by " << far.names[i] << ": " << far.by[i] << " (+- " << far.errors[i] << ")\n";

  // The same sleigh 1 % further to the front, run again: the derivative foretells where it ends.
  const auto moved = hamel::Simulation(sleigh).set("offset", 0.202).run();
  const double x = moved.trajectory.column("x").back(), y = moved.trajectory.column("y").back();
  const double foretold = far.value + 0.002 * far.by[2];
  std::cout << "offset 0.202: " << std::hypot(x, y) << ", foretold " << foretold << "\n";

  // A run by hand has the matrix that takes variations of its start to its current state.
  hamel::Run run = sleigh.build();
  const bool ok = run.advance_to(2).ok;
  const hamel::RunTangent tangent = run.tangent();
  std::cout << "d(omega)/d(start omega) at t = 2: " << tangent.matrix(3, 3) << "\n";

  const auto& end =
      std::get<std::vector<double>>(along.rows.column("d(omega)/d(start.omega)").values);
  return along.status.ok && ok && tangent.status.ok && end.size() == 9 &&
                 std::abs(tangent.matrix(3, 3) - end[4]) < 1e-7 &&
                 std::abs(foretold - std::hypot(x, y)) < 1e-4
             ? 0
             : 1;
}
