// Inertia, momenta, weights and efforts of a tree of bodies (body_formulas.hpp).
#include <hamel/systems/mechanisms/programs/body_formulas.hpp>

namespace hamel::mechanisms {

// ---- inertia ------------------------------------------------------------------------------------

// With all that each link carries, about the point p of its root.
std::vector<BodyFormulas::Moments> BodyFormulas::composites() const {
  std::vector<Moments> out(nodes_.size());
  for (int j = 0; j < tree_.links(); ++j) {
    if (tree_.rotor(j)) continue;
    const Moments& own = at(j).own;
    Moments& all = out[static_cast<size_t>(j)];
    int root = j;
    while (!is_root(root)) root = tree_.parent(root);
    const NumberVec3 r = at(j).place.position - at(root).place.position;
    all = {own.mass, own.first + own.mass * r, own.second};
    const auto both = [&](int a, int b) {
      return r[a] * own.first[b] + own.first[a] * r[b] + own.mass * (r[a] * r[b]);
    };
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      all.second(a, a) += both(b, b) + both(c, c);
      all.second(a, b) -= both(a, b);
      all.second(b, a) = all.second(a, b);
    }
  }
  for (int j = tree_.links() - 1; j >= 0; --j) {
    if (tree_.rotor(j) || is_root(j)) continue;
    const Moments& from = out[static_cast<size_t>(j)];
    Moments& to = out[static_cast<size_t>(tree_.parent(j))];
    to.mass += from.mass;
    to.first += from.first;
    to.second += from.second;
  }
  return out;
}

// A column of I, and the row that mirrors it: a momentum about the root's point, on the velocities
// of a link and of those that carry it.
void BodyFormulas::write(int link, int column, const NumberVec3& force, const NumberVec3& moment,
                         Matrix& out) const {
  int root = link;
  while (!is_root(root)) root = tree_.parent(root);
  for (int j = link; j != kGround; j = tree_.parent(j)) {
    const Node& node = at(j);
    const NumberVec3 about = moment - cross(node.place.position - at(root).place.position, force);
    for (size_t i = 0; i < node.turns.size(); ++i) {
      const auto row = static_cast<size_t>(tree_.first(j)) + i;
      const auto to = static_cast<size_t>(column);
      out[row][to] = out[to][row] = dot(node.turns[i], about) + dot(node.slides[i], force);
    }
  }
}

BodyFormulas::Matrix BodyFormulas::inertia() const {
  const auto n = static_cast<size_t>(dim());
  Matrix out(n, Numbers(n));
  const std::vector<Moments> all = composites();
  for (int j = 0; j < tree_.links(); ++j) {
    const Node& node = at(j);
    int root = j;
    while (!is_root(root)) root = tree_.parent(root);
    if (tree_.rotor(j)) {
      const int column = tree_.first(j);
      const Number moment = tree_.moment(j);
      out[static_cast<size_t>(column)][static_cast<size_t>(column)] = moment;
      write(tree_.parent(j), column, numbers(Vec3(Vec3::Zero())), moment * node.turns[0], out);
      continue;
    }
    const Moments& carried = all[static_cast<size_t>(j)];
    for (size_t i = 0; i < node.turns.size(); ++i) {
      const NumberVec3& turn = node.turns[i];
      const NumberVec3 slide =
          node.slides[i] + cross(node.place.position - at(root).place.position, turn);
      const NumberVec3 force = carried.mass * slide + cross(turn, carried.first);
      const NumberVec3 moment = carried.second.lazyProduct(turn) + cross(carried.first, slide);
      write(j, tree_.first(j) + static_cast<int>(i), force, moment, out);
    }
  }
  return out;
}

std::pair<BodyFormulas::Numbers, BodyFormulas::Numbers> BodyFormulas::momentum() const {
  struct Carried {
    NumberVec3 linear, angular;  // L, H about p_j
  };
  std::vector<Carried> all(nodes_.size());
  Numbers out(xi_.size()), inertial(xi_.size());
  for (int j = 0; j < tree_.links(); ++j) {
    Carried& here = all[static_cast<size_t>(j)];
    const Node& node = at(j);
    if (tree_.rotor(j)) {  // its inertia is its parent's, but for its spin
      const auto dof = static_cast<size_t>(tree_.first(j));
      const Number moment = tree_.moment(j);
      out[dof] = moment * (xi_[dof] + dot(node.turns[0], at(tree_.parent(j)).omega));
      here.linear = numbers(Vec3(Vec3::Zero()));
      here.angular = (moment * xi_[dof]) * node.turns[0];
    } else {
      const Moments& own = node.own;
      here.linear = own.mass * node.velocity + cross(node.omega, own.first);
      here.angular = own.second.lazyProduct(node.omega) + cross(own.first, node.velocity);
    }
  }
  for (int j = tree_.links() - 1; j >= 0; --j) {
    const Carried& here = all[static_cast<size_t>(j)];
    const Node& node = at(j);
    for (size_t i = 0; i < node.turns.size() && !tree_.rotor(j); ++i)
      out[static_cast<size_t>(tree_.first(j)) + i] =
          dot(node.turns[i], here.angular) + dot(node.slides[i], here.linear);
    if (is_root(j)) continue;
    const Node& parent = at(tree_.parent(j));
    const NumberVec3 r = node.place.position - parent.place.position;
    Carried& carrying = all[static_cast<size_t>(tree_.parent(j))];
    carrying.linear += here.linear;
    carrying.angular += here.angular + cross(r, here.linear);
    if (tree_.rotor(j)) continue;
    const NumberVec3 v = parent.velocity + cross(parent.omega, r);
    for (size_t i = 0; i < node.turns.size(); ++i)
      inertial[static_cast<size_t>(tree_.first(j)) + i] =
          dot(here.angular, cross(parent.omega, node.turns[i])) +
          dot(here.linear, cross(v, node.turns[i]) + cross(parent.omega, node.slides[i]));
  }
  return {std::move(out), std::move(inertial)};
}

