// A unicycle with a reaction wheel, put together by parts, balanced by the linear-quadratic
// regulator of its linearisation at 100 Hz. It falls without.
#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <hamel/simulate.hpp>

namespace {

using Matrix = hamel::NumberMatrix;

constexpr double kSpeed = 1, kPeriod = 0.01;  // m/s, s

hamel::Mechanism unicycle() {
  hamel::Mechanism m("reaction wheel unicycle");
  const auto frame = m.body("frame", {.mass = 4, .at = {0, 0, 0.5}, .box = {0.1, 0.15, 0.5}});
  const auto wheel =
      m.body("wheel", {.mass = 1, .at = {0, 0, 0.15}, .cylinder = {0.15, 0.02}, .axis = {0, 1, 0}});
  const auto rotor =
      m.body("rotor", {.mass = 2, .at = {0, 0, 0.8}, .cylinder = {0.2, 0.02}, .axis = {1, 0, 0}});
  m.free("space", frame, {.at = {0, 0, 0.15}});
  m.hinge("pedals", frame, wheel, {.at = {0, 0, 0.15}, .axis = {0, 1, 0}});
  m.hinge("reaction", frame, rotor, {.at = {0, 0, 0.8}, .axis = {1, 0, 0}});
  m.wheel("tyre", wheel, {.at = {0, 0, 0.15}, .radius = 0.15});
  m.motor("pedals");
  m.motor("reaction");
  m.start({{"speed", kSpeed}});
  return m;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out(a.rows, b.columns);
  for (int i = 0; i < a.rows; ++i)
    for (int j = 0; j < b.columns; ++j)
      for (int k = 0; k < a.columns; ++k) out(i, j) += a(i, k) * b(k, j);
  return out;
}
Matrix transposed(const Matrix& a) {
  Matrix out(a.columns, a.rows);
  for (int i = 0; i < a.rows; ++i)
    for (int j = 0; j < a.columns; ++j) out(j, i) = a(i, j);
  return out;
}
Matrix plus(Matrix a, const Matrix& b, double factor = 1) {
  for (size_t i = 0; i < a.values.size(); ++i) a.values[i] += factor * b.values[i];
  return a;
}
Matrix inverse_of_two(const Matrix& a) {
  const double determinant = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
  Matrix out(2, 2);
  out(0, 0) = a(1, 1) / determinant;
  out(1, 1) = a(0, 0) / determinant;
  out(0, 1) = -a(0, 1) / determinant;
  out(1, 0) = -a(1, 0) / determinant;
  return out;
}
Matrix diagonal(const std::vector<double>& d) {
  Matrix out(static_cast<int>(d.size()), static_cast<int>(d.size()));
  for (int i = 0; i < out.rows; ++i) out(i, i) = d[static_cast<size_t>(i)];
  return out;
}

// K of u = -K x, which minimises the sum of x.Q x + u.R u: the Riccati equation, iterated.
Matrix regulator(const hamel::DiscretePair& system, const Matrix& q, const Matrix& r) {
  const Matrix &a = system.a, &b = system.b;
  Matrix p = q, gain(b.columns, a.rows);
  for (int i = 0; i < 20000; ++i) {
    const Matrix bp = product(transposed(b), p);
    const Matrix next = product(inverse_of_two(plus(product(bp, b), r)), product(bp, a));
    p = plus(q, product(product(transposed(a), p), plus(a, product(b, next), -1)));
    double change = 0;
    for (size_t j = 0; j < gain.values.size(); ++j)
      change = std::max(change, std::abs(next.values[j] - gain.values[j]));
    gain = next;
    if (change < 1e-10) break;
  }
  return gain;
}

}  // namespace

int main() {
  const hamel::Mechanism mechanism = unicycle();
  const hamel::Linearisation linear =
      hamel::linearisation(hamel::registry(), hamel::simulate(mechanism).speed(kSpeed));
  std::cout << linear.motion.growing() << " growing modes; states";
  for (const std::string& name : linear.states) std::cout << " " << name;
  std::cout << "; inputs";
  for (const std::string& name : linear.inputs) std::cout << " " << name;
  std::cout << "\n";

  std::vector<double> weights(linear.states.size(), 1);
  for (size_t i = 0; i < weights.size(); ++i)  // the heading is free; the rotor may spin
    if (linear.states[i] == "w3" || linear.states[i] == "reaction.rate") weights[i] = 1e-3;
  const Matrix gain = regulator(linear.sampled(kPeriod), diagonal(weights), diagonal({0.1, 0.1}));

  // Pushed sideways: the steady motion, and a perturbation that keeps the wheel rolling.
  hamel::Start start = {.configuration = linear.motion.element, .velocity = linear.motion.velocity};
  const int n = static_cast<int>(start.velocity.size());
  for (int j = 0; j < linear.embedding.columns; ++j) {
    if (linear.states[static_cast<size_t>(j)] != "w1") continue;
    for (int i = 0; i < n; ++i)
      start.velocity[static_cast<size_t>(i)] += 0.1 * linear.embedding(n + i, j);
  }
  hamel::Run run = hamel::simulate(mechanism)
                       .start(start)
                       .step(0.001)
                       .input(linear.inputs[0], 0)
                       .input(linear.inputs[1], 0)
                       .build();
  const auto tilt = [](const hamel::Snapshot& s) { return std::acos(s.coordinates[8]); };  // R33
  double largest = 0;
  for (int k = 0; k < 1000; ++k) {  // 10 s
    const std::vector<double> x = linear.state(run.state().coordinates, run.state().velocity);
    for (int i = 0; i < gain.rows; ++i) {
      double u = 0;
      for (int j = 0; j < gain.columns; ++j) u -= gain(i, j) * x[static_cast<size_t>(j)];
      run.input(linear.inputs[static_cast<size_t>(i)], u);
    }
    if (const hamel::Status status = run.advance_to((k + 1) * kPeriod); !status) {
      std::cerr << status.reason << "\n";
      return 1;
    }
    largest = std::max(largest, tilt(run.state()));
  }
  const double left = tilt(run.state()), speed = run.state().velocity[3];
  std::cout << "balanced: tilt at most " << largest << " rad, " << left << " rad after 10 s, at "
            << speed << " m/s\n";

  const auto fallen = hamel::simulate(mechanism)
                          .start(start)
                          .step(0.001)
                          .until(5)
                          .observe([&](const hamel::Snapshot& s) { return tilt(s) < 1; })
                          .run();
  std::cout << "without: the tilt is 1 rad after " << fallen.last.time << " s\n";

  const bool good = linear.motion.growing() > 0 && largest < 0.2 && left < 0.01 &&
                    std::abs(speed - kSpeed) < 0.05 && fallen.last.time < 3;
  if (!good) std::cerr << "unicycle_lqr: not as commented\n";
  return good ? 0 : 1;
}
