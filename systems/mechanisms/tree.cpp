#include <hamel/systems/mechanisms/tree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <hamel/groups/se2.hpp>
#include <hamel/groups/so2.hpp>

namespace hamel::mechanisms {
namespace {

// The element with this motion in the joint's frame: of a joint that is drawn at rest the identity,
// of one against the ground's own frame the place of the body.
std::vector<double> element_of(JointKind kind, const Rigid& x) {
  const JointType& type = type_of(kind);
  std::vector<double> values = type.group.identity;
  if (kind == JointKind::free) {
    for (int i = 0; i < 9; ++i) values[static_cast<size_t>(i)] = x.rotation(i / 3, i % 3);
    for (int i = 0; i < 3; ++i) values[static_cast<size_t>(9 + i)] = x.position[i];
  } else if (kind == JointKind::planar) {
    values = {0, x.position[0], x.position[1]};
  }
  std::vector<double> element(static_cast<size_t>(type.geometry->size()));
  type.geometry->from_coordinates(values, element.data());
  return element;
}

// P iota C^-1 as a constant and what two numbers of the element are to be multiplied with: cos and
// sin of the angle, or the way along the axis and nothing.
std::array<Rigid, 3> terms_of(const Link& link) {
  const Rigid& p = link.on_parent;
  const Rigid after = link.on_child.inverse();
  const auto term = [&](const Mat<3, 3>& part) {
    return Rigid{part * after.rotation, part * after.position};
  };
  const Vec3 axis = p.rotation.col(2);
  std::array<Rigid, 3> out;
  if (link.kind == JointKind::slider) {
    out = {p * after, {Mat<3, 3>::Zero(), axis}, {Mat<3, 3>::Zero(), Vec3::Zero()}};
    return out;
  }
  const Mat<3, 3> along = axis * Vec3::UnitZ().transpose(),
                  odd = p.rotation.col(1) * Vec3::UnitX().transpose() -
                        p.rotation.col(0) * Vec3::UnitY().transpose();
  out = {term(along), term(p.rotation - along), term(odd)};
  out[0].position += p.position;
  return out;
}

bool same(const Inertia& a, const Inertia& b) {
  const double near = 1e-14 * a.second.lpNorm<Eigen::Infinity>();
  return (a.second - b.second).lpNorm<Eigen::Infinity>() <= near &&
         (a.first - b.first).squaredNorm() <= near * 1e-14 * a.mass;
}

}  // namespace

Tree::Tree(const std::vector<Link>& links) {
  nodes_.reserve(links.size());
  for (const Link& link : links) {
    Node node;
    const int j = static_cast<int>(nodes_.size());
    const bool is_root = link.parent == kGround;
    node.link = link;
    chain_ = chain_ && link.parent == j - 1;
    node.root = is_root ? j : at(link.parent).root;
    node.on_root = !is_root && at(link.parent).link.parent == kGround;
    node.dof = dim_;
    node.element = size_;
    const auto s = hamel::mechanisms::directions(link.kind);
    node.count = static_cast<int>(s.cols());
    const Rigid& frame = node.count == 1 && !is_root ? link.on_parent : link.on_child;
    for (int i = 0; i < node.count; ++i) node.directions.col(i) = frame.move(s.col(i));
    node.columns = node.directions;
    node.after = link.on_child.inverse();
    if (link.kind != JointKind::free && link.kind != JointKind::ball) {
      node.terms = terms_of(link);
      look_for_planar(node);
    }
    node.inertia = link.inertia;
    dim_ += node.count;
    size_ += type_of(link.kind).geometry->size();
    const auto drawn = element_of(link.kind, link.on_parent.inverse() * link.on_child);
    drawn_.insert(drawn_.end(), drawn.begin(), drawn.end());
    nodes_.push_back(std::move(node));
  }
  look_for_rotors();
  for (Node& node : nodes_) node.own = node.inertia;
  placed_.assign(drawn_.size(), std::numeric_limits<double>::quiet_NaN());
  place(drawn_.data());
  carry();
}

// Its parent planar, its axis vertical, or across that for a slider; no part of its motion leaves
// the plane.
void Tree::look_for_planar(Node& node) const {
  const bool is_root = node.link.parent == kGround;
  if (!is_root && (!at(node.link.parent).planar || node.link.kind == JointKind::planar)) return;
  double off = 0;
  for (int i = 0; i < node.count; ++i) {
    off = std::max({off, node.directions.col(i).head<2>().lpNorm<Eigen::Infinity>(),
                    std::abs(node.directions(5, i))});
  }
  if (!is_root)
    off = std::max(off, std::abs(node.terms[0].position[2] + node.terms[1].position[2]));
  node.planar = off <= 1e-14 * (1 + node.link.on_parent.position.norm());
}

void Tree::look_for_rotors() {
  for (Node& node : nodes_)
    node.rotor = node.link.kind == JointKind::hinge && node.link.parent != kGround;
  for (const Node& node : nodes_)
    if (node.link.parent != kGround) at(node.link.parent).rotor = false;
  for (Node& node : nodes_) {
    if (!node.rotor) continue;
    const auto turned = [&](double angle) {
      std::array<double, Packing<SO2>::size> element;
      Packing<SO2>::store({std::cos(angle), std::sin(angle)}, element.data());
      return moved(node.across(element.data()), node.link.inertia);
    };
    const Inertia seen = turned(0);
    node.rotor = same(seen, turned(1)) && same(seen, turned(2.5));
    if (!node.rotor) continue;
    at(node.link.parent).inertia += seen;
    node.spin = node.spin_here = seen * node.directions.col(0);
    node.moment = node.spin.dot(node.directions.col(0));
  }
}

std::array<double, 2> Tree::Node::numbers(const double* g) const {
  if (link.kind == JointKind::slider) return {g[0], 0};
  const auto turn =
      link.kind == JointKind::hinge ? Packing<SO2>::load(g) : Packing<SE2>::load(g).rotation;
  return {turn.c, turn.s};
}

Rigid Tree::Node::across(const double* g) const {
  if (link.kind == JointKind::free || link.kind == JointKind::ball)
    return link.on_parent * motion(link.kind, g) * after;
  const double a = numbers(g)[0], b = numbers(g)[1];
  Rigid out{terms[0].rotation + a * terms[1].rotation + b * terms[2].rotation,
            terms[0].position + a * terms[1].position + b * terms[2].position};
  if (link.kind == JointKind::planar) {
    const Vec<2> shift = Packing<SE2>::load(g).translation;
    out.position +=
        shift[0] * link.on_parent.rotation.col(0) + shift[1] * link.on_parent.rotation.col(1);
  }
  return out;
}

PlaneMotion Tree::Node::across_in_plane(const double* g) const {
  const double a = numbers(g)[0], b = numbers(g)[1];
  const auto sum = [&](auto entry) {
    return entry(terms[0]) + a * entry(terms[1]) + b * entry(terms[2]);
  };
  return {sum([](const Rigid& x) { return x.rotation(0, 0); }),
          sum([](const Rigid& x) { return x.rotation(1, 0); }),
          sum([](const Rigid& x) { return x.position[0]; }),
          sum([](const Rigid& x) { return x.position[1]; })};
}

Rigid Tree::from_root(int link) const {
  if (link == kGround) return rest_;
  const Node& node = at(link);
  if (node.planar) return node.flat.in_space();
  if (node.rotor) return from_root(node.link.parent) * node.across(placed_.data() + node.element);
  return node.place;
}

HAMEL_FLATTEN void Tree::place(const double* g) {
  if (placed_at(g)) return;
  std::memcpy(placed_.data(), g, placed_.size() * sizeof(double));
  carries_ = false;
  for (Node& node : nodes_) {
    const double* element = g + node.element;
    if (node.link.parent == kGround) {
      node.world = node.across(element);
      continue;
    }
    const Node& parent = at(node.link.parent);
    if (node.planar) {
      node.flat = node.across_in_plane(element);
      if (!node.on_root) node.flat = parent.flat * node.flat;
    } else if (!node.rotor) {
      node.place = node.across(element);
      if (!node.on_root)
        node.place = (parent.planar ? parent.flat.in_space() : parent.place) * node.place;
    }
    if (node.count > 1) {
      for (int i = 0; i < node.count; ++i)
        node.columns.col(i) = node.place.move(node.directions.col(i));
    } else if (!node.on_root) {
      if (node.planar) {
        in_plane(node.columns.col(0)) = parent.flat.move_in_plane(in_plane(node.directions.col(0)));
      } else if (parent.planar) {
        node.columns.col(0) = parent.flat.move(node.directions.col(0));
      } else {
        node.columns.col(0) = parent.place.move(node.directions.col(0));
      }
      if (node.rotor) {
        node.spin_here = parent.planar ? parent.flat.move_wrench(node.spin)
                                       : parent.place.move_wrench(node.spin);
      }
    }
  }
}

}  // namespace hamel::mechanisms
