// lift of mechanisms on recorded programs against lift of the same mechanisms for any problem, step
// by step: of the library, drawn by lot, and on the way through places where a pivot is lost.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <hamel/framework/schemes/lift.hpp>
#include <hamel/systems/kernels.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/mechanisms/multibody.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

// The scheme under another name has the kernel for any problem.
struct LiftOfAnyProblem : Lift {
  static std::string name() { return "lift_of_any_problem"; }
};

class LiftPrograms : public testing::Test {
 protected:
  static void SetUpTestSuite() { add_scheme<LiftOfAnyProblem>(registry()); }

  // Is a mechanism of those that the programs cover?
  static bool is_covered(const SystemModel& model) {
    const auto system = mechanisms::Multibody::of(model.mechanics);
    return system != nullptr && system->lift_layout() != nullptr &&
           system->lift_programs() != nullptr;
  }
  // Both runs: all coordinates and velocities of all rows.
  static void compare(const Simulation& simulation, double bound, const std::string& what) {
    const Result one = Simulation(simulation).scheme("lift").run(),
                 other = Simulation(simulation).scheme("lift_of_any_problem").run();
    ASSERT_EQ(one.status.ok, other.status.ok)
        << what << ": " << one.status.reason << " and " << other.status.reason;
    EXPECT_EQ(one.status.reason, other.status.reason) << what;
    ASSERT_EQ(one.trajectory.rows(), other.trajectory.rows()) << what;
    const size_t columns = one.last.coordinates.size() + one.last.velocity.size();
    for (size_t row = 0; row < one.trajectory.rows(); ++row) {
      for (size_t j = 1; j <= columns; ++j) {
        const double a = one.trajectory.at(row, j), b = other.trajectory.at(row, j);
        ASSERT_NEAR(a, b, bound * (1 + std::abs(b))) << what << ", row " << row << ", column " << j;
      }
    }
  }
};

TEST_F(LiftPrograms, AgreeOnTheLibrary) {
  for (const std::string& name : registry().deferred_systems()) {
    const SystemModel model = registry().system(name)->make({});
    EXPECT_TRUE(model.mechanics->left_invariant() || is_covered(model)) << name;
    compare(simulate(name).step(0.002).until(0.4), name == "unicycle_rider" ? 1e-9 : 1e-10, name);
  }
}

TEST_F(LiftPrograms, AgreeInCompositionsAndBackwards) {
  for (const std::string name : {"bicycle", "car", "kick_scooter"}) {
    compare(simulate(name).compose("yoshida4").step(0.01).until(0.4), 1e-10, name);
    compare(simulate(name).from(0.3).step(-0.005).until(0), 1e-10, name + " backwards");
  }
}

TEST_F(LiftPrograms, AgreeWithInputs) {
  compare(simulate("car").input("steer.torque", 0.5).step(0.005).until(1), 1e-10, "constant");
  compare(simulate("car")
              .input("steer.torque", InputTable{{0, 0.3, 0.7}, {0, 4, -4}, false})
              .step(0.005)
              .until(0.7),
          1e-10, "lines");
  compare(simulate("car")
              .input("steer.torque", InputTable{{0, 0.3, 0.7}, {0, 4, -4}, true})
              .step(0.005)
              .until(0.7),
          1e-10, "held");
}

// A step that fails does so for the same reason, in the same place.
TEST_F(LiftPrograms, FailAlike) {
  compare(simulate("bicycle").step(0.5).until(20), 1e-8, "bicycle");
  compare(simulate("ballbot").step(0.2).until(20), 1e-8, "ballbot");
}

// Trees of bodies by lot: any root, joints of all kinds with springs and dampers.
class ByLot {
 public:
  explicit ByLot(unsigned seed) : random_(seed) {}

