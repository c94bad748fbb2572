// A kernel that goes on at a state near one that it has been at: its steps are those of a restart
// there, whatever the state is. (That they cost less: case disk_nonsmooth of
// tests/benchmarks/instructions.)
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/loop/extrapolation.hpp>
#include <hamel/framework/run/run/driver.hpp>
#include <hamel/hamel.hpp>

namespace {

using namespace hamel;

// A solution that was taken back leaves no trace: the polynomial goes on through the one that came
// in its place.
TEST(Extrapolation, GoesOnBehindOneThatWasTakenBack) {
  using Number = Eigen::Matrix<double, 1, 1>;
  const auto at = [](int k) { return Number(std::pow(k, 3) - 2 * k); };
  for (const int count : {1, 2, 5, 6, 9}) {
    const Number zero = Number::Zero();
    Extrapolation<Number> all(zero);
    EXPECT_TRUE(all.empty());
    for (int k = 0; k < count; ++k) {
      all.push(at(k) + Number(7.0));
      all.take_back();
      EXPECT_FALSE(all.empty());
      Number guess = zero;
      all(guess);
      EXPECT_NEAR(guess[0], at(k)[0] + 7, 1e-10);  // the last one is next to the next
      all.push(at(k));
    }
    Number next = zero;
    all(next);
    if (count >= 4) {
      EXPECT_NEAR(next[0], at(count)[0], 1e-9) << count;
    }
    if (count == 1) {
      EXPECT_EQ(next[0], at(0)[0]);
    }
    if (count == 2) {
      EXPECT_EQ(next[0], 2 * at(1)[0] - at(0)[0]);
    }
  }
}

struct Case {
  std::string system;
  bool compiled;
  double step;
};

class Kernels {
 public:
  explicit Kernels(const Case& which)
      : run_(simulate(which.system).scheme("lift").step(which.step).until(1).build()) {
    const RunPlan& plan = run_.driver().plan();
    setup_ = plan.setup;
    const KernelFactory* of_types = registry().kernel(plan.system->group.name, *setup_.mechanics,
                                                      plan.config.retraction, "lift");
    make_ = which.compiled ? *of_types : registry().scheme("lift")->erased;
  }
  std::unique_ptr<Kernel> operator()() const { return make_(setup_); }

 private:
  hamel::Run run_;
  KernelSetup setup_;
  KernelFactory make_;
};

// A step from (t, g, v) by either way: the same, where a restart leads to one.
void expect_same(Kernel& near, Kernel& anew, Nearby to, const Snapshot& from, double factor) {
  std::vector<double> velocity = from.velocity;
  for (double& v : velocity) v *= factor;
  near.restart_near(to, from.time, from.coordinates, velocity);
  anew.restart(from.time, from.coordinates, velocity, near.next_step());
  const Status one = near.advance(1), other = anew.advance(1);
  if (!other.ok) return;
  EXPECT_TRUE(one.ok) << one.reason << ", times " << factor;
  Snapshot a, b;
  near.node(a);
  anew.node(b);
  for (size_t i = 0; i < a.velocity.size(); ++i)
    EXPECT_NEAR(a.velocity[i], b.velocity[i], 1e-10 * (1 + std::abs(b.velocity[i])))
        << "times " << factor;
}

class RestartNear : public testing::TestWithParam<Case> {};

TEST_P(RestartNear, IsTheStepOfARestart) {
  const Kernels make(GetParam());
  const auto near = make(), anew = make();
  ASSERT_TRUE(near->advance(20).ok);
  Snapshot from;
  double factor = 1;
  for (const Nearby to : {Nearby::node, Nearby::step, Nearby::node, Nearby::step}) {
    if (to == Nearby::node) near->node(from);
    else near->beginning(from);
    factor *= 1.0005;
    expect_same(*near, *anew, to, from, factor);
  }
  // And so are the steps behind it.
  ASSERT_TRUE(near->advance(20).ok);
  ASSERT_TRUE(anew->advance(20).ok);
  Snapshot a, b;
  near->node(a);
  anew->node(b);
  for (size_t i = 0; i < a.velocity.size(); ++i)
    EXPECT_NEAR(a.velocity[i], b.velocity[i], 1e-11 * (1 + std::abs(b.velocity[i])));
}

// Where it is not near at all, in steps so large that there are other roots.
TEST_P(RestartNear, FindsThePrincipalRootAnywhere) {
  Case large = GetParam();
  large.step *= 30;
  const Kernels make(large);
  int taken = 0;
  for (const double factor : {-1.0, 0.01, 0.3, 1.5, -2.5, 3.0, 5.0, 8.0, 20.0}) {
    const auto near = make(), anew = make();
    if (!near->advance(3).ok) continue;
    ++taken;
    Snapshot from;
    near->node(from);
    expect_same(*near, *anew, Nearby::node, from, factor);
    near->beginning(from);
    expect_same(*near, *anew, Nearby::step, from, 1 / factor);
  }
  EXPECT_EQ(taken, 9);
}

INSTANTIATE_TEST_SUITE_P(Systems, RestartNear,
                         testing::Values(Case{"suslov", true, 0.01}, Case{"suslov", false, 0.01},
                                         Case{"falling_disk", true, 0.002},
                                         Case{"falling_disk", false, 0.002}),
                         [](const auto& one) {
                           return one.param.system + (one.param.compiled ? "_compiled" : "_erased");
                         });

}  // namespace
