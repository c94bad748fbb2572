// Shape of a wheel with a tyre, spokes and a hub (framework/mechanics/drawing.hpp).
#pragma once

#include <utility>

#include <hamel/framework/mechanics/drawing.hpp>

namespace hamel::shapes {

/// About its own z axis. A spoke is marked, so that it is seen to turn.
inline BodyShape wheel(double radius, double width, Look look = {}) {
  return {"wheel", {radius, width}, {}, std::move(look)};
}

}  // namespace hamel::shapes
