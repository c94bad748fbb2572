// The lanes of the library, in the widest instruction set that this machine has.
#include <hamel/systems/lanes/lane_tables.hpp>

#include <string>
#include <tuple>

#include <hamel/systems/lanes.hpp>

namespace hamel {
namespace {

template <class P>
void add_both(Registry& registry, const std::string& instructions, int width,
              const lanes::Makers<P>& makers) {
  add_lanes<Lift, P>(registry, instructions, width, makers.lift);
  add_lanes<Rkmk4, P>(registry, instructions, width, makers.rkmk4);
}

}  // namespace

void add_library_lanes(Registry& registry) {
  const bool avx2 = __builtin_cpu_supports("avx2") != 0;
  const lanes::Table table = avx2 ? lanes::table_avx2() : lanes::table_sse2();
  const std::string instructions = avx2 ? "avx2" : "sse2";
  const int width = avx2 ? 8 : 4;  // bodies in two registers
  std::apply([&](const auto&... makers) { (add_both(registry, instructions, width, makers), ...); },
             table);
}

}  // namespace hamel
