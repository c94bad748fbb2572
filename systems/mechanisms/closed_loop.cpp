// The rows of a closed chain, also with their rates along the motion, from one formula.
#include <hamel/systems/mechanisms/closed_loop.hpp>

namespace hamel::mechanisms {
namespace {

// Points and directions of links in the world, and those of the world seen from the root of a link.
template <class T>
struct WorldView {
  static constexpr bool has_rates = !std::is_same_v<T, double>;
  using Vector = VecT<T, 3>;
  const Tree& tree;

  Vector point(int link, const Vec3& drawn) const {
    const Vec3 x = tree.in_world(link).apply(drawn);
    if constexpr (has_rates) {
      const Rigid& root = tree.root_in_world(link);
      return dual(x, root.rotation * velocity_at(tree.twist(link), root.inverse().apply(x)));
    } else {
      return x;
    }
  }
  Vector direction(int link, const Vec3& drawn) const {
    const Vec3 u = tree.in_world(link).rotation * drawn;
    if constexpr (has_rates) {
      const Vec3 turning = tree.root_in_world(link).rotation * upper(tree.twist(link));
      return dual(u, turning.cross(u));
    } else {
      return u;
    }
  }
  Vector seen(int link, const Vector& u) const {
    const Mat<3, 3> back = tree.root_in_world(link).rotation.transpose();
    if constexpr (has_rates) {
      const Vec3 here = back * value(u);
      return dual(here, back * rate(u) + here.cross(upper(tree.root_twist(link))));
    } else {
      return back * u;
    }
  }
  Vector seen_point(int link, const Vector& x) const {
    const Rigid back = tree.root_in_world(link).inverse();
    if constexpr (has_rates) {
      const Vec3 here = back.apply(value(x));
      return dual(here, back.rotation * rate(x) - velocity_at(tree.root_twist(link), here));
    } else {
      return back.apply(x);
    }
  }
};

// row(i, wrench on a link, phi) with wrench(link) = (moment, force).
template <class T, class F>
void each_row(const Loop& loop, const Tree& tree, F&& row) {
  using Vector = VecT<T, 3>;
  const WorldView<T> world{tree};
  const Vector x = world.point(loop.b, loop.at), apart = x - world.point(loop.a, loop.at);
  const Mat<3, 3> frame = loop.is_hinge() ? frame_along(loop.axis) : Mat<3, 3>::Identity();
  std::array<Vector, 3> e;
  for (int i = 0; i < 3; ++i) {
    const Vector& u = e[static_cast<size_t>(i)] = world.direction(loop.a, frame.col(i));
    const auto wrench = [&](int link) {
      return force_at(world.seen_point(link, x), world.seen(link, u));
    };
    row(i, wrench, u.dot(apart));
  }
  if (!loop.is_hinge()) return;
  const Vector axis = world.direction(loop.b, loop.axis);
  for (int i = 0; i < 2; ++i) {
    const Vector& u = e[static_cast<size_t>(i)];
    const Vector moment = axis.cross(u);
    const auto wrench = [&](int link) { return moment_of(world.seen(link, moment)); };
    row(3 + i, wrench, u.dot(axis));
  }
}

template <class T>
void find_rows(const Loop& loop, const Tree& tree, Row* out) {
  each_row<T>(loop, tree, [&](int i, auto&& wrench, const T& phi) {
    Row& row = out[i];
    const VecT<T, 6> on_b = wrench(loop.b), on_a = wrench(loop.a);
    row.link = loop.b;
    row.other = loop.a;
    row.wrench = value(on_b);
    row.other_wrench = value(on_a);
    if constexpr (std::is_same_v<T, Dual>) {
      row.phi = phi.value;
      row.rate = power_rate(on_a, tree.twist(loop.a), tree.acceleration(loop.a)) -
                 power_rate(on_b, tree.twist(loop.b), tree.acceleration(loop.b));
    } else {
      row.phi = phi;
    }
  });
}

}  // namespace

void Loop::rows(const Tree& tree, bool with_rates, Row* out) const {
  if (with_rates) find_rows<Dual>(*this, tree, out);
  else find_rows<double>(*this, tree, out);
}

}  // namespace hamel::mechanisms
