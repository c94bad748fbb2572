// One unit per group: its retractions, and the kernels of every scheme compiled for it.
#pragma once

#include <hamel/systems/kernels.hpp>

namespace hamel {

void add_so2(Registry& registry);
void add_so3(Registry& registry);
void add_se2(Registry& registry);
void add_se3(Registry& registry);
void add_rn(Registry& registry);       // r1, r2, r3
void add_se2_so2(Registry& registry);  // se2*so2
void add_general(Registry& registry);  // the time loop of general systems

}  // namespace hamel
