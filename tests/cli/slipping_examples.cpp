// Examples that slide and strike (tests/examples), each against an exact fact of its motion.
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;

constexpr double kGravity = 9.81;
using Words = std::vector<std::string>;

std::vector<double> numbers(const json& from) { return from.get<std::vector<double>>(); }

class SlippingExamples : public CommandLine {
 protected:
  json run_of(const std::string& name, const Words& more) {
    Words words = {write(name, source_file("tests/examples/" + name))};
    words.insert(words.end(), more.begin(), more.end());
    return record(words);
  }
};

// w -> c w at a strike, c = (J + m l^2 cos 2a)/(J + m l^2), by the angular momentum about the tip
// that strikes; between two of them the energy: w'^2 = c^2 w^2 + 4 m g l sin a sin(slope)/(J + m
// l^2).
TEST_F(SlippingExamples, ARimlessWheelWalks) {
  const double l = 0.5, slope = 0.08, a = std::numbers::pi / 8;
  for (const double inertia : {0.02, 0.05}) {
    const json out = run_of("rimless_wheel.toml", {"--until", "24", "--rtol", "1e-11", "--set",
                                                   "inertia=" + std::to_string(inertia)});
    ASSERT_TRUE(out["status"] == "ok") << out["reason"].dump();
    const double about = inertia + l * l;
    const double c = (inertia + l * l * std::cos(2 * a)) / about;
    const double gain = 4 * kGravity * l * std::sin(a) * std::sin(slope) / about;
    double before = 0;
    int strikes = 0;
    for (const json& event : out["events"]) {
      const std::string name = event["name"].get<std::string>();
      if (name.find(".strikes") == std::string::npos) continue;
      const double w = event["velocity"][2].get<double>();
      EXPECT_NEAR(event["velocity_after"][2].get<double>(), c * w, 1e-9);
      if (strikes++ > 0) {
        EXPECT_NEAR(w * w, c * c * before * before + gain, 1e-8);
      }
      before = w;
    }
    EXPECT_GT(strikes, 25);
    EXPECT_NEAR(before, std::sqrt(gain / (1 - c * c)), 1e-7);
  }
}

// In steps of one size the box comes to rest on a face: four corners at once, which no order of
// impacts decides. No corner is ever below the ground.
TEST_F(SlippingExamples, ABoxFallsAndRests) {
  const json out = run_of("thrown_box.toml",
                          {"--slip", "--scheme", "nonsmooth", "--step", "0.004", "--until", "2.4"});
  ASSERT_TRUE(out["status"] == "ok") << out["reason"].dump();
  const auto lowest = [](const std::vector<double>& g) {
    double least = 1;
    for (const double x : {-0.15, 0.15})
      for (const double y : {-0.1, 0.1})
        for (const double z : {-0.05, 0.05})
          least = std::min(least, g[6] * x + g[7] * y + g[8] * z + g[11]);
    return least;
  };
  EXPECT_GT(out["events"].size(), 10U);
  for (const json& event : out["events"])
    EXPECT_GE(lowest(numbers(event["configuration"])), -1e-14) << event["name"];
  EXPECT_NEAR(lowest(numbers(out["final"]["configuration"])), 0, 1e-14);
  for (const double v : numbers(out["final"]["velocity"])) EXPECT_NEAR(v, 0, 1e-9);
}

// A robot that drives and turns until its wheels roll, each once: the last slip, which the end of
// the one before leaves at a ten-millionth of the speed, ends there too, and does not go through 0
// with friction on its wrong side.
TEST_F(SlippingExamples, FourWheelsComeToRoll) {
  const json out =
      record({write("skid_steered.urdf", source_file("tests/examples/skid_steered.urdf")) +
                  "?wheel=auto,friction=0.6",
              "--start", "v1=1,omega=1", "--slip", "--until", "2"});
  ASSERT_TRUE(out["status"] == "ok") << out["reason"].dump();
  ASSERT_EQ(out["events"].size(), 4U);
  for (const json& event : out["events"])
    EXPECT_TRUE(event["name"].get<std::string>().ends_with("_wheel.rolls")) << event["name"];
}