BodyFormulas::Numbers BodyFormulas::weight() const {
  Numbers out(xi_.size());
  for (int j = 0; j < tree_.links(); ++j) {
    if (tree_.rotor(j)) continue;
    const Node& node = at(j);
    const NumberVec3 a = root_in_world(j).turn_back(numbers(gravity_));
    const NumberVec3 force = node.own.mass * a, moment = cross(node.own.first, a);
    each_effect(j, node.place.position, force,
                [&](int i, const Number& effect) { out[static_cast<size_t>(i)] += effect; });
    each_turning(j, moment,
                 [&](int i, const Number& effect) { out[static_cast<size_t>(i)] += effect; });
  }
  return out;
}

Number BodyFormulas::potential() const {
  Number out = 0;
  for (int j = 0; j < tree_.links(); ++j) {
    if (tree_.rotor(j)) continue;
    const Node& node = at(j);
    const Pose& root = root_in_world(j);
    const NumberVec3 first = node.own.first + node.own.mass * node.place.position;
    out -= dot(numbers(gravity_), root.turn(first) + node.own.mass * root.position);
  }
  return out;
}

Eigen::MatrixXd inertia_at(const Tree& tree, std::span<const double> g) {
  const graph::Recording recording;
  const std::vector<Number> constants(g.begin(), g.end()), still(static_cast<size_t>(tree.dim()));
  const BodyFormulas::Matrix found = BodyFormulas(tree, constants, still, Vec3::Zero()).inertia();
  Eigen::MatrixXd out(tree.dim(), tree.dim());
  for (int i = 0; i < tree.dim(); ++i)
    for (int j = 0; j < tree.dim(); ++j)
      out(i, j) = found[static_cast<size_t>(i)][static_cast<size_t>(j)].value();
  return out;
}

// ---- efforts ------------------------------------------------------------------------------------

BodyFormulas::Numbers BodyFormulas::efforts(std::span<const Number> xi_rate) const {
  struct Part {
    NumberVec3 turning, moving;  // a, l
    NumberVec3 force, moment;    // F, N
  };
  std::vector<Part> parts(nodes_.size());
  const auto part = [&](int link) -> Part& { return parts[static_cast<size_t>(link)]; };
  Numbers out(xi_.size());
  for (int j = 0; j < tree_.links(); ++j) {
    if (tree_.rotor(j)) continue;
    const Node& node = at(j);
    Part& here = part(j);
    here.turning = here.moving = numbers(Vec3(Vec3::Zero()));
    for (size_t i = 0; i < node.turns.size(); ++i) {
      const Number& rate = xi_rate[static_cast<size_t>(tree_.first(j)) + i];
      here.turning += rate * node.turns[i];
      here.moving += rate * node.slides[i];
    }
    if (is_root(j)) {
      here.moving += cross(node.omega, node.velocity) - node.world.turn_back(numbers(gravity_));
    } else {
      const Node& parent = at(tree_.parent(j));
      const Part& carrying = part(tree_.parent(j));
      const NumberVec3 r = node.place.position - parent.place.position;
      here.turning += carrying.turning + cross(parent.omega, node.turning);
      here.moving += carrying.moving + cross(carrying.turning, r) +
                     cross(parent.omega, cross(parent.omega, r)) +
                     Number(2) * cross(parent.omega, node.sliding) +
                     cross(node.turning, node.sliding);
    }
    const Moments& own = node.own;
    here.force = own.mass * here.moving + cross(here.turning, own.first) +
                 cross(node.omega, cross(node.omega, own.first));
    here.moment = own.second.lazyProduct(here.turning) +
                  cross(node.omega, NumberVec3(own.second.lazyProduct(node.omega))) +
                  cross(own.first, here.moving);
  }
  for (int j = 0; j < tree_.links(); ++j) {
    if (!tree_.rotor(j)) continue;
    const Node &node = at(j), &parent = at(tree_.parent(j));
    Part& carrying = part(tree_.parent(j));
    const auto dof = static_cast<size_t>(tree_.first(j));
    const Number moment = tree_.moment(j);
    out[dof] = moment * (xi_rate[dof] + dot(node.turns[0], carrying.turning));
    carrying.moment +=
        moment * (xi_rate[dof] * node.turns[0] + xi_[dof] * cross(parent.omega, node.turns[0]));
  }
  for (int j = tree_.links() - 1; j >= 0; --j) {
    if (tree_.rotor(j)) continue;
    const Node& node = at(j);
    const Part& here = part(j);
    for (size_t i = 0; i < node.turns.size(); ++i)
      out[static_cast<size_t>(tree_.first(j)) + i] =
          dot(node.turns[i], here.moment) + dot(node.slides[i], here.force);
    if (is_root(j)) continue;
    Part& carrying = part(tree_.parent(j));
    const NumberVec3 r = node.place.position - at(tree_.parent(j)).place.position;
    carrying.force += here.force;
    carrying.moment += here.moment + cross(r, here.force);
  }
  return out;
}

}  // namespace hamel::mechanisms
