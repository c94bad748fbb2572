// The group of lift's elements in its own numbers (lift_layout.hpp).
#include <hamel/systems/mechanisms/programs/lift_layout.hpp>

#include <cmath>
#include <numbers>

#include <hamel/framework/lie/packing.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/se3.hpp>
#include <hamel/groups/so3.hpp>

namespace hamel::mechanisms {
namespace {

using PartKind = LiftLayout::Kind;

// Planar numbers as an element.
SE2Element<double> planar_at(const double* x) {
  return {{x[0], x[1], std::llround(x[4])}, {x[2], x[3]}};
}
void put_planar(const SE2Element<double>& g, double* out) {
  out[0] = g.rotation.c;
  out[1] = g.rotation.s;
  out[2] = g.translation[0];
  out[3] = g.translation[1];
  out[4] = static_cast<double>(g.rotation.turns);
}

}  // namespace

void LiftLayout::compose(const double* g, const double* h, double* out) const {
  for (const Part& part : parts_) {
    const double *a = g + part.first, *b = h + part.first;
    double* to = out + part.first;
    switch (part.kind) {
      case PartKind::wheel: to[1] = a[1] + b[1]; [[fallthrough]];
      case PartKind::added: to[0] = a[0] + b[0]; break;
      case PartKind::turning: {
        const double c = a[1] * b[1] - a[2] * b[2], s = a[2] * b[1] + a[1] * b[2];
        to[0] = a[0] + b[0];
        to[1] = c;
        to[2] = s;
        break;
      }
      case PartKind::ball:
        Packing<SO3>::store(SO3::compose(Packing<SO3>::load(a), Packing<SO3>::load(b)), to);
        break;
      case PartKind::planar: put_planar(SE2::compose(planar_at(a), planar_at(b)), to); break;
      case PartKind::free:
        Packing<SE3>::store(SE3::compose(Packing<SE3>::load(a), Packing<SE3>::load(b)), to);
        break;
    }
  }
}

void LiftLayout::inverse(const double* g, double* out) const {
  for (const Part& part : parts_) {
    const double* a = g + part.first;
    double* to = out + part.first;
    switch (part.kind) {
      case PartKind::wheel: to[1] = -a[1]; [[fallthrough]];
      case PartKind::added: to[0] = -a[0]; break;
      case PartKind::turning:
        to[0] = -a[0];
        to[1] = a[1];
        to[2] = -a[2];
        break;
      case PartKind::ball: Packing<SO3>::store(SO3::inverse(Packing<SO3>::load(a)), to); break;
      case PartKind::planar: put_planar(SE2::inverse(planar_at(a)), to); break;
      case PartKind::free: Packing<SE3>::store(SE3::inverse(Packing<SE3>::load(a)), to); break;
    }
  }
}

void LiftLayout::tau(const double* xi, double* out) const {
  for (const Part& part : parts_) {
    const double* v = xi + part.dof;
    double* to = out + part.first;
    switch (part.kind) {
      case PartKind::wheel: to[1] = 0; [[fallthrough]];
      case PartKind::added: to[0] = v[0]; break;
      case PartKind::turning:
        to[0] = v[0];
        to[1] = std::cos(v[0]);
        to[2] = std::sin(v[0]);
        break;
      case PartKind::ball: Packing<SO3>::store(Cayley<SO3>::tau(Vec<3>(v)), to); break;
      case PartKind::planar: put_planar(Cayley<SE2>::tau(Vec<3>(v)), to); break;
      case PartKind::free: Packing<SE3>::store(Cayley<SE3>::tau(Vec<6>(v)), to); break;
    }
  }
}

bool LiftLayout::recover_step(const double* delta, double s, double* xi) const try {
  for (const Part& part : parts_) {
    const double* x = delta + part.first;
    double* v = xi + part.dof;
    switch (part.kind) {
      case PartKind::wheel: v[0] = x[0] + 2 * std::numbers::pi * x[1]; break;
      case PartKind::added:
      case PartKind::turning: v[0] = x[0]; break;
      case PartKind::ball:
        Eigen::Map<Vec<3>>{v} = Cayley<SO3>::recover_step(Packing<SO3>::load(x), s);
        break;
      case PartKind::planar:
        Eigen::Map<Vec<3>>{v} = Cayley<SE2>::recover_step(planar_at(x), s);
        break;
      case PartKind::free:
        Eigen::Map<Vec<6>>{v} = Cayley<SE3>::recover_step(Packing<SE3>::load(x), s);
        break;
    }
  }
  return true;
} catch (const DomainError&) {
  return false;
}

}  // namespace hamel::mechanisms
