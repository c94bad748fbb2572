// Inputs that are prescribed rates, and jump.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include <hamel/framework/run/run/plan/plan.hpp>

namespace hamel {
namespace {

// The first jump of a held table between two times, in either order; none: NaN.
double first_jump(const InputTable& table, double from, double until) {
  const double first = std::min(from, until), last = std::max(from, until);
  for (size_t i = 1; table.hold && i < table.times.size(); ++i)
    if (table.times[i] > first && table.times[i] < last && table.values[i] != table.values[i - 1])
      return table.times[i];
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void check_jumps_of_rates(const SystemModel& system, const Inputs& inputs, const Geometry& geometry,
                          const Config& config, const PlannedStart& planned, Mistakes& mistakes) {
  if (!system.mechanics->has_drift()) return;
  Eigen::VectorXd g(geometry.size()), b = planned.drift;
  Eigen::MatrixXd a = planned.constraints;
  geometry.from_coordinates(planned.start.configuration, g.data());
  for (size_t i = 0; i < inputs.fields().size(); ++i) {
    const double jump = first_jump(inputs.tables()[i], config.from, config.until);
    if (std::isnan(jump)) continue;
    const auto [least, most] = std::ranges::minmax(inputs.tables()[i].values);
    const auto probe = std::make_shared<Inputs>(inputs);
    const auto driven = system.drive(probe);
    Eigen::VectorXd rates[2];
    for (const int k : {0, 1}) {
      probe->set(i, k == 0 ? least : most);
      driven->constraints(config.from, g.data(), a, b);
      rates[k] = b;
    }
    if (rates[0] == rates[1]) continue;
    mistakes.add(fmt::format(
        "input '{}': a held table jumps at t = {:.10g}, and this input is a prescribed rate: a "
        "jump of a rate is an impulse, which no run carries out: give a table without hold, which "
        "is linear between its rows",
        inputs.fields()[i].name, jump));
  }
}

}  // namespace hamel
