// Steps of lift and balance chosen by the reversible control: they come back, and their error
// follows the tolerance.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>
#include <hamel/hamel.hpp>

namespace hamel {
namespace {

Simulation suslov() { return simulate("suslov_in_potential"); }

// Forwards, and back by the same steps: to the start, but for round-off, which a motion that is not
// chaotic leaves small.
TEST(ReversibleControl, ReturnsToItsStart) {
  for (const std::string system : {"falling_disk", "contact_oscillator"}) {
    for (const std::string scheme : {"lift", "balance"}) {
      hamel::Run run =
          simulate(system).scheme(scheme).step(0.01).tolerance({.relative = 1e-5}).build();
      const Snapshot start = run.state();
      ASSERT_TRUE(run.step(10000));
      const Snapshot there = run.state();
      EXPECT_GT(euclidean_distance(start.coordinates, there.coordinates), 0.1);
      run.turn_back();
      ASSERT_TRUE(run.step(10000));
      const Snapshot back = run.state();
      EXPECT_NEAR(back.time, start.time, 1e-10);
      EXPECT_LT(euclidean_distance(start.coordinates, back.coordinates), 1e-10) << scheme;
      EXPECT_LT(euclidean_distance(start.velocity, back.velocity), 1e-10) << scheme;
    }
  }
}

// How far a run ends from its start when it is taken back after so many steps.
struct Return {
  double time = 0, error = 0;
};
Return return_of(const Simulation& simulation, long steps) {
  hamel::Run run = simulation.build();
  const Snapshot start = run.state();
  EXPECT_TRUE(run.step(steps));
  const double time = run.state().time;
  run.turn_back();
  EXPECT_TRUE(run.step(steps));
  const Snapshot back = run.state();
  return {time, euclidean_distance(start.coordinates, back.coordinates) +
                    euclidean_distance(start.velocity, back.velocity)};
}

// Every registered system, mechanisms too, returns as nearly as with steps of one size: what is
// left is round-off, and what the motion makes of it on its way back (trailers, damped joints). The
// sizes of steps add less than two powers of ten to that.
TEST(ReversibleControl, ReturnsLikeStepsOfOneSize) {
  constexpr long steps = 150;
  int measured = 0;
  std::vector<std::string> names = registry().deferred_systems();  // mechanisms
  for (const std::string& name : registry().systems()) names.push_back(name);
  for (const std::string& name : names) {
    for (const std::string scheme : {"lift", "balance"}) {
      SCOPED_TRACE(name + " " + scheme);
      const Return chosen =
          return_of(simulate(name).scheme(scheme).tolerance({.relative = 1e-5}), steps);
      const Return fixed =
          return_of(simulate(name).scheme(scheme).step(chosen.time / steps), steps);
      EXPECT_LT(chosen.error, 100 * fixed.error + 1e-10);
      ++measured;
    }
  }
  EXPECT_GT(measured, 50);
}

// So also when the last step was cut to end at a time, as a run's last one is: that step is taken
// back first, as long as it was.
TEST(ReversibleControl, ReturnsFromACutStep) {
  for (const std::string system : {"falling_disk", "contact_oscillator", "suslov_in_potential"}) {
    for (const std::string compose : {"none", "suzuki4"}) {
      SCOPED_TRACE(system + " " + compose);
      hamel::Run run = simulate(system)
                           .scheme("lift")
                           .compose(compose)
                           .step(0.01)
                           .tolerance({.relative = 1e-5})
                           .build();
      const Snapshot start = run.state();
      ASSERT_TRUE(run.advance_to(7.3));
      const Snapshot there = run.state();
      EXPECT_DOUBLE_EQ(there.time, 7.3);
      run.turn_back();
      ASSERT_TRUE(run.advance_to(start.time));
      const Snapshot back = run.state();
      EXPECT_EQ(back.step, 2 * there.step);
      EXPECT_EQ(back.time, start.time);
      EXPECT_LT(euclidean_distance(start.coordinates, back.coordinates), 1e-10);
      EXPECT_LT(euclidean_distance(start.velocity, back.velocity), 1e-10);
    }
  }
}

// A particle on the plane in a potential of a given size, k = 1: V = m size^2 U(g/size).
struct Well {
  using Group = Rn<2>;
  double size = 1, mass = 1;
  static std::string name() { return "well"; }
  Mat<2, 2> inertia() const { return mass * Mat<2, 2>::Identity(); }
  auto potential(const auto& g) const {
    const auto x = g[0] / size, y = g[1] / size;
    return mass * size * size * (0.5 * x * x + y * y + 0.25 * x * x * y * y);
  }
};

// Neither the unit of lengths nor that of masses chooses the steps: of a disk that turns, and of a
// particle where nothing turns, which moves or rests at first.
TEST(ReversibleControl, IsFreeOfUnits) {
  const auto time_of = [](Simulation simulation) {
    hamel::Run run = simulation.scheme("lift").tolerance({.relative = 1e-5}).build();
    EXPECT_TRUE(run.step(300));
    return run.state().time;
  };
  const Snapshot metres = simulate("falling_disk").build().state();
  for (const auto& [length, weight] : {std::pair{1000.0, 1.0}, {0.01, 1.0}, {1.0, 50.0}}) {
    const double l = length, moment = weight * l * l;
    Start start = {.configuration = metres.coordinates, .velocity = metres.velocity};
    for (size_t i = 9; i < 12; ++i) start.configuration[i] *= l;
    for (size_t i = 3; i < 6; ++i) start.velocity[i] *= l;
    const double time = time_of(simulate("falling_disk"));
    const Simulation disk = simulate("falling_disk")
                                .set("radius", {0.5 * l})
                                .set("mass", {weight})
                                .set("axial_inertia", {0.125 * moment})
                                .set("diametral_inertia", {0.0625 * moment})
                                .set("gravity", {9.81 * l})
                                .start(start);
    EXPECT_NEAR(time_of(disk), time, 1e-8 * time);
    for (const double speed : {0.0, 0.7}) {
      const auto start_of = [speed](double size) {
        return Start{.configuration = {size, 0.3 * size}, .velocity = {0, speed * size}};
      };
      const double in_metres = time_of(simulate(Well{}).start(start_of(1)));
      EXPECT_GT(in_metres, 0.5);
      EXPECT_NEAR(time_of(simulate(Well{.size = l, .mass = weight}).start(start_of(l))), in_metres,
                  1e-8 * in_metres);
    }
  }
}

// The kick scooter in metres and in millimetres.
TEST(ReversibleControl, IsFreeOfTheUnitOfAMechanism) {
  const auto scooter = [](double unit) {
    const auto l = [unit](double x) { return x * unit; };
    Mechanism m("scooter");
    m.body("deck", {.mass = 5, .at = {l(0.3), 0, l(0.1)}, .box = {l(0.6), l(0.15), l(0.05)}});
    m.body("fork", {.mass = 1.5, .at = {l(0.75), 0, l(0.5)}, .box = {l(0.05), l(0.06), l(0.8)}});
    const auto wheel = [&](const std::string& name, double x, const std::string& on) {
      m.body(
          name,
          {.mass = 0.5, .at = {l(x), 0, l(0.1)}, .cylinder = {l(0.1), l(0.03)}, .axis = {0, 1, 0}});
      m.hinge(name, on, name, {.at = {l(x), 0, l(0.1)}, .axis = {0, 1, 0}});
      m.wheel(name, name, {.at = {l(x), 0, l(0.1)}, .radius = l(0.1)});
    };
    m.planar("road", "deck", {});
    m.hinge("steer", "deck", "fork", {.at = {l(0.75), 0, 0}, .damping = 0.02 * unit * unit});
    wheel("rear", 0, "deck");
    wheel("front", 0.72, "fork");
    m.start({{"v1", 2 * unit}, {"steer.angle", 0.3}});
    hamel::Run run = simulate(m).scheme("lift").tolerance({.relative = 1e-5}).build();
    EXPECT_TRUE(run.step(1000));
    return run.state().time;
  };
  const double time = scooter(1);
  EXPECT_GT(time, 0.5);
  for (const double unit : {1000.0, 0.01}) EXPECT_NEAR(scooter(unit), time, 1e-8 * time);
}

// Its error is proportional to the tolerance: eps^p = tolerance.
TEST(ReversibleControl, FollowsTheTolerance) {
  const Result exact = suslov().scheme("dop853").tolerance({.relative = 1e-13}).until(10).run();
  for (const auto& [scheme, compose] :
       {std::pair{"lift", "none"}, {"balance", "none"}, {"lift", "suzuki4"}}) {
    double before = 0;
    for (const double rtol : {1e-4, 1e-5, 1e-6}) {
      const Result r =
          suslov().scheme(scheme).compose(compose).tolerance({.relative = rtol}).until(10).run();
      ASSERT_TRUE(r) << r.status.reason;
      EXPECT_DOUBLE_EQ(r.last.time, 10);
      const double error = euclidean_distance(r.last.coordinates, exact.last.coordinates);
      if (before > 0) {
        EXPECT_NEAR(std::log10(before / error), 1, 0.25) << scheme << " " << compose << " " << rtol;
      }
      before = error;
    }
  }
}

// The energy over 10^5 steps: of one size, by the reversible control, and by the usual one, h = eps
// / r at the node where a step begins, which is not symmetric. Prints the least-squares slopes of
// the energy error with their own errors.
struct Drift {
  double largest = 0, slope = 0, slope_error = 0;
};
Drift drift_of(const std::vector<double>& t, const std::vector<double>& e) {
  const auto n = static_cast<double>(t.size());
  double mt = 0, me = 0, tt = 0, te = 0;
  Drift out;
  for (size_t i = 0; i < t.size(); ++i) {
    mt += t[i] / n;
    me += e[i] / n;
    out.largest = std::fmax(out.largest, std::abs(e[i] - e[0]));
  }
  for (size_t i = 0; i < t.size(); ++i) {
    tt += (t[i] - mt) * (t[i] - mt);
    te += (t[i] - mt) * (e[i] - me);
  }
  out.slope = te / tt;
  // Of the means of 20 blocks, since the error oscillates.
  constexpr size_t blocks = 20;
  const size_t length = t.size() / blocks;
  std::vector<double> bt(blocks), be(blocks);
  for (size_t b = 0; b < blocks; ++b) {
    for (size_t i = b * length; i < (b + 1) * length; ++i) {
      bt[b] += t[i] / static_cast<double>(length);
      be[b] += e[i] / static_cast<double>(length);
    }
  }
  double rest = 0, spread = 0;
  for (size_t b = 0; b < blocks; ++b) {
    const double off = be[b] - me - out.slope * (bt[b] - mt);
    rest += off * off;
    spread += (bt[b] - mt) * (bt[b] - mt);
  }
  out.slope_error = std::sqrt(rest / (blocks - 2) / spread);
  return out;
}

class UsualControl {
 public:
  // The absolute tolerance of a run is its relative one where none is given: eps^2 is their sum.
  UsualControl(const std::string& name, double rtol) : epsilon_(std::sqrt(2 * rtol)) {
    hamel::Run run = simulate(name).build();
    state_ = run.state();
    KernelSetup setup;
    setup.mechanics = run.system().mechanics;
    setup.geometry = registry().geometry(run.system().group.name, "cayley");
    setup.configuration = state_.coordinates;
    setup.velocity = state_.velocity;
    geometry_ = setup.geometry;
    motion_ = std::make_unique<EquationsOfMotion<DynamicProblem>>(
        DynamicProblem(geometry_, setup.mechanics));
    Eigen::MatrixXd inertia(setup.mechanics->dim(), setup.mechanics->dim());
    Eigen::VectorXd g(geometry_->size());
    geometry_->from_coordinates(state_.coordinates, g.data());
    setup.mechanics->inertia(g.data(), inertia);  // constant; its first three are of rotations
    length_ = std::sqrt(inertia.diagonal().head<3>().maxCoeff());
    const KernelFactory* own =
        registry().kernel(run.system().group.name, *setup.mechanics, "cayley", "lift");
    kernel_ = own != nullptr ? (*own)(setup) : registry().scheme("lift")->erased(setup);
  }
  const Snapshot& step() {
    Eigen::VectorXd g(geometry_->size());
    geometry_->from_coordinates(state_.coordinates, g.data());
    const Eigen::VectorXd xi = Eigen::Map<const Eigen::VectorXd>(
        state_.velocity.data(), static_cast<Eigen::Index>(state_.velocity.size()));
    motion_->solve(state_.time, g, xi);
    const double v = motion_->size(xi) / length_;
    const double r = std::sqrt(v * v + motion_->size(motion_->acceleration()) / length_);
    kernel_->restart(state_.time, state_.coordinates, state_.velocity, epsilon_ / r);
    EXPECT_TRUE(kernel_->advance(1));
    kernel_->state(state_);
    return state_;
  }

