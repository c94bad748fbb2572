// Other units of length, mass, time and cost, and a system without angles in any of them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <string>

namespace hamel::test {

/// So many new units are an old one; an old cost is so many new ones.
struct Units {
  double length = 1, mass = 1, time = 1, cost = 1;
  double of(double lengths, double masses, double times) const {
    return std::pow(length, lengths) * std::pow(mass, masses) * std::pow(time, times);
  }
  double torque() const { return of(2, 1, -2); }
  double force() const { return of(1, 1, -2); }
  double weight(double input) const { return cost / (input * input * time); }
};

inline Units random_units(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> power(-1, 1);
  const auto draw = [&](double decades) { return std::pow(10, decades * power(random)); };
  Units out;
  out.length = draw(6);
  out.mass = draw(6);
  out.time = draw(3);
  out.cost = draw(4);
  return out;
}

/// Two springs on r2, one of them cubic, with an input; the path of its file.
inline std::string cart_file(const std::string& name) {
  std::string path = testing::TempDir() + name + ".toml";
  std::ofstream(path) << R"toml(name = "cart"
group = "r2"
inertia = ["m", "m"]
force = ["force - k*x1", "0.3*force - k*x2^3/l^2"]
[parameters]
m = { value = 1 }
k = { value = 1 }
l = { value = 1 }
[inputs]
force = { unit = "N" }
)toml";
  return path;
}

}  // namespace hamel::test
