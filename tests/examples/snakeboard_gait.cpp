// A snakeboard whose rider follows a table: the rates of the rotor and of the axles over
// time.
#include <cmath>
#include <iostream>

#include <hamel/simulate.hpp>

int main() {
  // A gait, 100 rows a second: rotor and axles swing together, the axles against each other.
  hamel::InputTable rotor, front, back;
  for (int k = 0; k <= 1000; ++k) {
    const double t = 0.01 * k, swing = 2 * std::cos(2 * t);
    for (auto [table, amplitude] : {std::pair{&rotor, 0.7}, {&front, 0.3}, {&back, -0.3}}) {
      table->times.push_back(t);
      table->values.push_back(amplitude * swing);
    }
  }
  const auto driven = hamel::simulate("snakeboard")
                          .set("rotor_amplitude", 0)  // no swing of its own
                          .set("steering_amplitude", 0)
                          .input("rotor_rate", rotor)  // or hamel::InputFile{"rotor.csv"}
                          .input("front_rate", front)
                          .input("back_rate", back)
                          .step(0.01)
                          .until(10)
                          .run();
  std::cout << driven.report();

  // It is the swing that the system has of itself, but for the straight lines between the rows of
  // the table.
  const auto own = hamel::simulate("snakeboard").step(0.01).until(10).run();
  const double apart = std::hypot(driven.last.coordinates[1] - own.last.coordinates[1],
                                  driven.last.coordinates[2] - own.last.coordinates[2]);
  const double way = std::hypot(own.last.coordinates[1], own.last.coordinates[2]);
  std::cout << "after 10 s " << way << " m from the start, " << apart
            << " m from where its own swing takes it\n";
  const bool good = driven && way > 0.1 && apart < 1e-3 && driven.energy_balance_error_max < 1e-3;
  if (!good) std::cerr << "snakeboard_gait: not as commented\n";
  return good ? 0 : 1;
}