 private:
  double epsilon_, length_ = 1;
  Snapshot state_;
  std::shared_ptr<const Geometry> geometry_;
  std::unique_ptr<EquationsOfMotion<DynamicProblem>> motion_;
  std::unique_ptr<Kernel> kernel_;
};

TEST(ReversibleControl, KeepsTheEnergyOfALongMotion) {
  constexpr int steps = 100000, every = 20;
  std::printf("%-22s %-12s %10s %12s %12s %10s\n", "system", "steps", "time [s]", "largest",
              "slope [1/s]", "+-");
  for (const auto& [name, rtol] :
       {std::pair{"falling_disk", 1e-3}, {"suslov_in_potential", 1e-4}}) {
    Drift drifts[3];
    double end = 0;
    for (const int kind : {1, 2, 0}) {  // reversible, usual, of one size
      std::vector<double> t, e;
      std::vector<double> energies;
      const auto keep = [&](const Snapshot& s) {
        t.push_back(s.time);
        energies.push_back(s.energy);
      };
      if (kind == 2) {
        UsualControl run(name, rtol);
        for (int i = 0; i < steps; ++i)
          if (const Snapshot& s = run.step(); i % every == 0) keep(s);
      } else {
        Simulation simulation = simulate(name);
        if (kind == 1) simulation.scheme("lift").tolerance({.relative = rtol});
        else simulation.step(end / steps);
        hamel::Run run = simulation.build();
        for (int i = 0; i < steps; i += every) {
          ASSERT_TRUE(run.step(every)) << name << " " << kind;
          keep(run.state());
        }
        if (kind == 1) end = t.back();
      }
      e.clear();
      for (const double energy : energies) e.push_back(energy / std::abs(energies.front()));
      drifts[kind] = drift_of(t, e);
      std::printf("%-22s %-12s %10.1f %12.2e %12.2e %10.1e\n", name,
                  kind == 0   ? "one size"
                  : kind == 1 ? "reversible"
                              : "usual",
                  t.back(), drifts[kind].largest, drifts[kind].slope, drifts[kind].slope_error);
    }
    if (std::string(name) == "falling_disk") {
      EXPECT_LT(std::abs(drifts[1].slope), 3 * drifts[1].slope_error);
      EXPECT_GT(std::abs(drifts[2].slope), 3 * drifts[2].slope_error);
      EXPECT_LT(drifts[1].largest, drifts[2].largest);
    }
  }
}

}  // namespace
}  // namespace hamel
