#include <hamel/systems/mechanisms/rows.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <hamel/groups/so2.hpp>

#include <hamel/systems/mechanisms/touch.hpp>

namespace hamel::mechanisms {
namespace {

// A force along u at x, both of the world, on a link.
Wrench on_link(const Tree& tree, int link, const Vec3& x, const Vec3& u) {
  const Rigid root = tree.root_in_world(link);
  return force_at(root.inverse().apply(x), root.rotation.transpose() * u);
}
Wrench moment_on_link(const Tree& tree, int link, const Vec3& u) {
  return stack(tree.root_in_world(link).rotation.transpose() * u, Vec3::Zero());
}

}  // namespace

std::vector<RowWords> Rows::words() const {
  std::vector<RowWords> out;
  const auto add = [&](const std::string& part, int number, std::string meaning, bool holonomic,
                       bool height = false) {
    out.push_back(
        {part, part + ".reaction" + std::to_string(number), std::move(meaning), holonomic, height});
  };
  for (const Contact& contact : contacts) {
    int number = 0;
    switch (contact.kind) {
      case ContactKind::wheel:
        add(contact.name, ++number, "rolls without slipping", false);
        add(contact.name, ++number, "does not slip sideways", false);
        break;
      case ContactKind::roller:
        add(contact.name, ++number, "does not slip along the axes of its rollers", false);
        break;
      case ContactKind::blade:
        add(contact.name, ++number, "does not slip across its edge", false);
        break;
      case ContactKind::ball:
        add(contact.name, ++number, "rolls without slipping, along x", false);
        add(contact.name, ++number, "rolls without slipping, along y", false);
        break;
    }
    add(contact.name, ++number, "touches the ground", true, true);
  }
  for (const Loop& loop : loops) {
    for (int i = 1; i <= 3; ++i) add(loop.name, i, "the points of the joint coincide", true);
    for (int i = 4; i <= 5 && !loop.axis.isZero(0); ++i) {
      add(loop.name, i, "the axes of the joint coincide", true);
    }
  }
  for (const Prescribed& p : prescribed) {  // whose name may be that of a contact, too
    const auto same = [&](const RowWords& row) { return row.part == p.name; };
    add(p.name, 1 + static_cast<int>(std::ranges::count_if(out, same)), "moves as prescribed",
        p.held >= 0);
  }
  return out;
}

// The rows are wrenches fixed in the carrier where that only turns about the vertical, but for
// those of a ball, which are along the world's axes, and on ground that moves.
void Rows::look_at(const Tree& tree) {
  for (Contact& contact : contacts) {
    contact.carrier = contact.link;
    if (tree.rotor(contact.link) && contact.kind != ContactKind::blade) {
      const Twist axis = tree.axis(contact.link);
      const double near = 1e-14 * (1 + contact.at.norm());
      const bool turns_about_itself =
          contact.kind == ContactKind::ball || upper(axis).cross(contact.axis).norm() <= near;
      if (turns_about_itself && velocity_at(axis, contact.at).norm() <= near)
        contact.carrier = tree.parent(contact.link);
    }
  }
  for (Contact& contact : contacts) {
    if (ground.moves() || contact.kind == ContactKind::ball || !tree.planar(contact.carrier))
      continue;
    const Rigid back = tree.from_root(contact.carrier).inverse();
    Row rows[3];
    look(contact, tree, rows);
    for (size_t k = 0; k < 3; ++k) contact.wrenches[k] = back.move_wrench(rows[k].wrench);
    contact.height = rows[contact.rows() - 1].phi;
    contact.fixed = true;
  }
}

Vec3 Rows::touches(const Contact& contact, const Tree& tree) const {
  return tree.root_in_world(contact.link).apply(Touch(contact, tree).q);
}

HAMEL_FLATTEN void Rows::look(const Contact& contact, const Tree& tree, Row* rows) const {
  const Touch touch(contact, tree);
  const Vec3 across = touch.gamma.cross(touch.along);
  int count = 0;
  const auto slips_not = [&](const Vec3& u) {
    Row& row = rows[count++];
    row.link = contact.link;
    row.wrench = force_at(touch.q, u);
    if (ground.moves()) {
      const Rigid& root = tree.root_in_world(contact.link);
      const Vec3 x = root.apply(touch.q), v = ground.velocity + ground.rate * Vec3(-x[1], x[0], 0);
      row.drift = v.dot(root.rotation.lazyProduct(u));
    }
  };
  switch (contact.kind) {
    case ContactKind::wheel:
    case ContactKind::ball:
      slips_not(touch.along);
      slips_not(across);
      break;
    case ContactKind::roller:
      slips_not(std::cos(contact.angle) * touch.along + std::sin(contact.angle) * across);
      break;
    case ContactKind::blade: slips_not(across.normalized()); break;
  }
  Row& row = rows[count++];
  row.link = contact.link;
  row.wrench = force_at(touch.q, touch.gamma);
  row.phi = tree.root_in_world(contact.link).apply(touch.q)[2];
}

double Rows::beyond(const Prescribed& p, const Tree& tree) {
  const double* element = tree.placed(p.held);
  if (tree.kind(p.held) != JointKind::hinge) return element[0] - p.angle(0);
  return std::remainder(Packing<SO2>::load(element).angle() - p.angle(0), 2 * std::numbers::pi);
}

void Rows::look(const Loop& loop, const Tree& tree, Row* rows) {
  const Rigid a = tree.in_world(loop.a), b = tree.in_world(loop.b);
  const Vec3 x = b.apply(loop.at), apart = x - a.apply(loop.at);
  const bool hinge = !loop.axis.isZero(0);
  const Mat<3, 3> frame =
      a.rotation * (hinge ? frame_along(loop.axis) : Mat<3, 3>(Mat<3, 3>::Identity()));
  for (int i = 0; i < 3; ++i) {
    Row& row = rows[i];
    row.link = loop.b;
    row.other = loop.a;
    row.wrench = on_link(tree, loop.b, x, frame.col(i));
    row.other_wrench = on_link(tree, loop.a, x, frame.col(i));
    row.phi = frame.col(i).dot(apart);
  }
  if (!hinge) return;
  const Vec3 axis = b.rotation * loop.axis;
  for (int i = 0; i < 2; ++i) {
    Row& row = rows[3 + i];
    const Vec3 moment = axis.cross(Vec3(frame.col(i)));
    row.link = loop.b;
    row.other = loop.a;
    row.wrench = moment_on_link(tree, loop.b, moment);
    row.other_wrench = moment_on_link(tree, loop.a, moment);
    row.phi = frame.col(i).dot(axis);
  }
}

}  // namespace hamel::mechanisms
