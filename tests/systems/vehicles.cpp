// Vehicles, a blade and a ball on moving or inclined ground: closed forms, rates and propulsion.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <hamel/groups/exp.hpp>
#include <hamel/systems/n_trailer.hpp>
#include <hamel/systems/roller_racer.hpp>
#include <hamel/systems/segway.hpp>
#include <hamel/systems/simulate_typed.hpp>
#include <hamel/systems/snakeboard.hpp>

namespace hamel {
namespace {

Result run(Simulation simulation, double h, double until) {
  simulation.scheme("lift").s(0.5).retraction("exp").step(h).until(until);
  Result result = simulation.run();
  EXPECT_TRUE(result.status.ok) << result.status.reason;
  return result;
}

// u = S cos(phi), l theta' = S sin(phi), m S' = -(J_0/l) psi'' sin(phi) for J + J_0 + 2 J_1 = m
// l^2.
TEST(Snakeboard, FollowsTheEquationsOfOstrowski) {
  Snakeboard board;
  board.board_inertia = board.mass * board.half_length * board.half_length - board.rotor_inertia -
                        2 * board.axle_inertia;
  const auto steering = [&](double t) {
    return 0.2 + board.steering_amplitude * std::sin(board.frequency * t);
  };
  const double until = 8, speed = 0.5;
  double sum = speed / std::cos(steering(0));
  const int panels = 2000;  // Simpson
  for (int i = 0; i <= panels; ++i) {
    const double t = until * i / panels;
    const double weight = (i == 0 || i == panels ? 1 : i % 2 == 1 ? 4 : 2) * until / panels / 3;
    const double swing =
        -board.rotor_amplitude * board.frequency * board.frequency * std::sin(board.frequency * t);
    sum += weight * -board.rotor_inertia / (board.mass * board.half_length) * swing *
           std::sin(steering(t));
  }
  const Result result =
      run(simulate(board).start(board.running(speed, 0.2)).compose("kahan_li6"), 0.02, until);
  EXPECT_NEAR(result.last.velocity[1], sum * std::cos(steering(until)), 1e-9);
  EXPECT_NEAR(result.last.velocity[0], sum * std::sin(steering(until)) / board.half_length, 1e-9);
  EXPECT_NEAR(result.last.velocity[2], 0, 1e-11);
}

TEST(Snakeboard, AgreesWithItsQuadratureWhateverItsInertia) {
  Snakeboard board;
  board.half_length = 0.3;
  board.mass = 4;
  Start start = board.running(0.3, 0.25);
  start.configuration[5] = -0.1;  // axles that are not opposite; the run makes the velocity fit
  const Result result = run(simulate(board).start(start).compose("kahan_li6"), 0.02, 5);
  EXPECT_LT(result.exact_error_max, 1e-9);
  EXPECT_LT(result.exact_velocity_error_max, 1e-9);
}

TEST(Snakeboard, RunsOnlyByRotorAndSteeringTogether) {
  const auto speed = [](double rotor, double steering) {
    return run(simulate("snakeboard")
                   .set("rotor_amplitude", rotor)
                   .set("steering_amplitude", steering),
               0.02, 40)
        .last.velocity[1];
  };
  EXPECT_GT(speed(0.7, 0.3), 1);
  EXPECT_NEAR(speed(0.7, 0), 0, 1e-9);
  EXPECT_NEAR(speed(0, 0.3), 0, 1e-9);
}

TEST(RollerRacer, KeepsItsEnergyWithoutTorque) {
  const auto drift = [](double h) {
    const Result result = run(simulate("roller_racer").set("torque", 0), h, 10);
    EXPECT_EQ(result.invariants.size(), 1u);
    return result.invariants[0].drift_max / result.invariants[0].start;
  };
  EXPECT_LT(drift(0.005), 1e-4);
  EXPECT_NEAR(std::log2(drift(0.01) / drift(0.005)), 2, 0.1);
}

TEST(RollerRacer, UndulationPropels) {
  const RollerRacer racer;
  const auto end = [&](double torque) {
    return run(simulate("roller_racer").set("torque", torque).start(racer.turning(0, 0)), 0.01, 30)
        .last;
  };
  EXPECT_GT(end(racer.torque).coordinates[1], 3) << "from rest";
  EXPECT_GT(end(racer.torque).velocity[1], 0.1);
  EXPECT_EQ(end(0).coordinates[1], 0);
}

TEST(NTrailer, RunsInSteadyCircles) {
  NTrailer train;
  train.trailers = 4;
  train.lengths = {1, 0.7, 1.2, 0.4};
  for (const double radius : {3.0, -3.0}) {
    double worst[2];
    for (int i = 0; i < 2; ++i) {
      const double h = 0.02 / (1 + i);
      const Result result = run(simulate(train).start(train.circling(radius, 1)), h, 30);
      const auto axles = train.axles(result.last.coordinates);
      double square = radius * radius;
      worst[i] = 0;
      for (size_t k = 0; k < axles.size(); ++k) {
        if (k > 0) square -= train.lengths[k - 1] * train.lengths[k - 1];
        const double own = std::hypot(axles[k][0], axles[k][1] - radius);
        worst[i] = std::max(worst[i], std::abs(own - std::sqrt(square)));
      }
    }
    EXPECT_LT(worst[1], 1e-3) << radius;
    EXPECT_NEAR(std::log2(worst[0] / worst[1]), 2, 0.2) << radius;
  }
}

TEST(NTrailer, KeepsItsEnergyWithAnyNumber) {
  for (const double n : {1.0, 3.0, 12.0, 30.0}) {
    const auto drift = [n](double h) {
      const Result result = run(simulate("n_trailer").set("trailers", n), h, 1);
      EXPECT_LT(result.constraint_max, 1e-11) << n;
      return result.invariants.at(0).drift_max / result.invariants.at(0).start;
    };
    EXPECT_LT(drift(0.01), 1e-4) << n;
    EXPECT_NEAR(std::log2(drift(0.02) / drift(0.01)), 2, 0.1) << n;
  }
}

// The gradient by hand against differences of the metric; the rows against the motion of the axles;
// the energy, which is summed over the bodies, against the metric.
TEST(NTrailer, StatesOneAndTheSameTrain) {
  NTrailer train;
  train.trailers = 5;
  train.lengths = {1, 0.7, 1.2, 0.5, 0.9};
  const auto system = train.mechanics();
  const auto geometry = registry().geometry(train.group(), "exp");
  const std::vector<double> at = {0.3, 1, 2, 0.1, -0.4, 0.7, 1.3, -2};
  const Eigen::VectorXd xi{{0.4, 1.1, -0.3, 0.5, -0.7, 0.2, 0.9, -1.3}};
  Eigen::VectorXd g(geometry->size()), moved(geometry->size()), force(8), b(6);
  Eigen::MatrixXd inertia(8, 8), a(6, 8);
  geometry->from_coordinates(at, g.data());
  const auto shift = [&](const Eigen::VectorXd& eta) {
    geometry->tau(eta.data(), moved.data());
    geometry->compose(g.data(), moved.data(), moved.data());
  };
  constexpr double e = 1e-5;
  system->force(0, g.data(), xi, force);
  for (Eigen::Index i = 0; i < 8; ++i) {
    double energy[2];
    for (const int sign : {0, 1}) {
      shift((sign == 1 ? e : -e) * Eigen::VectorXd::Unit(8, i));
      system->inertia(moved.data(), inertia);
      energy[sign] = 0.5 * xi.dot(inertia * xi);
    }
    EXPECT_NEAR(force[i], (energy[1] - energy[0]) / (2 * e), 1e-8) << i;
  }
  system->constraints(0, g.data(), a, b);
  std::vector<std::array<double, 3>> ends[2];
  for (const int sign : {0, 1}) {
    std::vector<double> q(8);
    shift((sign == 1 ? e : -e) * xi);
    geometry->coordinates(moved.data(), q.data());
    ends[sign] = train.axles(q);
  }
  const auto axles = train.axles(at);
  for (size_t i = 0; i < axles.size(); ++i) {
    const double vx = (ends[1][i][0] - ends[0][i][0]) / (2 * e),
                 vy = (ends[1][i][1] - ends[0][i][1]) / (2 * e), heading = axles[i][2];
    EXPECT_NEAR(-std::sin(heading) * vx + std::cos(heading) * vy,
                a.row(static_cast<Eigen::Index>(i)).dot(xi), 1e-8)
        << i;
  }
  system->inertia(g.data(), inertia);
  const auto compare = [&](const char* /*name*/, const auto& energy) {
    EXPECT_NEAR(energy(at, std::vector<double>(xi.begin(), xi.end())), 0.5 * xi.dot(inertia * xi),
                1e-12);
  };
  train.invariants(compare);
}

TEST(NTrailer, SaysWhatIsWrongWithItsParameters) {
  const auto mistakes = [](const std::string& field, std::vector<double> value) {
    const auto found = simulate("n_trailer").set(field, std::move(value)).mistakes();
    return found.empty() ? std::string() : found[0];
  };
  EXPECT_NE(mistakes("trailers", {2.5}).find("2.5, expected a whole number"), std::string::npos);
  EXPECT_NE(mistakes("trailers", {0}).find("got 0"), std::string::npos);
  EXPECT_NE(mistakes("trailers", {61}).find("from 1 to 60"), std::string::npos);
  EXPECT_NE(mistakes("length", {1, 2}).find("got 2 values, expected 1 or 3"), std::string::npos);
  EXPECT_EQ(mistakes("length", {1, 2, 1}), "");
}

TEST(Segway, FallsAtTheKnownRate) {
  for (const double height : {0.9, 0.4}) {
    Segway segway;
    segway.height = height;
    const double rate = segway.growth_rate(), pitch = 1e-5, until = 6 / rate;
    const Result result =
        run(simulate(segway).start(segway.rolling(pitch, 0, 1, rate * pitch)), until / 1000, until);
    EXPECT_NEAR(std::log(result.last.coordinates[5] / pitch) / until, rate, 1e-4 * rate) << height;
  }
  EXPECT_NEAR(run(simulate("segway").start(Segway{}.rolling(0, 0, 1)), 0.01, 2).last.coordinates[5],
              0, 1e-9);
}

// Without moments and wheels the metric is that of a point: m/2 |d/dt (x, y, z)|^2 of the mass
// centre.
TEST(Segway, MovesItsMassCentre) {
  Segway segway;
  segway.moments.setZero();
  segway.wheel_mass = segway.wheel_inertia = segway.wheel_diameter = 0;
  using G = Segway::Group;
  const auto g = G::from_coordinates(std::vector<double>{0.4, 1, 2, 0, 0, 0.7});
  Vec<6> xi;
  xi << 0.5, 1.2, -0.3, 0, 0, 0.8;
  const auto place = [&](double t) {
    const auto moved = G::compose(g, Exp<G>::tau(Vec<6>(t * xi)));
    const auto& cart = moved.part<0>();
    const auto& pitch = moved.part<3>();
    const Vec<2> p = cart.translation + cart.rotation.rotate(Vec<2>(segway.height * pitch.s, 0));
    return Vec<3>(p[0], p[1], segway.height * pitch.c);
  };
  const Vec<3> velocity = (place(1e-5) - place(-1e-5)) / 2e-5;
  EXPECT_NEAR(xi.dot(segway.inertia(g) * xi), segway.mass * velocity.squaredNorm(), 1e-7);
}

// x = (g s/2 omega^2) sin^2(omega t): down and back, while a free body would slide g s t^2/2.
TEST(KnifeEdge, DoesNotDriftDownhill) {
  const double slide = 9.81 * std::sin(0.3), deepest = slide / 2, turn = 2 * std::numbers::pi;
  double lowest = 0, highest = 0;
  Simulation simulation = simulate("knife_edge_on_incline");
  simulation.set("slope", 0.3).start({.velocity = {1, 0, 0}}).observe([&](const Snapshot& state) {
    lowest = std::max(lowest, state.coordinates[1]);
    highest = std::min(highest, state.coordinates[1]);
    return true;
  });
  run(simulation, turn / 500, 40 * turn);
  EXPECT_NEAR(lowest, deepest, 0.01 * deepest);
  EXPECT_NEAR(highest, 0, 0.01 * deepest);
  const Result result = run(simulation.compose("kahan_li6"), turn / 200, 40 * turn);
  EXPECT_NEAR(result.last.coordinates[1], 0, 1e-4);
  EXPECT_NEAR(result.last.coordinates[2], deepest * 40 * turn, 1e-3);
}

TEST(BallOnTurntable, CirclesAtTwoSeventhsOrTwoFifths) {
  const double mass = 1, radius = 0.5, rate = 1, until = 7;
  for (const auto& [moment, fraction] : {std::pair{2.0 / 5, 2.0 / 7}, {2.0 / 3, 2.0 / 5}}) {
    const Result result = run(simulate("ball_on_turntable")
                                  .set("inertia", moment * mass * radius * radius)
                                  .set("table_rate", rate),
                              0.01, until);
    const std::vector<double>& first = result.config.start.velocity;
    const std::vector<double>& last = result.last.velocity;
    const double turned =
        std::atan2(last[4], last[3]) - std::atan2(first[4], first[3]);  // less than a turn
    EXPECT_NEAR(turned - fraction * rate * until,
                2 * std::numbers::pi *
                    std::round((turned - fraction * rate * until) / (2 * std::numbers::pi)),
                1e-4)
        << fraction;
  }
}

}  // namespace
}  // namespace hamel
