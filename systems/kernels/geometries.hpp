// The groups with exp, their types erased, as their units compile them: made by type they cost 4 s
// of compilation each.
#pragma once

#include <memory>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/lie/group_info.hpp>
#include <hamel/groups/all.hpp>

namespace hamel {

struct WithExp {
  GroupInfo group;
  std::shared_ptr<const Geometry> geometry;
};
template <class G>
WithExp with_exp();

template <>
WithExp with_exp<Rn<1>>();
template <>
WithExp with_exp<SE2>();
template <>
WithExp with_exp<SE3>();
template <>
WithExp with_exp<SO2>();
template <>
WithExp with_exp<SO3>();

}  // namespace hamel
