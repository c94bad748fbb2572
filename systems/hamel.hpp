// hamel: geometric integrators for nonholonomic systems on Lie groups. The one header a user needs.
#pragma once

#include <hamel/framework/composition.hpp>
#include <hamel/framework/simulate.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/radial.hpp>
#include <hamel/groups/second_kind.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/rolling_disk.hpp>
#include <hamel/systems/simulate.hpp>
#include <hamel/systems/suslov.hpp>
