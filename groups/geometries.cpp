// exp and Cayley of the groups of bodies, the types erased: up to 4 s of compilation each.
#include <hamel/groups/all.hpp>

namespace hamel {

template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<Rn<1>>>() {
  return std::make_shared<TypedGeometry<Exp<Rn<1>>>>();
}
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SO2>>() {
  return std::make_shared<TypedGeometry<Exp<SO2>>>();
}
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SO3>>() {
  return std::make_shared<TypedGeometry<Exp<SO3>>>();
}
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SE2>>() {
  return std::make_shared<TypedGeometry<Exp<SE2>>>();
}
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SE3>>() {
  return std::make_shared<TypedGeometry<Exp<SE3>>>();
}
template <>
std::shared_ptr<const Geometry> erased_geometry<Cayley<SO3>>() {
  return std::make_shared<TypedGeometry<Cayley<SO3>>>();
}
template <>
std::shared_ptr<const Geometry> erased_geometry<Cayley<SE2>>() {
  return std::make_shared<TypedGeometry<Cayley<SE2>>>();
}
template <>
std::shared_ptr<const Geometry> erased_geometry<Cayley<SE3>>() {
  return std::make_shared<TypedGeometry<Cayley<SE3>>>();
}

}  // namespace hamel
