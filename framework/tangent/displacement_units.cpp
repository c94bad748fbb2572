#include <hamel/framework/tangent/displacement_units.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <hamel/framework/mechanics/natural_units.hpp>

namespace hamel {
namespace {

constexpr double kSteps = 128;  // whose way is a unit, where the run is not shorter

// L, by the first step.
double way_of_motion(StepMap& map, const MotionState& start, double h,
                     const Eigen::MatrixXd& inertia) {
  const Config& config = map.plan().config;
  const double steps = std::min(kSteps, std::abs((config.until - config.from) / h));
  const auto length = [&](const Eigen::VectorXd& x) { return std::sqrt(x.dot(inertia * x)); };
  double out = steps * std::abs(h) * length(start.xi);
  MotionState end;
  if (map.step(start, start.time + h, end).ok)
    out += steps * steps * std::abs(h) * length(end.xi - start.xi) / 2;
  return std::isfinite(out) ? out : 0;
}

}  // namespace

Eigen::VectorXd displacement_units(StepMap& map, const MotionState& start, double h) {
  const RunPlan& plan = map.plan();
  const Mechanics& mechanics = *plan.setup.mechanics;
  const std::vector<double> own =
      own_scales(components_of(*plan.system), mechanics, start.g.data());
  Eigen::VectorXd out = Eigen::Map<const Eigen::VectorXd>(own.data(), mechanics.dim());
  if ((out.array() > 0).all()) return out;
  Eigen::MatrixXd inertia(out.size(), out.size());
  mechanics.inertia(start.g.data(), inertia);
  const double way = way_of_motion(map, start, h, inertia);
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    if (out[i] > 0) continue;
    const double unit = way / std::sqrt(inertia(i, i));
    out[i] = std::isnormal(unit) ? std::exp2(std::ilogb(unit)) : 1;  // without round-off
  }
  return out;
}

}  // namespace hamel
