// A program that uses one layer: the groups.
#include <hamel/groups/exp.hpp>

int main() {
  const hamel::Vec<3> xi(0.1, 0.2, 0.3);
  const auto g = hamel::Exp<hamel::SO3>::tau(xi);
  return (hamel::Exp<hamel::SO3>::tau_inverse(g) - xi).norm() < 1e-15 ? 0 : 1;
}
