// Every group with every retraction.
#pragma once

#include <hamel/groups/cayley.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/heisenberg.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/product_retraction.hpp>
#include <hamel/groups/radial.hpp>
#include <hamel/groups/rn.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/se3.hpp>
#include <hamel/groups/second_kind.hpp>
#include <hamel/groups/so2.hpp>
#include <hamel/groups/so3.hpp>
