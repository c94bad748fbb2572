// Path lengths of sensors and columns by formulas: in runs, files, events, sections, ensembles.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <hamel/hamel.hpp>

#include "../framework/run/refusal.hpp"

namespace hamel {
namespace {

using testing::HasSubstr;

// An arm of length l that a motor turns.
constexpr const char* kArm = R"toml(
name = "arm"
body = [{ name = "arm", mass = 2, at = [0.3, 0, 0.5], inertia = [1, 1, 1] }]
joint = [{ name = "turn", kind = "hinge", child = "arm", at = [0, 0, 0.5] }]
motor = [{ joint = "turn", effort = "drive*(1.2 + sin(3*t))" }]
sensor = [{ name = "tip", body = "arm", at = [0.8, 0, 0.5] }]
gravity = 0
[parameters]
drive = 0.9
[start]
turn.rate = 0.4
[outputs]
half = "speed/2"
speed = { value = "sqrt(tip.vx^2 + tip.vy^2)", unit = "m/s", meaning = "of the tip" }
start_energy = "energy - work"
pull = "2*(tip.ax*cos(turn.angle) + tip.ay*sin(turn.angle))"
way = "tip.path/drive"
)toml";

class File {
 public:
  explicit File(const std::string& text, const std::string& name = "outputs_arm.toml")
      : path_(std::filesystem::temp_directory_path() / name) {
    std::ofstream(path_) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::vector<double> column(const Result& run, const std::string& name) {
  return run.trajectory.column(name);
}

// Of constant speed l w; of the speed l a w |cos w t|, up to where it is 0.
TEST(Paths, AreThoseOfClosedForms) {
  const double l = 0.8, rate = 1.7, until = 2;
  Mechanism m("arm");
  m.body("arm", {.mass = 2, .at = {0.3, 0, 0.5}, .inertia = {1, 1, 1}});
  m.hinge("turn", kWorld, "arm", {});
  m.sensor("tip", "arm", {l, 0, 0.5});
  Mechanism steady = m;
  steady.start("turn.rate", rate);
  m.prescribe(
      "turn", [](double t) { return 0.5 * 2 * std::cos(2 * t); },
      [](double t) { return 0.5 * std::sin(2 * t); });
  for (const char* scheme : {"lift", "dop853"}) {
    SCOPED_TRACE(scheme);
    const Result turning = simulate(steady).scheme(scheme).step(0.01).until(until).run();
    ASSERT_TRUE(turning.status.ok) << turning.status.reason;
    for (size_t i = 0; i < turning.trajectory.rows(); ++i)
      EXPECT_NEAR(column(turning, "tip.path")[i], l * rate * column(turning, "t")[i], 1e-11);
    const Result swinging = simulate(m).scheme(scheme).step(0.01).until(0.7).run();
    ASSERT_TRUE(swinging.status.ok) << swinging.status.reason;
    EXPECT_NEAR(column(swinging, "tip.path").back(), l * 0.5 * std::sin(1.4), 1e-9);
  }
  const Result back = simulate(steady).until(-1).run();
  EXPECT_NEAR(column(back, "tip.path").back(), l * rate, 1e-11);
}

TEST(Outputs, AreFormulasOfColumns) {
  const File file(kArm);
  for (const char* scheme : {"lift", "dop853"}) {
    SCOPED_TRACE(scheme);
    const Result run = simulate(file.path()).scheme(scheme).step(0.01).until(2).run();
    ASSERT_TRUE(run.status.ok) << run.status.reason;
    const double start = column(run, "energy").front();
    for (size_t i = 0; i < run.trajectory.rows(); ++i) {
      const double rate = column(run, "turn.rate")[i], speed = column(run, "speed")[i];
      EXPECT_NEAR(speed, 0.8 * std::abs(rate), 1e-13);
      EXPECT_EQ(column(run, "half")[i], speed / 2);
      EXPECT_NEAR(column(run, "start_energy")[i], start, 1e-4);
      EXPECT_EQ(column(run, "start_energy")[i], column(run, "energy")[i] - column(run, "work")[i]);
      EXPECT_NEAR(column(run, "pull")[i], -2 * 0.8 * rate * rate, 1e-12);
      EXPECT_EQ(column(run, "way")[i], column(run, "tip.path")[i] / 0.9);
    }
  }
}

TEST(Outputs, AreThoseOfABuilderToo) {
  Mechanism m("arm");
  m.body("arm", {.mass = 2, .at = {0.3, 0, 0.5}, .inertia = {1, 1, 1}});
  m.hinge("turn", kWorld, "arm", {});
  m.sensor("tip", "arm", {0.8, 0, 0.5});
  m.output("twice", "2*tip.x", {.unit = "m"});
  m.start("turn.rate", 1);
  const Result run = simulate(m).until(1).run();
  EXPECT_EQ(column(run, "twice").back(), 2 * column(run, "tip.x").back());
  m.output("tip.x", "1");
  m.output("other", "tip.k");
  EXPECT_THAT(refusal([&] { m.model(); }), HasSubstr("outputs.tip.x"));
}

TEST(Outputs, AreOfSystemsByData) {
  const File file(R"toml(
name = "particle"
group = "r2"
inertia = [[2, 0], [0, 2]]
velocity = [1, 0.5]
[parameters]
k = 3
[outputs]
way = "sqrt(x1^2 + x2^2)*k"
[events]
far = "way - 6"
)toml",
                  "outputs_particle.toml");
  const Result run = simulate(file.path()).events({"far"}).until(3).run();
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  EXPECT_NEAR(column(run, "way").back(), 9 * std::sqrt(1.25), 1e-12);
  ASSERT_EQ(run.events.size(), 1u);
  EXPECT_NEAR(run.events[0].time, 2 / std::sqrt(1.25), 1e-10);
}

TEST(Outputs, OccurInEventsAndSections) {
  const File file(std::string(kArm) + "[events]\nacross = \"tip.y\"\n");
  const Result run =
      simulate(file.path()).events({"across", "half = 0.5", "tip.vx < -0.3"}).until(6).run();
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  bool half = false, back = false;
  for (const EventMet& event : run.events) {
    const double angle = event.coordinates[0], rate = event.velocity[0];
    if (event.name == "across") {
      EXPECT_NEAR(std::sin(angle), 0, 1e-9);
    } else if (event.name == "half = 0.5") {
      EXPECT_NEAR(0.4 * rate, 0.5, 1e-9);
      half = true;
    } else {
      EXPECT_NEAR(-0.8 * rate * std::sin(angle), -0.3, 1e-9);
      back = true;
    }
  }
  EXPECT_TRUE(half && back);
  const Section section =
      hamel::section(simulate(file.path()), {.event = "across", .direction = 1, .count = 3});
  const auto& of = [&](const char* name) {
    return std::get<std::vector<double>>(section.points.column(name).values);
  };
  for (size_t i = 0; i < section.points.rows(); ++i) {
    EXPECT_NEAR(of("speed")[i], 0.8 * of("turn.rate")[i], 1e-12);
    EXPECT_NEAR(of("tip.x")[i], 0.8, 1e-9);
  }
}

TEST(Outputs, AreKeptByEnsembles) {
  const File file(kArm);
  EnsembleConfig config;
  config.run.system = file.path();
  config.run.until = 1.5;
  config.members = 2;
  config.vary = {{"start.turn.rate", Variation::Law::values, {0.4, 0.7}}};
  for (const char* name : {"speed", "half", "way", "pull", "tip.path", "tip.ax", "start_energy"})
    config.keep.push_back({"", std::string("end.") + name});
  const Ensemble ensemble(registry(), config);
  for (long k = 0; k < 2; ++k) {
    const Member member = ensemble.member(k);
    const Result run = simulate(file.path()).config(member.config).run();
    for (const auto& [name, value] : member.kept)
      EXPECT_NEAR(value, column(run, name.substr(4)).back(), 1e-10) << name;
  }
}

TEST(Outputs, MistakesAreNamed) {
  const auto refused = [](const std::string& outputs) {
    std::string text = kArm;
    text += outputs;
    const File file(text, "outputs_wrong.toml");
    return refusal([&] { simulate(file.path()).run(); });
  };
  EXPECT_THAT(refused("x1 = \"tip.vv\""),
              testing::AllOf(HasSubstr("outputs.x1"), HasSubstr("did you mean 'tip.v")));
  EXPECT_THAT(refused("drive = \"tip.x\""), HasSubstr("expected a name that nothing else has"));
  EXPECT_THAT(refused("a = \"b\"\nb = \"a\""), HasSubstr("outputs.a"));
  EXPECT_THAT(refused("a = [1]"), HasSubstr("outputs.a: expected a formula"));
  EXPECT_THAT(refused("[events]\nlate = \"pull - 1\""),
              HasSubstr("the output 'pull' depends on columns that are no function"));
}

}  // namespace
}  // namespace hamel
