#pragma once
#include <hamel/framework/version.hpp>
#include <hamel/groups/so3.hpp>
#include <hamel/systems/simulate.hpp>
