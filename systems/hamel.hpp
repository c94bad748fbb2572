// hamel: geometric integrators for nonholonomic systems on Lie groups. The one header a user needs.
#pragma once

#include <hamel/framework/composition.hpp>
#include <hamel/framework/general_system.hpp>
#include <hamel/framework/group_defaults.hpp>
#include <hamel/framework/retraction_defaults.hpp>
#include <hamel/framework/simulate.hpp>
#include <hamel/framework/study.hpp>
#include <hamel/groups/all.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/rolling_disk.hpp>
#include <hamel/systems/simulate.hpp>
#include <hamel/systems/suslov.hpp>
