#include <hamel/systems/mechanisms/programs/force_formulas.hpp>

namespace hamel::mechanisms {
namespace {

// A force at a point of a link, both seen from its root.
void pull(const BodyFormulas& bodies, int link, const NumberVec3& q, const NumberVec3& force,
          std::vector<Number>& out) {
  bodies.each_effect(link, q, force,
                     [&](int i, const Number& effect) { out[static_cast<size_t>(i)] += effect; });
}

void twist(const BodyFormulas& bodies, int link, const NumberVec3& torque,
           std::vector<Number>& out) {
  bodies.each_turning(link, torque,
                      [&](int i, const Number& effect) { out[static_cast<size_t>(i)] += effect; });
}

// The line between the ends of a spring, from a to b: seen from their root where it is one, else
// from the world.
class SpringLine {
 public:
  SpringLine(const Spring& spring, const BodyFormulas& bodies)
      : spring_(spring),
        bodies_(bodies),
        a_(bodies.point(spring.a, spring.at_a)),
        b_(bodies.point(spring.b, spring.at_b)),
        root_a_(bodies.root_in_world(spring.a)),
        root_b_(bodies.root_in_world(spring.b)),
        one_root_(&root_a_ == &root_b_) {
    along_ = one_root_ ? NumberVec3(b_ - a_) : NumberVec3(root_b_.apply(b_) - root_a_.apply(a_));
    length = sqrt(along_.squaredNorm());
    along_ *= select(length > 0, 1 / length, 0);
  }

  Number length;

  Number rate() const {
    const NumberVec3 v_a = bodies_.velocity(spring_.a, a_), v_b = bodies_.velocity(spring_.b, b_);
    if (one_root_) return dot(along_, v_b - v_a);
    return dot(along_, root_b_.turn(v_b) - root_a_.turn(v_a));
  }
  /// The ends draw each other.
  void add(const Number& size, std::vector<Number>& out) const {
    const NumberVec3 force = size * along_, opposite = -force;
    pull(bodies_, spring_.a, a_, one_root_ ? force : root_a_.turn_back(force), out);
    pull(bodies_, spring_.b, b_, one_root_ ? opposite : root_b_.turn_back(opposite), out);
  }

 private:
  const Spring& spring_;
  const BodyFormulas& bodies_;
  NumberVec3 a_, b_, along_;
  const Pose &root_a_, &root_b_;
  bool one_root_;
};

}  // namespace

size_t count_signals(const Forces& forces) {
  return forces.springs.size() + forces.motors.size() + 3 * forces.forces.size();
}

void find_coordinates(const Forces& forces, const Tree& tree, const double* g, double* out) {
  for (const Spring& spring : forces.springs) {
    const int joint = spring.joint;
    *out++ = joint < 0 ? 0 : tree.joint(joint).coordinate(g + tree.element(joint));
  }
}

void find_signals(const Forces& forces, const Tree& tree, const double* g, const SignalInput& now,
                  double* out) {
  find_coordinates(forces, tree, g, out);
  out += forces.springs.size();
  for (const Motor& motor : forces.motors) *out++ = motor.effort(now);
  for (const Force& force : forces.forces)
    for (const Signal& along : force.along) *out++ = along ? along(now) : 0;
}

void add_springs(const Forces& forces, const BodyFormulas& bodies, std::span<const Number> signals,
                 std::vector<Number>& out) {
  for (size_t i = 0; i < forces.springs.size(); ++i) {
    const Spring& spring = forces.springs[i];
    if (spring.stiffness == 0) continue;
    if (spring.joint >= 0) {
      out[static_cast<size_t>(bodies.tree().first(spring.joint))] -=
          spring.stiffness * (signals[i] - spring.rest);
    } else {
      const SpringLine line(spring, bodies);
      line.add(spring.stiffness * (line.length - spring.rest), out);
    }
  }
}

void add_given(const Forces& forces, const BodyFormulas& bodies, std::span<const Number> xi,
               std::span<const Number> signals, std::vector<Number>& out) {
  for (const Spring& spring : forces.springs) {
    if (spring.damping == 0) continue;
    if (spring.joint >= 0) {
      const auto dof = static_cast<size_t>(bodies.tree().first(spring.joint));
      out[dof] -= spring.damping * xi[dof];
    } else {
      const SpringLine line(spring, bodies);
      line.add(spring.damping * line.rate(), out);
    }
  }
  size_t next = forces.springs.size();
  for (const Motor& motor : forces.motors) out[static_cast<size_t>(motor.dof)] += signals[next++];
  for (const Force& force : forces.forces) {
    const NumberVec3 f{signals[next], signals[next + 1], signals[next + 2]};
    next += 3;
    const NumberVec3 seen = force.of_body ? bodies.turned(force.link, f)
                                          : bodies.root_in_world(force.link).turn_back(f);
    if (force.couple) twist(bodies, force.link, seen, out);
    else pull(bodies, force.link, bodies.point(force.link, force.at), seen, out);
  }
}

Number potential_of_springs(const Forces& forces, const BodyFormulas& bodies,
                            std::span<const Number> signals) {
  Number out = 0;
  for (size_t i = 0; i < forces.springs.size(); ++i) {
    const Spring& spring = forces.springs[i];
    const Number now = spring.joint < 0 ? SpringLine(spring, bodies).length : signals[i];
    out += 0.5 * spring.stiffness * ((now - spring.rest) * (now - spring.rest));
  }
  return out;
}

}  // namespace hamel::mechanisms
