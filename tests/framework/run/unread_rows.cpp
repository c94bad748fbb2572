// Rows that nobody reads are states alone; read, they are those of a run that measured each.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <hamel/hamel.hpp>
#include <hamel/systems/by_text.hpp>

namespace hamel {
namespace {

long looked = 0;

struct CountedSuslov : Suslov {
  static std::string name() { return "counted_suslov"; }
  void invariants(auto& add) const {
    add("looked at", [](const auto&, const Vec<3>& xi) {
      ++looked;
      return xi[0];
    });
  }
};

TEST(UnreadRows, MeasureNothing) {
  const Simulation simulation = simulate(CountedSuslov{}).scheme("lift").step(0.01).until(2);
  looked = 0;
  Result result = simulation.run_unread();
  ASSERT_TRUE(result);
  EXPECT_LE(looked, 1);  // where it starts
  EXPECT_EQ(result.trajectory.rows(), 0u);
  EXPECT_EQ(result.steps, 200);
  EXPECT_NEAR(result.last.time, 2, 1e-12);
  result.read();
  EXPECT_GE(looked, 200);
  EXPECT_EQ(result.trajectory.rows(), 201u);
  const long before = looked;
  result.read();
  EXPECT_EQ(looked, before);  // once
}

// The same numbers, bit for bit: an observer has each state measured as it comes.
TEST(UnreadRows, AreThoseOfARunThatIsObserved) {
  const Simulation simulations[] = {
      simulate("suslov").scheme("lift").step(0.01).until(2),
      simulate("suslov").compose("kahan_li6").scheme("lift").step(0.05).until(2).every(7),
      simulate("suslov").until(5),
      simulate("suslov").scheme("dop853").tolerance({1e-9}).until(5),
      simulate("bicycle").scheme("lift").step(0.01).output(0.013).until(0.5),
      simulate("falling_disk").scheme("rkmk4").step(0.01).until(1),
      simulate("rattleback").scheme("balance").retraction("exp").step(0.01).until(1),
      simulate("bicycle").until(0.5),
      simulate("bicycle").scheme("lift").step(0.01).until(0.5),
      simulate("n_trailer").scheme("lift").step(0.01).until(1).keep_rows(30),
      simulate("chaplygin_sleigh").scheme("unadapted").step(0.3).until(300)};
  for (Simulation simulation : simulations) {
    SCOPED_TRACE(simulation.config().system + " " + simulation.config().scheme);
    const Result late = simulation.run();
    const Result at_once = simulation.observe([](const Snapshot&) { return true; }).run();
    EXPECT_EQ(late.status.ok, at_once.status.ok);
    EXPECT_EQ(late.status.reason, at_once.status.reason);
    EXPECT_EQ(late.steps, at_once.steps);
    EXPECT_EQ(late.notes, at_once.notes);
    EXPECT_EQ(late.trajectory.columns(), at_once.trajectory.columns());
    EXPECT_EQ(late.trajectory.stride(), at_once.trajectory.stride());
    EXPECT_GT(late.trajectory.rows(), 2u);
    EXPECT_TRUE(std::ranges::equal(late.trajectory.values(), at_once.trajectory.values()));
    Measurements::fields([&](const Quantity& quantity, const char*, auto member) {
      const double x = late.*member, y = at_once.*member;
      EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << quantity.name;
    });
    ASSERT_EQ(late.invariants.size(), at_once.invariants.size());
    for (std::size_t i = 0; i < late.invariants.size(); ++i)
      EXPECT_EQ(late.invariants[i].drift_max, at_once.invariants[i].drift_max);
  }
}

// The derivative of ln(x) is finite where it is none itself.
TEST(UnreadRows, EndAtAPotentialThatIsNoNumber) {
  const char text[] = R"toml(name = "logarithm"
group = "r2"
coordinates = ["x", "y"]
inertia = [1, 1]
potential = "ln(x)"
configuration = [0.5, 0]
velocity = [-1, 0]
)toml";
  Simulation simulation = simulate_text(text, "logarithm");
  simulation.scheme("rkmk4").step(0.1).until(2);
  const Result late = simulation.run_unread();
  EXPECT_FALSE(late.status.ok);
  const Result at_once = simulation.observe([](const Snapshot&) { return true; }).run();
  EXPECT_FALSE(at_once.status.ok);
  EXPECT_EQ(late.status.reason, at_once.status.reason);
  EXPECT_EQ(late.status.time, at_once.status.time);
  EXPECT_EQ(late.last.time, at_once.last.time);
  EXPECT_GT(late.last.time, 0);
}

// Of long runs that keep few rows, states do not pile up.
TEST(UnreadRows, AreBounded) {
  Simulation simulation = simulate("suslov").scheme("lift").step(0.001).until(250).keep_rows(50);
  const Result late = simulation.run();
  const Result at_once = simulation.observe([](const Snapshot&) { return true; }).run();
  EXPECT_GT(late.steps * 20, 1 << 22);
  EXPECT_LE(late.trajectory.rows(), 51u);
  EXPECT_EQ(late.trajectory.stride(), at_once.trajectory.stride());
  EXPECT_TRUE(std::ranges::equal(late.trajectory.values(), at_once.trajectory.values()));
  EXPECT_EQ(late.energy_error_max, at_once.energy_error_max);
  EXPECT_EQ(late.last.energy, at_once.last.energy);
}

TEST(UnreadRows, OutliveTheirSimulation) {
  std::optional<Simulation> simulation = simulate("bicycle").until(0.2);
  Result result = simulation->run_unread();
  simulation.reset();
  Result other = result;
  const double error = result.read().energy_error_max;
  EXPECT_LT(error, 1e-6);
  EXPECT_EQ(other.read().energy_error_max, error);
  EXPECT_TRUE(std::ranges::equal(other.trajectory.values(), result.trajectory.values()));
}

}  // namespace
}  // namespace hamel
