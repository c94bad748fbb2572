// tau(x, y) = (x, y e^(x/2)) on MyGroup.
#pragma once

#include <hamel/groups/my_group.hpp>

namespace hamel {

struct MyMap : RetractionDefaults<MyMap, MyGroup> {
  static constexpr bool symmetric = true;
  static std::string name() { return "my_map"; }
  static Vec<2> tau(const Vec<2>& xi) { return {xi[0], xi[1] * std::exp(xi[0] / 2)}; }
  static Vec<2> tau_inverse(const Vec<2>& g) { return {g[0], g[1] * std::exp(-g[0] / 2)}; }
  static Mat<2, 2> dtau_right_inverse(const Vec<2>& xi) {
    return Mat<2, 2>{{1, 0}, {xi[1] / 2, std::exp(-xi[0] / 2)}};
  }
  static Mat<2, 2> dtau_right_inverse_transpose_derivative(const Vec<2>& xi, const Vec<2>& p) {
    return p[1] * Mat<2, 2>{{0, 0.5}, {-0.5 * std::exp(-xi[0] / 2), 0}};
  }
};

}  // namespace hamel
