// The equations at a state: the torque that keeps a segway from falling on, at this moment, and the
// reactions of its wheels then.
#include <cmath>
#include <iostream>

#include <hamel/simulate.hpp>

int main() {
  const hamel::Equations still(hamel::simulate("segway").input("left_torque", 0));
  constexpr int pitch = 5;  // of omega, v1, v2, right', left', pitch'
  const hamel::Start state = {.configuration = {0, 0, 0, 0, 0, 0.1},
                              .velocity = {0, 1, 0, 4, 4, 0}};

  // xi' is linear in the torques, which are the same on both wheels.
  const double falls = still.rate(0, state)[pitch];
  const double by_torque = still.jacobian("rate", "left_torque", state).values(pitch, 0) +
                           still.jacobian("rate", "right_torque", state).values(pitch, 0);
  const double torque = -falls / by_torque;

  const hamel::Equations held(
      hamel::simulate("segway").input("left_torque", torque).input("right_torque", torque));
  std::cout << "pitch'' = " << falls << " 1/s^2 without torques, " << held.rate(0, state)[pitch]
            << " with " << torque << " N m on each wheel\n";
  const hamel::RowsOfState rows = held.rows(state);
  const std::vector<double> reactions = held.reactions(state);
  for (size_t i = 0; i < reactions.size(); ++i)
    std::cout << rows.names[i] << " = " << reactions[i] << "\n";
  return std::abs(held.rate(0, state)[pitch]) < 1e-9 * std::abs(falls) ? 0 : 1;
}
