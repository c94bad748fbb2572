// exp of the groups that joints use, the types erased: 4 s of compilation each.
#include <hamel/groups/exp.hpp>

namespace hamel {
namespace {

template <class G>
std::shared_ptr<const Geometry> erased_exp() {
  return std::make_shared<TypedGeometry<Exp<G>>>();
}

}  // namespace

template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<Rn<1>>>() {
  return erased_exp<Rn<1>>();
}
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SO2>>() {
  return erased_exp<SO2>();
}
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SO3>>() {
  return erased_exp<SO3>();
}
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SE2>>() {
  return erased_exp<SE2>();
}
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SE3>>() {
  return erased_exp<SE3>();
}

}  // namespace hamel
