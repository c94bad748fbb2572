// Chaplygin's sleigh from rest in v to its steady motion: the angle by which it turns in all, for
// 64 offsets of its blade, which are the points of a sequence of low discrepancy.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include <hamel/simulate.hpp>

namespace {

// The digits of an index in base 2, mirrored at the point: 1/2, 1/4, 3/4, 1/8, ... (van der
// Corput).
double van_der_corput(long index) {
  double out = 0, digit = 0.5;
  for (long k = index + 1; k > 0; k /= 2, digit /= 2) out += static_cast<double>(k % 2) * digit;
  return out;
}

}  // namespace

int main() {
  constexpr double mass = 2, inertia = 0.5;
  hamel::EnsembleConfig config;
  config.run.system = "chaplygin_sleigh";
  config.run.parameters = {{"mass", {mass}}, {"inertia", {inertia}}};
  config.run.start.velocity = {3, 0, 0};
  config.run.scheme = "rkmk4";
  config.run.step = 0.01;
  config.run.until = 20;
  config.members = 64;
  config.vary_by("offset", [](long member) { return 0.3 + 0.6 * van_der_corput(member); });
  config.keep_by("turn", [](hamel::Run& run) { return run.state().coordinates[0]; });
  const auto result = hamel::Ensemble(hamel::registry(), config).run();

  // With k^2 = inertia / mass + offset^2 the motion is omega = 3 sech(3 offset t / k), of which the
  // integral over all times is pi k / (2 offset).
  const auto& offset = std::get<0>(result.table.column("offset").values);
  const auto& turn = std::get<0>(result.table.column("turn").values);
  double error = 0;
  for (size_t i = 0; i < offset.size(); ++i) {
    const double k = std::sqrt(inertia / mass + offset[i] * offset[i]);
    error = std::max(error, std::abs(turn[i] - std::numbers::pi * k / (2 * offset[i])));
  }
  for (const std::string& note : result.notes) std::cout << note << "\n";
  const hamel::Moments& moments = result.moments.at("turn");
  std::cout << moments.count << " sleighs turn by " << moments.least << " to " << moments.most
            << " rad, " << error << " from the closed form at most\n";
  const bool good = result.complete && moments.count == 64 && error < 1e-6;
  if (!good) std::cerr << "ensemble_functions: not as commented\n";
  return good ? 0 : 1;
}
