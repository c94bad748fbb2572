// A solver of your own is one function, and is used by name.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <Eigen/LU>
#include <hamel/hamel.hpp>

// Broyden's method: the Jacobian once, at the guess; then its inverse follows by rank-one updates.
// F is scaled: |F(x)| <= tolerance is the goal. The library keeps the best x that was evaluated and
// judges the solve by its residual.
static void broyden(const hamel::Equation& equation, std::span<double> x, double tolerance) {
  const int n = equation.size();
  Eigen::Map<Eigen::VectorXd> point(x.data(), n);
  Eigen::VectorXd f(n), next(n);
  Eigen::MatrixXd inverse(n, n);
  equation.evaluate(x, {f.data(), x.size()}, {inverse.data(), x.size() * x.size()});
  inverse = inverse.inverse().eval();
  for (int k = 0; k < 50; ++k) {
    const Eigen::VectorXd step = -inverse * f;
    point += step;
    equation.evaluate(x, {next.data(), x.size()}, {});
    if (!(next.norm() > tolerance)) return;
    const Eigen::VectorXd change = inverse * (next - f);
    inverse += (step - change) * (step.transpose() * inverse) / step.dot(change);
    f = next;
  }
}

int main() {
  hamel::registry().add_solver("broyden", "one Jacobian, then rank-one updates", broyden);

  auto sleigh = hamel::simulate("chaplygin_sleigh").step(0.02).until(20);
  const auto mine = sleigh.solver("broyden", {.tolerance = 1e-13}).run();
  const auto newton = sleigh.solver("newton", {.tolerance = 1e-13}).run();
  std::cout << mine.report() << newton.report();

  double apart = 0;
  for (size_t i = 0; i < 3; ++i) {
    apart = std::max(apart, std::abs(mine.last.coordinates[i] - newton.last.coordinates[i]));
  }
  std::cout << "apart by " << apart << " after 1000 steps\n";
  const bool good = mine && newton && apart < 1e-8;
  if (!good) std::cerr << "own_solver: expected both to solve the same equations\n";
  return good ? 0 : 1;
}
