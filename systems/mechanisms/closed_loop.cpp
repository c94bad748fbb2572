// The rows of a closed chain.
#include <hamel/systems/mechanisms/closed_loop.hpp>

namespace hamel::mechanisms {

namespace {

PairPoint<double> pair_point(const Loop& loop, const Tree& tree) {
  const Rigid place = tree.in_world(loop.a);
  return find_pair_point<double>(
      *loop.surface, loop.at, tree.in_world(loop.b).apply(loop.at),
      [&](const Vec3& x) { return place.apply(x); },
      [&](const Vec3& u) -> Vec3 { return place.rotation * u; });
}

}  // namespace

double Loop::open_by(const Tree& tree) const {
  if (surface) return pair_point(*this, tree).gap;
  return (tree.in_world(b).apply(at) - tree.in_world(a).apply(at)).norm();
}

Vec3 Loop::touch(const Tree& tree) const { return pair_point(*this, tree).point; }

void Loop::rows(const Tree& tree, Row* out) const {
  const auto seen = [&](int link, const Vec3& u) -> Vec3 {
    return tree.root_in_world(link).rotation.transpose() * u;
  };
  const auto set = [&](int i, auto&& wrench, double phi) {
    Row& row = out[i];
    row.link = b;
    row.other = a;
    row.wrench = wrench(b);
    row.other_wrench = wrench(a);
    row.phi = phi;
  };
  if (surface) {
    const PairPoint<double> touch = pair_point(*this, tree);
    for (int i = 0; i < 3; ++i) {
      const auto wrench = [&](int link) {
        return force_at(tree.root_in_world(link).inverse().apply(touch.point),
                        seen(link, touch.directions[static_cast<size_t>(i)]));
      };
      set(i, wrench, i == 2 ? touch.gap : 0);
    }
    return;
  }
  const Vec3 x = tree.in_world(b).apply(at), apart = x - tree.in_world(a).apply(at);
  const Mat<3, 3> drawn = is_hinge() ? frame_along(axis) : Mat<3, 3>::Identity();
  const Mat<3, 3> e = tree.in_world(a).rotation * drawn;
  for (int i = 0; i < 3; ++i) {
    const Vec3 u = e.col(i);
    const auto wrench = [&](int link) {
      return force_at(tree.root_in_world(link).inverse().apply(x), seen(link, u));
    };
    set(i, wrench, u.dot(apart));
  }
  if (!is_hinge()) return;
  const Vec3 along = tree.in_world(b).rotation * axis;
  for (int i = 0; i < 2; ++i) {
    const Vec3 u = e.col(i), moment = along.cross(u);
    const auto wrench = [&](int link) { return stack(seen(link, moment), Vec3::Zero()); };
    set(3 + i, wrench, u.dot(along));
  }
}

}  // namespace hamel::mechanisms
