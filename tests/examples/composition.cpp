// Order 4, 6 and 8 by composing the symmetric second-order step with itself.
#include <cmath>
#include <cstdio>
#include <string>

#include <hamel/hamel.hpp>

int main() {
  const auto error = [](const std::string& table, double step) {
    return hamel::simulate("suslov")
        .set("inertia", {2, 0.3, 0.5, 3, 0.4, 4})
        .start({.velocity = {1, 0.5, 0}})
        .compose(table)
        .step(step)
        .until(4)
        .run()
        .exact_error_max;
  };
  bool good = true;
  std::printf("%-14s %6s %5s %10s %10s\n", "table", "stages", "h", "error(h)", "error(h/2)");
  for (const hamel::Composition& table : hamel::compositions()) {
    const double step = table.order < 8 ? 0.2 : 0.8;  // so that h/2 is well above round-off
    const double coarse = error(table.name, step), fine = error(table.name, step / 2),
                 order = std::log2(coarse / fine);
    std::printf("%-14s %6zu %5.1f %10.2e %10.2e  order %.2f (claimed %d)\n", table.name.c_str(),
                table.coefficients.size(), step, coarse, fine, order, table.order);
    good = good && std::abs(order - table.order) < (table.order < 8 ? 0.1 : 0.6);
  }
  if (!good) std::fprintf(stderr, "composition: an order is not as claimed\n");
  return good ? 0 : 1;
}
