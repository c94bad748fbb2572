// hamel: geometric integrators for nonholonomic systems on Lie groups. The one header a user needs.
//
// Every registered system runs by name. As C++ types it brings Suslov, ChaplyginSleigh and
// RollingDisk; each of the others has a separate header in hamel/systems, named as in `hamel list
// systems`.
#pragma once

#include <hamel/framework/lie/group_defaults.hpp>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/schemes/composition.hpp>
#include <hamel/groups/all.hpp>
#include <hamel/simulate.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/rolling_disk.hpp>
#include <hamel/systems/simulate_typed.hpp>
#include <hamel/systems/suslov.hpp>
