#include <hamel/framework/mechanics/system.hpp>

#include <fmt/format.h>

#include <hamel/framework/mechanics/mechanics.hpp>

namespace hamel {

std::string constraints_in_words(const SystemModel& model) {
  const int rows = model.mechanics->rows(), holonomic = model.mechanics->holonomic_rows();
  if (rows == 0) return "no constraint";
  return fmt::format("{} constraint row{}{}", rows, rows == 1 ? "" : "s",
                     holonomic > 0 ? fmt::format(", {} holonomic", holonomic) : "");
}

}  // namespace hamel
