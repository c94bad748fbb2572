#include <hamel/systems/mechanisms/tree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hamel::mechanisms {
namespace {

bool same(const Inertia& a, const Inertia& b) {
  const double near = 1e-14 * a.second.lpNorm<Eigen::Infinity>();
  return (a.second - b.second).lpNorm<Eigen::Infinity>() <= near &&
         (a.first - b.first).squaredNorm() <= near * 1e-14 * a.mass;
}

bool is_zero(const Rigid& x) { return x.rotation.isZero(0) && x.position.isZero(0); }

// Affine in the numbers of an element, as its group lays it out: a sum at numbers that are no
// element shows it.
bool is_affine(const Link& link, const Rigid& constant, const std::vector<Rigid>& terms) {
  std::vector<double> any(terms.size());
  Rigid sum = constant;
  for (size_t i = 0; i < any.size(); ++i) {
    any[i] = std::sin(2.0 * static_cast<double>(i) + 1);
    sum.rotation += any[i] * terms[i].rotation;
    sum.position += any[i] * terms[i].position;
  }
  const Rigid motion = link.joint->motion(any.data());
  return motion.rotation.isApprox(sum.rotation, 1e-14) &&
         (motion.position - sum.position).norm() <= 1e-14 * (1 + sum.position.norm());
}

}  // namespace

MotionTerms::MotionTerms(const Link& link) {
  std::vector<double> element(static_cast<size_t>(link.joint->geometry()->size()), 0.0);
  const Rigid zero = link.joint->motion(element.data());
  std::vector<Rigid> all;
  for (double& number : element) {
    number = 1;
    const Rigid one = link.joint->motion(element.data());
    number = 0;
    all.push_back({one.rotation - zero.rotation, one.position - zero.position});
  }
  const auto used =
      static_cast<size_t>(std::ranges::count_if(all, [](const Rigid& x) { return !is_zero(x); }));
  if (used > terms.size() || !is_affine(link, zero, all)) return;
  const Rigid& before = link.on_parent;
  const Rigid after = link.on_child.inverse();
  const auto between = [&](const Rigid& x) {  // but for the position of P
    const Mat<3, 3> rotation = before.rotation * x.rotation;
    return Rigid{rotation * after.rotation,
                 rotation * after.position + before.rotation * x.position};
  };
  constant = between(zero);
  constant.position += before.position;
  for (const bool turns : {true, false}) {
    for (size_t i = 0; i < all.size(); ++i) {
      if (is_zero(all[i]) || all[i].rotation.isZero(0) == turns) continue;
      numbers[static_cast<size_t>(count)] = static_cast<int>(i);
      terms[static_cast<size_t>(count++)] = between(all[i]);
    }
    if (turns) turning = count;
  }
}

Rigid MotionTerms::sum(const double* g) const {
  Rigid out = constant;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<size_t>(i);
    if (i < turning) out.rotation += g[numbers[k]] * terms[k].rotation;
    out.position += g[numbers[k]] * terms[k].position;
  }
  return out;
}

PlaneMotion MotionTerms::sum_in_plane(const double* g) const {
  PlaneMotion out{constant.rotation(0, 0), constant.rotation(1, 0), constant.position[0],
                  constant.position[1]};
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<size_t>(i);
    const double x = g[numbers[k]];
    out.c += x * terms[k].rotation(0, 0);
    out.s += x * terms[k].rotation(1, 0);
    out.x += x * terms[k].position[0];
    out.y += x * terms[k].position[1];
  }
  return out;
}

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
    const Joint::Directions& s = link.joint->directions();
    node.count = link.joint->dim();
    const Rigid& frame = node.count == 1 && !is_root ? link.on_parent : link.on_child;
    for (int i = 0; i < node.count; ++i) node.directions.col(i) = frame.move(s.col(i));
    node.columns = node.directions;
    node.after = link.on_child.inverse();
    node.terms = MotionTerms(link);
    node.inertia = link.inertia;
    dim_ += node.count;
    const std::vector<double> drawn =
        link.joint->element_of(link.on_parent.inverse() * link.on_child);
    size_ += static_cast<int>(drawn.size());
    drawn_.insert(drawn_.end(), drawn.begin(), drawn.end());
    find_planar(node, drawn.data());
    node.free = is_free(node);
    nodes_.push_back(std::move(node));
  }
  find_rotors();
  for (Node& node : nodes_) node.own = node.inertia;
  find_turned();
  placed_.assign(drawn_.size(), std::numeric_limits<double>::quiet_NaN());
  moved_.resize(static_cast<size_t>(dim_));
  place(drawn_.data());
  accumulate_inertia();
}

// All velocities of space or of the plane, in the axes of the world as drawn.
bool Tree::is_free(const Node& node) {
  const Link& link = node.link;
  const Mat<6, 6> all = Mat<6, 6>::Identity();
  const Joint::Directions& s = link.joint->directions();
  return link.parent == kGround && link.on_child.rotation.isIdentity(0) &&
         ((node.planar && node.count == 3 && s == all.middleCols<3>(2)) ||
          (node.count == 6 && s == all && link.on_parent.rotation.isIdentity(0) &&
           link.on_parent.position.isZero(0)));
}

