#include <hamel/framework/run/record/velocity_text.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace hamel {

std::string velocity_in_words(const SystemModel& system, std::span<const double> xi,
                              double unknown) {
  const std::vector<Component> components = components_of(system);
  for (const double v : xi) unknown = std::max(unknown, 1e-13 * std::abs(v));
  std::string out;
  for (size_t i = 0; i < xi.size(); ++i) {
    const double v = std::abs(xi[i]) <= unknown ? 0 : xi[i];
    const double digits = v == 0 ? 1 : std::log10(std::abs(v) / unknown) + 1;
    out += fmt::format("{}{} = {:.{}g}", i == 0 ? "" : ", ",
                       i < components.size() ? components[i].name : fmt::format("xi{}", i + 1), v,
                       static_cast<int>(std::clamp(digits, 1.0, 6.0)));
  }
  return out;
}

}  // namespace hamel
