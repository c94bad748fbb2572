// Batches of an instruction set. Compiled once for each, with HAMEL_LANES_NAME (avx2) and
// HAMEL_LANES_ARCH (that of xsimd).
#include <hamel/framework/lanes/lane_steps.hpp>
#include <hamel/systems/lanes/lane_tables.hpp>

namespace hamel::lanes {
namespace {

template <class P>
Makers<P> makers(const Makers<P>& /*kind*/) {
  return {&make_lanes<Lift, P, xsimd::HAMEL_LANES_ARCH>,
          &make_lanes<Rkmk4, P, xsimd::HAMEL_LANES_ARCH>};
}

}  // namespace

#define HAMEL_LANES_JOIN(a, b) a##b
#define HAMEL_LANES_TABLE(name) HAMEL_LANES_JOIN(table_, name)
Table HAMEL_LANES_TABLE(HAMEL_LANES_NAME)() {
  return std::apply([](const auto&... kinds) { return Table{makers(kinds)...}; }, Table());
}

}  // namespace hamel::lanes
