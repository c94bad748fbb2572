// A user's own system, compiled with the schemes for its types, and by the library's schemes.
#include <cstdio>

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
};

int main() {
  using hamel::Cayley, hamel::Lift;
  const auto typed = hamel::simulate<Lift, Cayley>(Sleigh{}).until(2).run();
  const auto named = hamel::simulate(Sleigh{}).until(2).run();
  hamel::Analysis analysis;
  hamel::add_system<Sleigh>(hamel::registry());
  analysis = hamel::analyse(hamel::registry(), "sleigh");
  const Eigen::MatrixXd frame = analysis.frame, copy = frame * 2;
  const double apart = std::abs(typed.last.velocity[0] - named.last.velocity[0]);
  std::printf("%s%g %s\n", typed.report().c_str(), apart, analysis.conserved[0].expression.c_str());
  return typed && named && apart < 1e-12 && copy.cols() == 2 ? 0 : 1;
}
