// The registered groups by type. That none is missing: tests/groups/group_laws.cpp,
// Groups.AreThoseOfTheRegistry.
#pragma once

#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/groups/all.hpp>

namespace hamel::test {

using AllGroups = TypeList<Heisenberg, Rn<1>, Rn<2>, Rn<3>, SE2, Product<SE2, SO2>, SE3, SO2, SO3>;

}  // namespace hamel::test
