// What mechanisms answer to motion(): against differences, and fast motions against what they are
// known to be.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <hamel/framework/check/laws.hpp>
#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/systems/mechanisms/contact.hpp>
#include <hamel/systems/mechanisms/library.hpp>
#include <hamel/systems/mechanisms/mechanism_file.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "mechanism_systems.hpp"

namespace hamel {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Differences of order 6 at two steps, extrapolated to order 8: truncation and round-off are below
// 1e-10 of the values.
template <class F>
auto slope(F&& f) {
  const auto coarse = check::derivative(f, 8e-3), fine = check::derivative(f, 4e-3);
  return ((64 * fine - coarse) / 63).eval();
}

// motion() at a pose off the rows, in a motion that satisfies none: the formulas need no more than
// a curve.
void check_rates(const SystemModel& model) {
  SCOPED_TRACE(model.name);
  const Mechanics& mechanics = *model.mechanics;
  if (mechanics.left_invariant()) return;  // nothing changes
  const auto geometry = registry().geometry(model.group.name, "exp");
  const int n = mechanics.dim(), k = mechanics.constraint_count();
  VectorXd g(geometry->size()), moved(g.size()), xi(n), shift(n), b(k), rows(k), change(n),
      expected(n), force(n), inertial(n), carried(n);
  MatrixXd a(k, n), inertia(n, n);
  geometry->from_coordinates(model.start.configuration, g.data());
  for (int pose = 0; pose < 3; ++pose) {
    for (int i = 0; i < n; ++i) {
      xi[i] = std::sin(3.0 * i + 1 + pose);
      shift[i] = 0.2 * std::sin(5.0 * i + 2);
    }
    geometry->tau(shift.data(), moved.data());
    geometry->compose(g.data(), moved.data(), g.data());
    const double t = 0.3 + pose;
    const auto at = [&](double e) {
      const VectorXd step = e * xi;
      geometry->tau(step.data(), moved.data());
      geometry->compose(g.data(), moved.data(), moved.data());
      mechanics.constraints(t + e, moved.data(), a, b);
      mechanics.inertia(moved.data(), inertia);
    };
    const VectorXd rows_change = slope([&](double e) -> VectorXd {
      at(e);
      return b - a * xi;
    });
    const VectorXd momentum_change = slope([&](double e) -> VectorXd {
      at(e);
      return inertia * xi;
    });
    at(0);
    MatrixXd same_a = a, same_inertia = inertia;
    VectorXd same_b = b;
    mechanics.motion(*geometry, t, g.data(), xi, same_inertia, same_a, same_b, rows, change);
    EXPECT_LE((same_a - a).norm(), 1e-14 * a.norm());
    EXPECT_LE((same_b - b).norm(), 1e-14 * b.norm());
    EXPECT_EQ(same_inertia, inertia);
    mechanics.constraint_values(t, g.data(), xi, same_b);
    EXPECT_LE((same_b - (a * xi - b)).norm(), 1e-14 * (b.norm() + a.norm() * xi.norm()));
    for (int i = 0; i < k; ++i)
      EXPECT_NEAR(rows[i], rows_change[i], 1e-8 * (1 + std::abs(rows[i]))) << "row " << i;
    mechanics.momentum(g.data(), xi, carried, inertial);
    EXPECT_LE((carried - inertia * xi).norm(), 1e-14 * inertia.norm() * xi.norm());
    geometry->ad_transpose(xi.data(), carried.data(), expected.data());
    mechanics.force(t, g.data(), xi, force);
    expected += force - momentum_change;
    for (int i = 0; i < n; ++i)
      EXPECT_NEAR(change[i], expected[i], 1e-8 * (1 + inertia.norm())) << "velocity " << i;
    if (mechanics.has_accelerations()) {
      EquationsOfMotion<DynamicProblem> equations(DynamicProblem(geometry, model.mechanics));
      equations.solve(t, g, xi);
      mechanics.accelerations(t, g.data(), xi, change);
      const double size = equations.acceleration().norm() + xi.squaredNorm();
      // Loops that contradict each other have rows that depend on each other.
      if (size < 1e6) {
        EXPECT_LE((change - equations.acceleration()).norm(), 1e-9 * size);
      }
    }
    mechanics.applied_force(t, g.data(), xi, carried);
    EXPECT_LE((carried + inertial - force).norm(), 1e-14 * (1 + force.norm() + carried.norm()));
  }
}

// All joints and contacts, on ground that turns or rests, with loops or a prescribed joint (which
// contradict each other); planar links with and without links that tilt.
Mechanism contacts(bool space, bool moving_ground, bool loops) {
  Mechanism m(std::string(space ? "in space" : "on the plane") +
              (moving_ground ? ", on a turntable" : "") + (loops ? ", closed" : ""));
  m.body("a", {.mass = 2, .at = {0.1, 0.2, 0.6}, .inertia = {0.3, 0.4, 0.5}});
  m.body("b", {.mass = 1, .at = {0.5, 0.1, 0.7}, .inertia = {0.1, 0.02, 0, 0.2, 0.01, 0.15}});
  m.body("c", {.mass = 0.5, .at = {0.9, 0, 0.4}, .cylinder = {0.1, 0.3}, .axis = {1, 1, 0}});
  m.body("d", {.mass = 0.7, .at = {0, -0.4, 0.3}, .sphere = 0.3});
  m.body("e", {.mass = 0.4, .at = {-0.4, 0, 0.5}, .box = {0.1, 0.2, 0.3}});
  m.body("f", {.mass = 0.3, .at = {-0.6, 0.1, 0.5}, .inertia = {0.01, 0.01, 0.015}});
  m.body("g", {.mass = 0.6, .at = {0.3, 0.5, 0.35}, .inertia = {0.02, 0.03, 0.02}});
  m.body("h", {.mass = 0.6, .at = {0.3, -0.5, 0.35}, .inertia = {0.02, 0.03, 0.02}});
  if (space) m.free("root", "a", {.at = {0, 0, 0.5}});
  else m.planar("root", "a");
  m.hinge("h", "a", "b", {.at = {0.3, 0, 0.5}, .axis = {0, 0, 1}});
  m.slider("s", "b", "c", {.at = {0.7, 0, 0.5}, .axis = {1, 0.2, 0}});
  m.ball_joint("j", "b", "d", {.at = {0, -0.2, 0.4}});
  m.universal("u", "a", "e", {.at = {-0.2, 0, 0.5}, .axis = {0, 0, 1}, .axis2 = {0, 1, 0}});
  m.joint("planar", "p", "e", "f", {.at = {-0.5, 0, 0.5}, .axis = {0, 1, 1}});
  m.hinge("w", "b", "g", {.at = {0.3, 0.5, 0.35}, .axis = {0, 1, 0}});
  m.hinge("v", "f", "h", {.at = {0.3, -0.5, 0.35}, .axis = {0, 1, 0}});
  m.wheel("w", "g", {.at = {0.3, 0.5, 0.35}, .radius = 0.35});
  m.roller("v", "h", {.at = {0.3, -0.5, 0.35}, .radius = 0.35, .angle = 0.6});
  m.ball("d", "d", {.at = {0, -0.4, 0.3}, .radius = 0.3});
  m.blade("c", "c", {.at = {0.9, 0, 0}, .along = {1, 0.3, 0}});
  if (loops) m.loop("hinge", "f", "d", {.at = {0, 0.3, 0.4}, .axis = {0.6, 0, 0.8}});
  if (loops) m.loop("ball", "c", "ground", {.at = {0.9, 0, 0.3}});
  if (!loops) m.prescribe("s", [](double t) { return std::sin(3 * t); });
  if (moving_ground) m.ground(0.7, {0.2, -0.1, 0});
  m.redundant("drop");
  return m;
}

TEST(MechanismRates, AreThoseOfDifferences) {
  for (const auto& [name, text] : mechanisms::library()) check_rates(mechanism_from(text, name));
  for (const bool space : {true, false}) {
    for (const bool loops : {true, false}) check_rates(contacts(space, false, loops).model());
  }
  check_rates(contacts(true, true, false).model());
}

// Balls on and inside spheres and cylinders of bodies that move, of one root and of two.
TEST(MechanismRates, OfRollingPairsAreThoseOfDifferences) {
  for (const bool one_root : {true, false}) {
    for (const bool cylinder : {true, false}) {
      for (const bool inside : {true, false}) {
        SCOPED_TRACE(testing::Message() << one_root << cylinder << inside);
        Mechanism m("pair");
        BodyOptions shell{.mass = 2, .at = {0, 0, 1}, .inertia = {0.3, 0.4, 0.5}};
        if (cylinder) {
          shell.cylinder = {0.5, 1};
          shell.axis = {0.6, 0.8, 0};
        } else {
          shell.sphere = 0.5;
        }
        const double apart = inside ? 0.4 : 0.6;
        const Point at = {-0.48 * apart, 0.36 * apart, 1 + 0.8 * apart};  // across the axis
        m.body("shell", shell);
        m.body("it", {.mass = 1, .at = at, .inertia = {0.1, 0.02, 0, 0.2, 0.01, 0.15}});
        m.free("root", "shell", {.at = {0.1, 0, 1}});
        if (one_root) {
          m.body("arm", {.mass = 0.5, .at = {0.2, 0.1, 1.2}, .inertia = {0.1, 0.1, 0.1}});
          m.slider("s", "shell", "arm", {.at = {0, 0, 1}, .axis = {0.6, 0, 0.8}});
          m.ball_joint("j", "arm", "it", {.at = {0.2, 0.1, 1.2}});
        } else {
          m.free("other", "it", {.at = {0.2, 0.1, 1.2}});
        }
        m.ball("pair", "it",
               {.at = at,
                .radius = 0.1,
                .on = inside ? "" : "shell",
                .inside = inside ? "shell" : ""});
        check_rates(m.model());
      }
    }
  }
}

// Couplings of every kind, beside all joints and contacts.
TEST(MechanismRates, OfCouplingsAreThoseOfDifferences) {
  const std::vector<CouplingOptions> kinds = {
      {.joint = "s", .to = "h", .ratio = 0.3, .offset = 0.1},
      {.formula = "s.position - k*sin(h.angle)*exp(0.3*w.angle) + h.angle^2",
       .constants = {{"k", {0.2}}}},
      {.rates = "sin(s.position)*h.rate - w.rate*cos(w.angle) + 0.3*v1"},
  };
  for (const CouplingOptions& kind : kinds) {
    Mechanism m = contacts(true, false, false);
    m.coupling("coupling", kind);
    check_rates(m.model());
  }
}

// A state beside all joints and contacts, with terms of a coordinate, velocities, itself and none.
TEST(MechanismRates, OfStatesAreThoseOfDifferences) {
  Mechanism m = contacts(true, false, false);
  m.state("state", {.rate = "sin(s.position)*h.rate - 2*state + 0.3*v1*cos(h.angle) + 0.7"});
  check_rates(m.model());
}

// Values that each field of a kind may have.
Parameters some_values(const std::vector<Field>& fields) {
  Parameters out;
  for (const Field& field : fields)
    if (field.range.least == 0) out[field.name] = std::vector<double>(field.value.size(), 0.35);
  return out;
}

// Also of kinds that a user adds: each is an entry of these lists.
TEST(MechanismRates, OfEveryKindOfJointAreThoseOfDifferences) {
  for (const mechanisms::JointKind& kind : mechanisms::joint_kinds()) {
    Mechanism m(kind.name);
    m.body("a", {.mass = 2, .at = {0.1, 0.2, 0.6}, .inertia = {0.3, 0.4, 0.5}});
    m.body("b", {.mass = 1, .at = {0.5, 0.1, 0.7}, .inertia = {0.1, 0.02, 0, 0.2, 0.01, 0.15}});
    m.body("c", {.mass = 0.4, .at = {-0.4, 0, 0.5}, .box = {0.1, 0.2, 0.3}});
    m.free("root", "a", {.at = {0, 0, 0.5}});
    m.joint(kind.name, "any", "a", "b",
            {.at = {0.3, 0, 0.5}, .axis = {0.6, 0, 0.8}, .values = some_values(kind.fields)});
    m.hinge("last", "b", "c", {.at = {0, 0.1, 0.4}, .axis = {1, 1, 0}});
    m.blade("edge", "c", {.at = {-0.4, 0, 0}});
    check_rates(m.model());
  }
}

TEST(MechanismRates, OfEveryKindOfContactAreThoseOfDifferences) {
  for (const mechanisms::ContactKind& kind : mechanisms::contact_kinds()) {
    const Parameters values = some_values(kind.fields);
    const bool is_round = values.contains("radius") || values.contains("semi_axes");
    const double height = is_round ? 0.35 : 0;
    for (const char* ground : {"at rest", "on a turntable", "on hills"}) {
      Mechanism m(kind.name + ", " + ground);
      m.body("a", {.mass = 2, .at = {0.1, 0.2, 0.6}, .inertia = {0.3, 0.4, 0.5}});
      m.body("b", {.mass = 1, .at = {0.5, 0.1, 0.7}, .inertia = {0.1, 0.02, 0, 0.2, 0.01, 0.15}});
      m.free("root", "a", {.at = {0, 0, 0.5}});
      m.hinge("h", "a", "b", {.at = {0.3, 0, 0.5}, .axis = {0.6, 0, 0.8}});
      m.contact(kind.name, "c", "b", {.at = {0.4, 0.1, height}, .values = values});
      if (ground == std::string("on a turntable")) m.ground(0.7, {0.2, -0.1, 0});
      if (ground == std::string("on hills"))
        m.ground_height("0.2*sin(x + k)*cos(0.7*y) - k*x", {{"k", {0.3}}});
      check_rates(m.model());
    }
  }
}

// A disk that falls from upright until it is nearly flat, when its contact races round the rim.
TEST(MechanismRates, OfADiskNearlyFlat) {
  FallingDisk disk;
  disk.radius = 1;
  disk.axial_inertia = 0.5;
  disk.diametral_inertia = 0.25;
  const double upright = 1.5707963267948966;
  const Mat<3, 3> r = body_on_plane::leaning(upright).rotation;
  const Vec<3> omega(0.1, 0, 0.02), v = -omega.cross(r * Vec<3>(0, -disk.radius, 0));
  const Vec<3> own = r.transpose() * omega, own_v = r.transpose() * v;
  const auto go = [](Simulation simulation, const Start& start) {
    const Result result =
        simulation.start(start).scheme("dop853").tolerance({.relative = 1e-12}).until(2.5).run();
    EXPECT_TRUE(result.status.ok) << result.status.reason;
    return result;
  };
  Start start = by_parts::disk(disk, upright).model().start, hers_start = disk.start();
  start.velocity = {omega[0], omega[1], omega[2], v[0], v[1], v[2]};
  for (int i = 0; i < 9; ++i) hers_start.configuration[static_cast<size_t>(i)] = r(i / 3, i % 3);
  for (size_t i = 9; i < 12; ++i) hers_start.configuration[i] = i == 11 ? disk.radius : 0;
  hers_start.velocity = {own[0], own[1], own[2], own_v[0], own_v[1], own_v[2]};
  const Result ours = go(simulate(by_parts::disk(disk, upright)), start),
               hers = go(simulate(disk), hers_start);
  Vec<3> turning(hers.last.velocity[0], hers.last.velocity[1], hers.last.velocity[2]);
  turning = r * turning;
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(ours.last.velocity[static_cast<size_t>(i)], turning[i], 1e-8) << i;
  EXPECT_NEAR(ours.last.energy, hers.last.energy, 1e-10);
}

// Each joint turns through twelve places, in some of which pivots of the frame vanish.
TEST(MechanismAccelerations, AreThoseOfTheEquationsWhereverPivotsVanish) {
  for (const char* name : {"bicycle", "kick_scooter", "car", "ballbot", "two_trailer_truck"}) {
    SCOPED_TRACE(name);
    const SystemModel model = registry().system(name)->make({});
    const Mechanics& mechanics = *model.mechanics;
    const auto geometry = registry().geometry(model.group.name, "exp");
    const int n = mechanics.dim();
    ASSERT_TRUE(mechanics.has_accelerations());
    EquationsOfMotion<DynamicProblem> equations(DynamicProblem(geometry, model.mechanics));
    VectorXd start(geometry->size()), g(start), step(n), xi(n), found(n);
    geometry->from_coordinates(model.start.configuration, start.data());
    int compared = 0;
    for (int i = 0; i < n; ++i) xi[i] = std::sin(3.0 * i + 1);
    for (int joint = 0; joint < n; ++joint) {
      for (int place = 0; place < 12; ++place) {
        step = place * (std::numbers::pi / 6) * VectorXd::Unit(n, joint);
        geometry->tau(step.data(), g.data());
        geometry->compose(start.data(), g.data(), g.data());
        equations.solve(0, g, xi);
        const double size = equations.acceleration().norm();
        if (!(size < 1e6)) continue;  // the rows depend on each other there
        mechanics.accelerations(0, g.data(), xi, found);
        EXPECT_LE((found - equations.acceleration()).norm(), 1e-8 * (size + 1))
            << "velocity " << joint << ", place " << place;
        ++compared;
      }
    }
    EXPECT_GT(compared, 10 * n);
  }
}

}  // namespace
}  // namespace hamel
