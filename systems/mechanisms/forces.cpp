#include <hamel/systems/mechanisms/forces.hpp>

#include <algorithm>

namespace hamel::mechanisms {
namespace {

double coordinate(const Tree& tree, int link, const double* g) {
  return tree.joint(link).coordinate(g + tree.element(link));
}

// The line between the ends of a spring, from a to b, in the world.
struct Line {
  Vec3 from, to, along;
  double length;
  Line(const Spring& spring, const Tree& tree)
      : from(tree.in_world(spring.a).apply(spring.at_a)),
        to(tree.in_world(spring.b).apply(spring.at_b)),
        along(to - from),
        length(along.norm()) {
    if (length > 0) along /= length;
  }
};

template <class Out>
void pull(const Tree& tree, int link, const Vec3& x, const Vec3& force, Out& out) {
  if (link == kGround) return;
  const Rigid& root = tree.root_in_world(link);
  tree.add_wrench(link, force_at(root.inverse().apply(x), root.rotation.transpose() * force), out);
}

// Velocity of the point of a link that is at x.
Vec3 velocity(const Tree& tree, int link, const Vec3& x) {
  const Rigid& root = tree.root_in_world(link);
  return root.rotation * velocity_at(tree.twist(link), root.inverse().apply(x));
}

}  // namespace

bool Forces::damped() const {
  return std::any_of(springs.begin(), springs.end(),
                     [](const Spring& s) { return s.damping != 0; });
}
bool Forces::time_dependent() const {
  const auto changes = [](const auto& part) { return part.time_dependent; };
  return std::ranges::any_of(motors, changes) || std::ranges::any_of(forces, changes);
}
bool Forces::any() const { return has_signals() || damped(); }

double Forces::potential(const Tree& tree, const double* g) const {
  double v = 0;
  for (int j = 0; j < tree.links(); ++j) {
    if (tree.parent(j) != kGround) continue;
    const Rigid& root = tree.root_in_world(j);
    const Inertia& all = tree.composite(j);
    v -= gravity.dot(root.rotation * all.first + all.mass * root.position);
  }
  for (const Spring& spring : springs) {
    const double now =
        spring.joint < 0 ? Line(spring, tree).length : coordinate(tree, spring.joint, g);
    v += 0.5 * spring.stiffness * (now - spring.rest) * (now - spring.rest);
  }
  return v;
}

void Forces::add_potential_force(const Tree& tree, const double* g,
                                 Eigen::Ref<Eigen::VectorXd> out) const {
  tree.add_weight(gravity, out);
  add_spring_force(tree, g, out);
}

void Forces::add_spring_force(const Tree& tree, const double* g,
                              Eigen::Ref<Eigen::VectorXd> out) const {
  for (const Spring& spring : springs) {
    if (spring.stiffness == 0) continue;
    if (spring.joint >= 0) {
      out[tree.first(spring.joint)] -=
          spring.stiffness * (coordinate(tree, spring.joint, g) - spring.rest);
      continue;
    }
    const Line line(spring, tree);
    const Vec3 force = spring.stiffness * (line.length - spring.rest) * line.along;
    pull(tree, spring.a, line.from, force, out);
    pull(tree, spring.b, line.to, -force, out);
  }
}

void Forces::add_force(const Tree& tree, const SignalInput& now,
                       Eigen::Ref<Eigen::VectorXd> out) const {
  for (const Spring& spring : springs) {
    if (spring.damping == 0) continue;
    if (spring.joint >= 0) {
      const int dof = tree.first(spring.joint);
      out[dof] -= spring.damping * now.velocity[static_cast<size_t>(dof)];
      continue;
    }
    const Line line(spring, tree);
    const double rate =
        line.along.dot(velocity(tree, spring.b, line.to) - velocity(tree, spring.a, line.from));
    const Vec3 force = spring.damping * rate * line.along;
    pull(tree, spring.a, line.from, force, out);
    pull(tree, spring.b, line.to, -force, out);
  }
  for (const Motor& motor : motors) out[motor.dof] += motor.effort(now);
  for (const Force& force : forces) {
    Vec3 f;
    for (int i = 0; i < 3; ++i) f[i] = force.along[i] ? force.along[i](now) : 0.0;
    const Rigid here = tree.in_world(force.link);
    if (force.of_body) f = here.rotation * f;
    pull(tree, force.link, here.apply(force.at), f, out);
  }
}

}  // namespace hamel::mechanisms