// Across the edge v2' = -mu g, along it nothing acts.
TEST_F(SlippingExamples, ASkateSlipsSideways) {
  const json out = run_of("skate_that_slips.toml", {"--slip", "--until", "2", "--rtol", "1e-10"});
  ASSERT_EQ(out["events"].size(), 1U);
  EXPECT_EQ(out["events"][0]["name"], "edge.rolls");
  const double holds = 1 / (0.1 * kGravity);
  EXPECT_NEAR(out["events"][0]["time"].get<double>(), holds, 1e-11);
  const auto end = numbers(out["final"]["configuration"]);
  EXPECT_NEAR(end[1], 1.5 * 2, 1e-10);    // x
  EXPECT_NEAR(end[2], holds / 2, 1e-10);  // y
}

// Above sqrt(mu g w) locked rear wheels turn the car round until it rests. Wheels that roll, as
// blades, keep it straight and its speed: they slip until their friction has stopped its turning,
// within a first step that is longer.
TEST_F(SlippingExamples, ACarBrakesAndSkids) {
  const json locked = run_of("braked_car.toml", {"--slip", "--until", "5"});
  EXPECT_GT(std::abs(numbers(locked["final"]["configuration"])[0]), 1.5);
  EXPECT_LT(std::abs(numbers(locked["final"]["velocity"])[1]), 1e-9);
  const json rolls = run_of("rolling_car.toml", {"--slip", "--until", "5", "--rtol", "1e-10"});
  ASSERT_EQ(rolls["events"].size(), 2U);
  EXPECT_EQ(rolls["events"][0]["name"], "rear left.rolls");
  // N w = m g a, and J' omega' = m a V omega - mu N w: omega = W + (omega_0 - W) exp(k t), k = m a
  // V/J'.
  const double a = 1.1, about = 1200 * ((3.8 * 3.8 + 1.6 * 1.6) / 12 + a * a);
  const double k = 1200 * a * 12 / about, settles = 0.7 * 1200 * kGravity * a / (k * about);
  EXPECT_NEAR(rolls["events"][0]["time"].get<double>(), -std::log(1 - 0.01 / settles) / k, 1e-7);
  EXPECT_NEAR(numbers(rolls["final"]["velocity"])[1], 12, 1e-4);
  EXPECT_LT(rolls["diagnostics"]["energy_error_max"].get<double>(), 1e-9);
}

// Strikes of the beak as Moreau's time stepping of Lagrange's equations of sleeve and bird has
// them, in steps of 1e-5 s, of order 1; then once a period, over which gravity gives what strikes
// and friction take.
TEST_F(SlippingExamples, AWoodpeckerHopsDownItsPole) {
  const json out = run_of("woodpecker_toy.toml", {"--slip", "--until", "2", "--rtol", "1e-9"});
  ASSERT_TRUE(out["status"] == "ok") << out["reason"].dump();
  std::vector<double> times, places;
  for (const json& event : out["events"]) {
    if (event["name"] != "beak.strikes") continue;
    times.push_back(event["time"].get<double>());
    places.push_back(numbers(event["configuration"])[0]);
  }
  ASSERT_GE(times.size(), 15U);
  const std::array<double, 4> stepped = {0.0827, 0.2126, 0.3435, 0.4742};
  for (size_t i = 0; i < stepped.size(); ++i) EXPECT_NEAR(times[i], stepped[i], 3e-4) << i;
  const size_t n = times.size();
  EXPECT_NEAR(times[n - 1] - times[n - 2], times[n - 2] - times[n - 3], 1e-4);
  EXPECT_NEAR(places[n - 1] - places[n - 2], places[n - 2] - places[n - 3], 1e-4);
  EXPECT_LT(out["diagnostics"]["energy_error_max"].get<double>(), 1e-8);
}

