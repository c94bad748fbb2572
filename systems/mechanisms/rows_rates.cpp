// d/dt (b - A xi) of the rows along the motion, xi held.
//
// The power of a wrench F on a link changes by F' . V + F . D, D the change of its twist
// (tree.hpp); seen from the root
//   F = (q x u, u),   F' = (q' x u + q x u', u'),
// and for a wrench fixed in a link that moves with U against its root by F . (D - ad_U V).
#include <cmath>

#include <hamel/framework/lie/differences.hpp>
#include <hamel/systems/mechanisms/touch.hpp>

namespace hamel::mechanisms {
namespace {

// A vector and its rate.
struct Moving {
  Vec3 at = Vec3::Zero(), rate = Vec3::Zero();
  Moving unit() const {
    const double length = at.norm();
    const Vec3 e = at / length;
    return {e, (rate - e * e.dot(rate)) / length};
  }
};
Moving operator+(const Moving& a, const Moving& b) { return {a.at + b.at, a.rate + b.rate}; }
Moving operator-(const Moving& a, const Moving& b) { return {a.at - b.at, a.rate - b.rate}; }
Moving operator*(double s, const Moving& a) { return {s * a.at, s * a.rate}; }
Moving cross(const Moving& a, const Moving& b) {
  return {a.at.cross(b.at), a.rate.cross(b.at) + a.at.cross(b.rate)};
}
// Of a, what is across the unit vector n.
Moving across(const Moving& a, const Moving& n) {
  const double part = a.at.dot(n.at), rate = a.rate.dot(n.at) + a.at.dot(n.rate);
  return {a.at - part * n.at, a.rate - rate * n.at - part * n.rate};
}

// The rate of the power of a force along u at q, and of a moment m, on a link.
double power_rate(const Tree& tree, int link, const Moving& q, const Moving& u) {
  const Moving moment = cross(q, u);
  return stack(moment.rate, u.rate).dot(tree.twist(link)) +
         stack(moment.at, u.at).dot(tree.acceleration(link));
}
double moment_rate(const Tree& tree, int link, const Moving& m) {
  return m.rate.dot(upper(tree.twist(link))) + m.at.dot(upper(tree.acceleration(link)));
}

// Of a function that has no derivative with it.
double slope(const std::function<double(double)>& rate, double t) {
  std::array<Vec<1>, 2> work;
  Vec<1> out = Vec<1>::Zero();
  differentiate_in_time(
      t, [&](double at) { return Vec<1>(rate(at)); }, work, out);
  return out[0];
}

// The touch of a contact in motion (Touch has the values).
struct MovingTouch {
  Moving gamma, q, along;
  MovingTouch(const Contact& contact, const Tree& tree) {
    const Touch touch(contact, tree);
    const Vec3 omega = upper(tree.root_twist(contact.link));
    const Twist against = tree.against_root(contact.carrier);
    const Vec3 at = touch.here.apply(contact.at);
    gamma = {touch.gamma, touch.gamma.cross(omega)};  // what rests in the world
    q = {at, velocity_at(against, at)};
    along = {touch.axis, upper(against).cross(touch.axis)};
    switch (contact.kind) {
      case ContactKind::wheel:
      case ContactKind::roller:
        q = q - contact.radius * across(gamma, along).unit();
        along = cross(along, gamma).unit();
        break;
      case ContactKind::blade: break;
      case ContactKind::ball:
        q = q - contact.radius * gamma;
        along = {touch.along, touch.along.cross(omega)};
        break;
    }
  }
};

// A vector of the world, of this rate there, seen from the root of a link.
Moving seen(const Tree& tree, int link, const Moving& world) {
  const Mat<3, 3>& rotation = tree.root_in_world(link).rotation;
  const Vec3 at = rotation.transpose() * world.at;
  return {at, rotation.transpose() * world.rate + at.cross(upper(tree.root_twist(link)))};
}
Moving point_seen(const Tree& tree, int link, const Moving& world) {
  Moving out = seen(tree, link, {world.at - tree.root_in_world(link).position, world.rate});
  out.rate -= lower(tree.root_twist(link));
  return out;
}
// Of a link, in the world.
Vec3 turning(const Tree& tree, int link) {
  return tree.root_in_world(link).rotation * upper(tree.twist(link));
}
Vec3 velocity(const Tree& tree, int link, const Vec3& x) {
  const Rigid& root = tree.root_in_world(link);
  return root.rotation * velocity_at(tree.twist(link), root.inverse().apply(x));
}

}  // namespace

HAMEL_FLATTEN void Rows::rates(const Contact& contact, const Tree& tree, double* out) const {
  if (contact.fixed) {
    const Twist change = tree.acceleration(contact.link) -
                         ad(tree.against_root(contact.carrier), tree.twist(contact.link));
    Row row;
    for (size_t k = 0; k < contact.rows(); ++k) {
      take(contact, k, tree, row);
      out[k] = -row.wrench.dot(change);
    }
    return;
  }
  const MovingTouch touch(contact, tree);
  const Moving sideways = cross(touch.gamma, touch.along);
  const auto slips_not = [&](const Moving& u) {
    *out = -power_rate(tree, contact.link, touch.q, u);
    if (ground.moves()) {
      const Rigid& root = tree.root_in_world(contact.link);
      const Twist twist = tree.root_twist(contact.link);
      const Vec3 x = root.apply(touch.q.at),
                 x_rate = root.rotation * (touch.q.rate + velocity_at(twist, touch.q.at)),
                 v = ground.velocity + ground.rate * Vec3(-x[1], x[0], 0),
                 v_rate = ground.rate * Vec3(-x_rate[1], x_rate[0], 0);
      *out += v_rate.dot(root.rotation * u.at) +
              v.dot(root.rotation * (u.rate + upper(twist).cross(u.at)));
    }
    ++out;
  };
  switch (contact.kind) {
    case ContactKind::wheel:
    case ContactKind::ball:
      slips_not(touch.along);
      slips_not(sideways);
      break;
    case ContactKind::roller:
      slips_not(std::cos(contact.angle) * touch.along + std::sin(contact.angle) * sideways);
      break;
    case ContactKind::blade: slips_not(sideways.unit()); break;
  }
  *out = -power_rate(tree, contact.link, touch.q, touch.gamma);
}

void Rows::rates(const Loop& loop, const Tree& tree, double* out) {
  const Rigid a = tree.in_world(loop.a), b = tree.in_world(loop.b);
  const Vec3 at = b.apply(loop.at), turning_a = turning(tree, loop.a);
  const Moving x = {at, velocity(tree, loop.b, at)};
  const bool hinge = !loop.axis.isZero(0);
  const Mat<3, 3> frame =
      a.rotation * (hinge ? frame_along(loop.axis) : Mat<3, 3>(Mat<3, 3>::Identity()));
  const auto direction = [&](int i) -> Moving {
    return {frame.col(i), turning_a.cross(Vec3(frame.col(i)))};
  };
  const auto of = [&](int link, int i) {
    return power_rate(tree, link, point_seen(tree, link, x), seen(tree, link, direction(i)));
  };
  for (int i = 0; i < 3; ++i) *out++ = of(loop.a, i) - of(loop.b, i);
  if (!hinge) return;
  const Vec3 axis = b.rotation * loop.axis;
  const Moving n = {axis, turning(tree, loop.b).cross(axis)};
  for (int i = 0; i < 2; ++i) {
    const Moving moment = cross(n, direction(i));
    *out++ = moment_rate(tree, loop.a, seen(tree, loop.a, moment)) -
             moment_rate(tree, loop.b, seen(tree, loop.b, moment));
  }
}

void Rows::rates(const Tree& tree, double t, const std::vector<char>& varies,
                 const std::vector<int>& slots, Eigen::Ref<Eigen::VectorXd> out) const {
  size_t i = 0;
  const auto find = [&](const auto& part) {
    const size_t count = part.rows();
    bool any = false;
    for (size_t k = 0; k < count; ++k) any = any || varies[i + k] != 0;
    if (any) {
      double values[5];
      rates(part, tree, values);
      for (size_t k = 0; k < count; ++k)
        if (varies[i + k] != 0) out[slots[i + k]] = values[k];
    }
    i += count;
  };
  for (const Contact& contact : contacts) find(contact);
  for (const Loop& loop : loops) find(loop);
  for (const Prescribed& p : prescribed) {
    if (varies[i] != 0) out[slots[i]] = p.slope ? p.slope(t) : slope(p.rate, t);
    ++i;
  }
}

}  // namespace hamel::mechanisms
