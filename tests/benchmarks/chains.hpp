// Chains of n bodies by parts.
#pragma once

#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/mechanism.hpp>

namespace hamel::benchmarks {

/// A snake in space, with springs, whose head rolls on the ground. It moves as slowly with many
/// bodies as with few: there is no gravity, and the head, whose ball is part of its link, starts at
/// rest, since with it would turn the whole straight chain.
inline Mechanism snake(int n) {
  Mechanism m("chain");
  m.gravity({0, 0, 0});
  std::string ahead;
  for (int i = 0; i < n; ++i) {
    const std::string name = fmt::format("link {}", i);
    m.body(name, {.mass = 1, .at = {-0.3 * i, 0, 0.1}, .box = {0.3, 0.1, 0.05}});
    const Point at = {-0.3 * i + 0.15, 0, 0.1};
    if (i == 0) m.free("space", name, {.at = {0, 0, 0.1}});
    else
      m.hinge(
          fmt::format("hinge {}", i), ahead, name,
          {.at = at, .axis = {0, i % 2 == 0 ? 1.0 : 0.0, i % 2 == 0 ? 0.0 : 1.0}, .stiffness = 50});
    ahead = name;
  }
  m.ball("head", "link 0", {.at = {0, 0, 0.1}, .radius = 0.1});
  std::map<std::string, double> start = {{"v1", 0}};
  for (int i = 1; i < n; ++i) start[fmt::format("hinge {}.rate", i)] = 0.1 * std::cos(i);
  m.start(start);
  return m;
}

}  // namespace hamel::benchmarks