// Its parent planar, its motion in the plane; of a link that is no root one number.
void Tree::find_planar(Node& node, const double* drawn) const {
  const bool is_root = node.link.parent == kGround;
  if (node.terms.count == 0) return;
  if (!is_root && (!at(node.link.parent).planar || node.count > 1)) return;
  double off = 0;
  for (int i = 0; i < node.count; ++i) {
    off = std::max({off, node.directions.col(i).head<2>().lpNorm<Eigen::Infinity>(),
                    std::abs(node.directions(5, i))});
  }
  if (!is_root) off = std::max(off, std::abs(node.terms.sum(drawn).position[2]));
  node.planar = off <= 1e-14 * (1 + node.link.on_parent.position.norm());
}

void Tree::find_rotors() {
  for (Node& node : nodes_)
    node.rotor = node.link.joint->only_turns() && node.link.parent != kGround;
  for (const Node& node : nodes_)
    if (node.link.parent != kGround) at(node.link.parent).rotor = false;
  for (Node& node : nodes_) {
    if (!node.rotor) continue;
    const auto turned = [&](double angle) {
      const Geometry& geometry = *node.link.joint->geometry();
      std::vector<double> element(static_cast<size_t>(geometry.size()));
      geometry.tau(&angle, element.data());
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

void Tree::find_turned() {
  for (Node& node : nodes_) {
    node.turns = node.on_root && !node.planar && !node.rotor && node.terms.count == 2 &&
                 node.link.joint->only_turns();
    const Node& turning = node.rotor ? at(node.link.parent) : node;
    if (!turning.turns) continue;
    const auto place = [&](double angle) {
      std::vector<double> element(static_cast<size_t>(turning.link.joint->geometry()->size()));
      turning.link.joint->geometry()->tau(&angle, element.data());
      return turning.across(element.data());
    };
    if (node.rotor) {
      node.turned_spin.find([&](double angle) {
        const Rigid x = place(angle);
        Vec<12> out;
        out << x.move(node.directions.col(0)), x.move_wrench(node.spin);
        return out;
      });
    } else {
      node.turned_inertia.find([&](double angle) {
        const Inertia seen = moved(place(angle), node.inertia);
        Vec<12> out;
        out << seen.first, seen.second.reshaped();
        return out;
      });
    }
  }
}

Rigid Tree::Node::across(const double* g) const {
  if (free && !planar) {  // P = 1, and C shifts
    Rigid out = link.joint->motion(g);
    out.position += out.rotation.lazyProduct(after.position);
    return out;
  }
  return terms.count > 0 ? terms.sum(g) : link.on_parent * link.joint->motion(g) * after;
}

Rigid Tree::from_root(int link) const {
  if (const Rigid* const known = known_from_root(link)) return *known;
  const Node& node = at(link);
  if (node.planar) return node.flat.in_space();
  return from_root(node.link.parent) * node.across(placed_.data() + node.element);  // a rotor
}

// X of a link.
void Tree::place_link(Node& node, const Node& parent, const double* element) {
  if (node.planar) {
    node.flat = node.terms.sum_in_plane(element);
    if (!node.on_root) node.flat = parent.flat * node.flat;
  } else if (!node.rotor) {
    node.place = node.across(element);
    if (!node.on_root)
      node.place = (parent.planar ? parent.flat.in_space() : parent.place) * node.place;
  }
}

// Ad_X S of a link, and the spin of a rotor; its parent is placed.
void Tree::place_columns(Node& node, const Node& parent, const double* g) {
  if (node.count > 1) {
    for (int i = 0; i < node.count; ++i)
      node.columns.col(i) = node.place.move(node.directions.col(i));
  } else if (node.rotor && parent.turns) {
    const double* turned = g + parent.element;
    const Vec<12> seen = node.turned_spin.at(turned[0], turned[1]);
    node.columns.col(0) = seen.head<6>();
    node.spin_here = seen.tail<6>();
  } else if (!node.on_root) {
    if (node.planar) {
      in_plane(node.columns.col(0)) = parent.flat.move_in_plane(in_plane(node.directions.col(0)));
    } else if (parent.planar) {
      node.columns.col(0) = parent.flat.move(node.directions.col(0));
    } else {
      node.columns.col(0) = parent.place.move(node.directions.col(0));
    }
    if (node.rotor) {
      node.spin_here =
          parent.planar ? parent.flat.move_wrench(node.spin) : parent.place.move_wrench(node.spin);
    }
  }
}

HAMEL_FLATTEN void Tree::place(const double* g) {
  if (placed_at(g)) return;
  std::memcpy(placed_.data(), g, placed_.size() * sizeof(double));
  turned_ = carries_ = moves_ = false;
  for (Node& node : nodes_) {
    const double* element = g + node.element;
    if (node.link.parent == kGround) {
      node.world = node.across(element);
      continue;
    }
    const Node& parent = at(node.link.parent);
    place_link(node, parent, element);
    place_columns(node, parent, g);
  }
}

}  // namespace hamel::mechanisms