  Mechanism tree(const std::string& root) {
    Mechanism m("tree");
    body(m, "b0", {0, 0, 1});
    const Point at = {part(), part(), 1 + part()};
    if (root == "hinge" || root == "slider") m.joint(root, "root", kWorld, "b0", options(at));
    else if (root == "planar") m.planar("root", "b0", {.at = at});
    else m.joint(root, "root", kWorld, "b0", {.at = at});
    const int count = 1 + static_cast<int>(random_() % 3);
    for (int i = 1; i <= count; ++i) {
      const std::string name = "b" + std::to_string(i), joint = "j" + std::to_string(i);
      const std::string parent = "b" + std::to_string(random_() % static_cast<unsigned>(i));
      body(m, name, {part(), part(), 1 + part()});
      const char* kinds[] = {"hinge", "slider", "ball", "universal", "hinge"};
      const std::string kind = kinds[random_() % 5];
      JointOptions o = options({part(), part(), 1 + part()});
      if (kind == "ball" || kind == "universal") o.stiffness = o.rest = o.damping = 0;
      if (kind == "universal") o.axis = {1, 0, 0}, o.axis2 = {0, 1, 0};
      m.joint(kind, joint, parent, name, o);
      if (kind == "hinge" || kind == "slider") m.start(joint + ".rate", 2 * part());
      if (kind == "ball") m.start(joint + ".w1", 2 * part());
    }
    if (count > 1)
      m.spring(
          "line", "b0", "b" + std::to_string(count),
          {.from = {part(), part(), 1}, .to = {part(), part(), 1}, .stiffness = 20, .damping = 2});
    return m;
  }
  // A train of carts: wheels that roll, blades, hitches.
  Mechanism train() {
    Mechanism m("train");
    const int count = 1 + static_cast<int>(random_() % 3);
    for (int i = 0; i <= count; ++i) {
      const std::string name = "c" + std::to_string(i);
      const double x = -static_cast<double>(i);
      body(m, name, {x + 0.2 * part(), 0.2 * part(), 0.3});
      if (i == 0) m.planar("road", name);
      else
        m.hinge("h" + std::to_string(i), "c" + std::to_string(i - 1), name,
                {.at = {x + 0.5, 0.1 * part(), 0.3},
                 .stiffness = random_() % 2 ? 3.0 : 0.0,
                 .damping = random_() % 2 ? 0.5 : 0.0});
      if (random_() % 2) {
        m.blade("blade " + name, name, {.at = {x, 0.1 * part(), 0}});
      } else {
        const std::string wheel = "w" + std::to_string(i);
        m.body(wheel, {.mass = 1, .at = {x, 0, 0.1}, .cylinder = {0.1, 0.05}, .axis = {0, 1, 0}});
        m.hinge(wheel, name, wheel, {.at = {x, 0, 0.1}, .axis = {0, 1, 0}});
        m.wheel(wheel, wheel, {.at = {x, 0, 0.1}, .radius = 0.1});
      }
      if (i > 0) m.start("h" + std::to_string(i) + ".angle", part());
    }
    m.start("speed", 1 + part());
    return m;
  }

 private:
  double part() { return std::uniform_real_distribution(-0.5, 0.5)(random_); }
  JointOptions options(const Point& at) {
    return {.at = at,
            .axis = {part(), part(), 1},
            .stiffness = random_() % 2 ? 5.0 : 0.0,
            .rest = part(),
            .damping = random_() % 2 ? 0.3 : 0.0};
  }
  void body(Mechanism& m, const std::string& name, const Point& at) {
    m.body(name, {.mass = 1 + part(), .at = at, .box = {0.6 + part(), 0.3, 0.2}});
  }
  std::mt19937 random_;
};

TEST_F(LiftPrograms, AgreeOnTreesByLot) {
  for (const std::string root : {"free", "planar", "hinge", "slider", "ball"})
    for (unsigned seed = 1; seed <= 50; ++seed) {
      const Mechanism m = ByLot(seed).tree(root);
      const std::string name = root + " " + std::to_string(seed);
      EXPECT_TRUE(is_covered(m.model())) << name;
      compare(simulate(m).step(0.005).until(0.2), 1e-10, name);
    }
}

TEST_F(LiftPrograms, AgreeOnTrainsByLot) {
  for (unsigned seed = 1; seed <= 120; ++seed) {
    const Mechanism m = ByLot(seed).train();
    EXPECT_TRUE(is_covered(m.model())) << seed;
    compare(simulate(m).step(0.005).until(0.2), 1e-10, "train " + std::to_string(seed));
  }
}

// An arm with a blade spins on a sliding body: whatever velocity the blade's row is solved for, it
// drops out twice a turn.
TEST_F(LiftPrograms, AgreeWherePivotsAreLost) {
  Mechanism m("spinning blade");
  m.body("body", {.mass = 4, .at = {0, 0, 0.1}, .box = {0.5, 0.5, 0.2}});
  m.body("arm", {.mass = 1, .at = {0, 0, 0.1}, .box = {0.4, 0.1, 0.1}});
  m.planar("ice", "body");
  m.hinge("spin", "body", "arm", {.at = {0, 0, 0.1}});
  m.blade("blade", "arm", {.at = {0, 0, 0}});
  m.start({{"spin.rate", 6}, {"speed", 1}, {"omega", 0.3}});
  compare(simulate(m).step(0.005).until(5), 1e-10, "spinning blade");
  // Another pivot than as drawn, from the start on.
  m.start({{"spin.angle", std::numbers::pi / 2}, {"spin.rate", 6}, {"v2", 1}, {"omega", 0.3}});
  compare(simulate(m).step(0.005).until(1), 1e-10, "blade across");
  Mechanism driven("driven blade");
  driven.body("body", {.mass = 4, .at = {0, 0, 0.1}, .box = {0.5, 0.5, 0.2}});
  driven.body("arm", {.mass = 1, .at = {0, 0, 0.1}, .box = {0.4, 0.1, 0.1}});
  driven.planar("ice", "body");
  driven.hinge("spin", "body", "arm", {.at = {0, 0, 0.1}});
  driven.blade("blade", "arm", {.at = {0, 0, 0}});
  driven.prescribe("spin", 2 * std::numbers::pi);
  driven.start({{"speed", 1}, {"omega", 0.3}});
  EXPECT_TRUE(is_covered(driven.model()));
  // Nodes, and with the other step middles, at quarters of a turn.
  for (const double h : {0.005, 0.5 / 75})
    compare(simulate(driven).step(h).until(2), 1e-10, "driven blade");
}

}  // namespace
}  // namespace hamel
