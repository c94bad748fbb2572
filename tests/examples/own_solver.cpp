// A solver of your own behind the one interface, and used by name.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include <Eigen/LU>
#include <hamel/hamel.hpp>

// Broyden's method: the Jacobian once, at the guess; then its inverse follows by rank-one updates.
class Broyden : public hamel::Solver {
 public:
  hamel::SolveReport solve(const hamel::Equation& equation, std::span<double> x,
                           double tolerance) override {
    const int n = equation.size();
    Eigen::Map<Eigen::VectorXd> point(x.data(), n);
    Eigen::VectorXd f(n), next(n);
    Eigen::MatrixXd inverse(n, n);
    equation.evaluate(x, {f.data(), x.size()}, {inverse.data(), x.size() * x.size()});
    inverse = inverse.inverse().eval();
    hamel::SolveReport report{.residual = f.norm() / equation.scale(), .evaluations = 1};
    while (report.iterations < 50) {
      const Eigen::VectorXd step = -inverse * f;
      point += step;
      equation.evaluate(x, {next.data(), x.size()}, {});
      ++report.iterations;
      ++report.evaluations;
      report.residual = next.norm() / equation.scale();
      if (!std::isfinite(report.residual)) {
        report.reason = hamel::Reason::not_finite;
        return report;
      }
      if (report.residual <= tolerance) return report;
      const Eigen::VectorXd change = inverse * (next - f);
      inverse += (step - change) * (step.transpose() * inverse) / step.dot(change);
      f = next;
    }
    report.reason = hamel::Reason::max_iterations;
    return report;
  }
};

int main() {
  hamel::registry().add(hamel::SolverInfo{"broyden", "one Jacobian, then rank-one updates",
                                          "Broyden 1965",
                                          [] { return std::make_shared<Broyden>(); }});
  auto sleigh = hamel::simulate("chaplygin_sleigh").step(0.02).until(20);
  const auto broyden = sleigh.solver("broyden", {.tolerance = 1e-13}).run();
  const auto newton = sleigh.solver("newton", {.tolerance = 1e-13}).run();
  std::cout << broyden.report() << newton.report();

  double apart = 0;
  for (size_t i = 0; i < 3; ++i) {
    apart = std::max(apart, std::abs(broyden.last.coordinates[i] - newton.last.coordinates[i]));
  }
  std::cout << "apart by " << apart << " after 1000 steps\n";
  const bool good = broyden && newton && apart < 1e-8;
  if (!good) std::cerr << "own_solver: expected both to solve the same equations\n";
  return good ? 0 : 1;
}
