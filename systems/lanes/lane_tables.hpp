// The batches of the library's lanes, one table for each instruction set: units compiled with the
// flags of that set (systems/CMakeLists.txt).
#pragma once

#include <tuple>

#include <hamel/framework/lanes/lane_batch.hpp>
#include <hamel/framework/schemes/left_invariant.hpp>
#include <hamel/framework/schemes/lift.hpp>
#include <hamel/framework/schemes/lift_reduced.hpp>
#include <hamel/framework/schemes/rkmk4.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/heisenberg.hpp>
#include <hamel/groups/product_retraction.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/so3.hpp>

namespace hamel::lanes {

/// The batches of a problem, by scheme.
template <class P_>
struct Makers {
  using P = P_;
  LaneMaker<Lift, P> lift;
  LaneMaker<Rkmk4, P> rkmk4;
};
template <class G, int M>
using MakersOn = Makers<LeftInvariant<G, M, Cayley<G>>>;
/// suslov, chaplygin_sleigh, heisenberg_particle, rolling_disk, differential_drive, and all
/// left-invariant systems like them.
using Table = std::tuple<MakersOn<SO3, 2>, MakersOn<SE2, 2>, MakersOn<Heisenberg, 2>,
                         MakersOn<Product<SE2, SO2>, 2>, MakersOn<Product<SE2, SO2, SO2>, 2>>;

Table table_sse2();
Table table_avx2();

}  // namespace hamel::lanes

namespace hamel {
class Registry;
void add_library_lanes(Registry& registry);
}  // namespace hamel
