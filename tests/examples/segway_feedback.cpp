// A segway balanced and steered by state feedback at 200 Hz: it falls without.
#include <cmath>
#include <iostream>

#include <hamel/simulate.hpp>

namespace {

// The motors' torques at a state, to run at `speed` and turn at `rate`. From M v' + m b p'' = T / R
// and m b v' + (I2 + m b^2) p'' = m g b p - T, T the sum of both, the gains on (pitch, pitch', v -
// speed) put the poles to -1, -3 and -4 per second.
struct Torques {
  double right, left;
};
Torques feedback(const hamel::Snapshot& now, double speed, double rate) {
  const double pitch = now.coordinates[5];
  const auto& xi = now.velocity;  // omega, v1, v2, right', left', pitch'
  const double sum = 217 * pitch + 41 * xi[5] + 7 * (xi[1] - speed);
  const double difference = 10 * (rate - xi[0]);
  return {(sum + difference) / 2, (sum - difference) / 2};
}

}  // namespace

int main() {
  // A first value declares an input of this run; those not named are 0.
  hamel::Run segway = hamel::simulate("segway").step(0.001).input("right_torque", 0).build();
  constexpr double period = 0.005;
  double largest = 0;
  for (int k = 0; k < 3000; ++k) {  // 15 s
    const double speed = k < 1500 ? 1 : 0.5, rate = k < 1500 ? 0.5 : -0.5;
    const Torques torques = feedback(segway.state(), speed, rate);
    segway.input("right_torque", torques.right);
    segway.input("left_torque", torques.left);
    if (const hamel::Status status = segway.advance_to((k + 1) * period); !status) {
      std::cerr << status.reason << "\n";
      return 1;
    }
    largest = std::max(largest, std::abs(segway.state().coordinates[5]));
  }
  const hamel::Snapshot& end = segway.state();
  std::cout << "balanced: pitch at most " << largest << " rad; after " << end.time
            << " s it runs at " << end.velocity[1] << " m/s and turns at " << end.velocity[0]
            << " rad/s\n";

  // Without the motors, from the same start.
  const auto fallen =
      hamel::simulate("segway")
          .step(0.001)
          .until(5)
          .observe([](const hamel::Snapshot& s) { return std::abs(s.coordinates[5]) < 1; })
          .run();
  std::cout << "without: the pitch is 1 rad after " << fallen.last.time << " s\n";

  const bool good = largest < 0.3 && std::abs(end.velocity[1] - 0.5) < 0.01 &&
                    std::abs(end.velocity[0] + 0.5) < 0.01 && fallen.last.time < 3;
  if (!good) std::cerr << "segway_feedback: not as commented\n";
  return good ? 0 : 1;
}