// Flat to the angle a a coin runs round at W = sqrt(4 g/(R sin a)) while its centre rests: after
// the time t it is turned by W t about the vertical and by -W cos(a) t about its axis.
TEST_F(SlippingExamples, ACoinRunsRoundOnItsRim) {
  const Words file = {"--config",
                      write("spun_coin.toml", source_file("tests/examples/spun_coin.toml"))};
  const json out = record(file);
  ASSERT_TRUE(out["status"] == "ok");
  EXPECT_TRUE(out["events"].empty());
  const double a = 0.4, rate = std::sqrt(4 * kGravity / (0.012 * std::sin(a)));
  using Eigen::AngleAxisd, Eigen::Vector3d;
  const Eigen::Matrix3d turned =
      (AngleAxisd(rate, Vector3d::UnitZ()) * AngleAxisd(a, Vector3d::UnitX()) *
       AngleAxisd(-rate * std::cos(a), Vector3d::UnitZ()))
          .toRotationMatrix();
  const auto end = numbers(out["final"]["configuration"]);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(end[static_cast<size_t>(3 * i + j)], turned(i, j), 1e-7) << i << j;
  for (const size_t i : {9U, 10U}) EXPECT_NEAR(end[i], 0, 1e-10);
  EXPECT_NEAR(end[11], 0.012 * std::sin(a), 1e-12);
}

// At each strike of a corner, r from the mass centre: its rate along the normal is turned round by
// e, the impulse is in the cone of friction, turns the box by I w' = I w + r x P, and where it is
// on the rim it is against the slip that it leaves; in between the centre flies on a parabola.
TEST_F(SlippingExamples, AThrownBoxStrikesWithItsCorners) {
  const json out = run_of("thrown_box.toml", {"--slip", "--until", "0.6", "--rtol", "1e-11"});
  ASSERT_TRUE(out["status"] == "ok") << out["reason"].dump();
  using Eigen::Vector3d;
  const Vector3d inertia = Vector3d(0.05, 0.1, 0.13) / 12;
  const Eigen::Vector3d half(0.15, 0.1, 0.05);
  double last = 0;
  Vector3d velocity(2, 0, 0), place(0, 0, 0.5);
  int strikes = 0;
  for (const json& event : out["events"]) {
    const std::string name = event["name"].get<std::string>();
    if (name.find(".strikes") == std::string::npos) continue;
    ++strikes;
    const auto g = numbers(event["configuration"]);
    const auto before = numbers(event["velocity"]), after = numbers(event["velocity_after"]);
    const Eigen::Matrix3d turn =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(g.data());
    const Vector3d w(before.data()), v(before.data() + 3), w_after(after.data()),
        v_after(after.data() + 3);
    const double t = event["time"].get<double>(), flown = t - last;
    const Vector3d gravity(0, 0, -kGravity);
    EXPECT_LT((turn * v - velocity - gravity * flown).norm(), 1e-9) << name;
    const Vector3d at(g.data() + 9);
    EXPECT_LT((at - place - velocity * flown - gravity * (flown * flown / 2)).norm(), 1e-9) << name;
    const int corner = name[7] - '1';
    const Vector3d r(corner % 2 == 0 ? half[0] : -half[0], corner / 2 % 2 == 0 ? half[1] : -half[1],
                     corner / 4 == 0 ? -half[2] : half[2]);
    EXPECT_NEAR((at + turn * r)[2], 0, 1e-9);
    const Vector3d approach = turn * (v + w.cross(r)), leaves = turn * (v_after + w_after.cross(r));
    EXPECT_NEAR(leaves[2], -0.5 * approach[2], 1e-9) << name;
    const Vector3d impulse = v_after - v, world = turn * impulse;
    EXPECT_LT((inertia.cwiseProduct(w_after - w) - r.cross(impulse)).norm(), 1e-10) << name;
    const double across = world.head<2>().norm(), slip = leaves.head<2>().norm();
    EXPECT_LE(across, 0.4 * world[2] + 1e-9) << name;
    if (slip > 1e-9) {
      EXPECT_NEAR(across, 0.4 * world[2], 1e-9) << name;
      EXPECT_NEAR(leaves.head<2>().dot(world.head<2>()), -slip * across, 1e-9) << name;
    }
    last = t;
    place = at;
    velocity = turn * v_after;
  }
  EXPECT_GE(strikes, 3);
}

}  // namespace
