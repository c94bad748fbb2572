// Eigenvalues about steady motions at every scale of length, rate and unit: right within their
// errors, and the verdict right or not decided.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include <fmt/format.h>
#include <Eigen/Dense>

#include <hamel/framework/analysis/linearisation.hpp>
#include <hamel/framework/analysis/steady.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

SteadyMotion motion_of(const std::string& toml) {
  const SystemModel system = data_system(registry(), toml, "system.toml");
  return steady_motion(registry(), system, system.start);
}

// Every value is matched by one of the motion within its error, and errors are at most `part` of
// the largest value.
void expect_values(const SteadyMotion& motion, const Eigen::VectorXcd& values, double part,
                   const std::string& what) {
  ASSERT_EQ(static_cast<Eigen::Index>(motion.eigenvalues.size()), values.size()) << what;
  const double largest = values.cwiseAbs().maxCoeff();
  for (size_t i = 0; i < motion.eigenvalues.size(); ++i) {
    double least = 1e300;
    for (const auto& value : values)
      least = std::min(least, std::abs(value - motion.eigenvalues[i]));
    EXPECT_LE(least, motion.round_off[i] + 1e-13 * largest) << what;
    EXPECT_LE(motion.round_off[i], part * largest) << what;
  }
}

// One body of mass m in V = k x^2/2 with a force -d tanh(v/e).
TEST(SteadyScales, SmoothedFrictionIsDampingAtRest) {
  const SteadyMotion motion = motion_of(
      "group = \"r1\"\ninertia = [1]\npotential = \"2*x1^2\"\nforce = [\"-tanh(x1'/0.01)\"]\n"
      "velocity = [0]\n");
  ASSERT_EQ(motion.eigenvalues.size(), 2u);
  EXPECT_NEAR(motion.eigenvalues[0].real(), -0.0400160128134, 1e-11);
  EXPECT_NEAR(motion.eigenvalues[1].real(), -99.9599839871866, 1e-9);
  EXPECT_EQ(motion.decided_growing(), 0);
}

// Over the centre by 1 mm at 5 mm: away from there the spring pulls back.
TEST(SteadyScales, SpringOverItsCentre) {
  const auto spring = [](double rest) {
    return motion_of(
        fmt::format("group = \"r1\"\ninertia = [1]\nvelocity = [0]\n"
                    "potential = \"50*(sqrt(x1^2 + 2.5e-5) - {})^2\"\n",
                    rest));
  };
  const SteadyMotion over = spring(0.006), under = spring(0.004);
  ASSERT_EQ(over.eigenvalues.size(), 2u);
  EXPECT_NEAR(over.eigenvalues[0].real(), std::sqrt(20), 1e-10);
  EXPECT_EQ(over.decided_growing(), 1);
  ASSERT_EQ(under.eigenvalues.size(), 2u);
  EXPECT_NEAR(under.eigenvalues[0].imag(), std::sqrt(20), 1e-10);
  EXPECT_EQ(under.eigenvalues[0].real(), 0);  // a potential alone: on the axis
  EXPECT_EQ(under.decided_growing(), 0);
}

// Damping below the error of the eigenvalues, of either sign: nothing is claimed.
TEST(SteadyScales, NotDecidedWithinTheError) {
  for (const char* damping : {"-1e-18", "1e-18"}) {
    const SteadyMotion motion = motion_of(fmt::format(
        "group = \"r1\"\ninertia = [1]\nforce = [\"-x1 + {}*x1'\"]\nvelocity = [0]\n", damping));
    EXPECT_EQ(motion.decided_growing(), std::nullopt);
    EXPECT_LT(motion.largest_growth(), 1e-12);
  }
  const SteadyMotion grows =
      motion_of("group = \"r1\"\ninertia = [1]\nforce = [\"-x1 + 1e-9*x1'\"]\nvelocity = [0]\n");
  EXPECT_EQ(grows.decided_growing(), 2);
}

// Two bodies in narrow wells or on narrow hills beside a wide well, coupled, with steep friction or
// drive; lengths over eight decades, rates over four.
//   V = sum a_i (1 - exp(-x_i^2 / 2 w_i^2)) + b (x1 - x2)^2 / 2,  f_i = -d_i tanh(v_i / e_i)
TEST(SteadyScales, NarrowWells) {
  std::mt19937 random(11);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  int outside = 0, decided = 0;
  constexpr int count = 120;
  for (int i = 0; i < count; ++i) {
    const double length = std::pow(10, uniform(-4, 4)), time = std::pow(10, uniform(-2, 2));
    Eigen::Vector2d m, k, d, e, w;
    for (int j = 0; j < 2; ++j) {
      m[j] = std::pow(10, uniform(-1, 1));
      w[j] = length * std::pow(10, uniform(-2, 0));
      k[j] = m[j] / (time * time) * uniform(0.2, 3) * (random() % 3 == 0 ? -1 : 1);
      d[j] = m[j] / time * uniform(0.1, 3) * (random() % 4 == 0 ? -1 : 1);
      e[j] = length / time * std::pow(10, uniform(-3, 0));
    }
    const double b = m[0] / (time * time) * uniform(0, 1), far = 1e-2 * k.cwiseAbs().minCoeff();
    std::string potential, force;
    for (int j = 0; j < 2; ++j) {
      potential += fmt::format("{:+.17g}*(1 - exp(-x{}^2/{:.17g})) {:+.17g}*x{}^2",
                               k[j] * w[j] * w[j], j + 1, 2 * w[j] * w[j], far / 2, j + 1);
      force += fmt::format("{}\"{:.17g}*tanh(x{}'/{:.17g})\"", j > 0 ? ", " : "", -d[j] * e[j],
                           j + 1, e[j]);
    }
    const SteadyMotion motion =
        motion_of(fmt::format("group = \"r2\"\ninertia = [{:.17g}, {:.17g}]\nvelocity = [0, 0]\n"
                              "potential = \"{} {:+.17g}*(x1 - x2)^2\"\nforce = [{}]\n",
                              m[0], m[1], potential, b / 2, force));
    Eigen::Matrix4d flow = Eigen::Matrix4d::Zero();  // in this time's unit, where it is balanced
    flow.topRightCorner<2, 2>().setIdentity();
    for (int j = 0; j < 2; ++j) {
      flow(2 + j, j) = -(k[j] + far + b) / m[j] * time * time;
      flow(2 + j, 1 - j) = b / m[j] * time * time;
      flow(2 + j, 2 + j) = -d[j] / m[j] * time;
    }
    const Eigen::VectorXcd values = dense::eigenvalues(flow) / time;
    const std::string what = fmt::format("{}: {} | {}", i, potential, force);
    expect_values(motion, values, 1e-6, what);
    int growing = 0;
    for (const auto& value : values) growing += value.real() > 0;
    const std::optional<int> verdict = motion.decided_growing();
    decided += verdict.has_value();
    outside += verdict && *verdict != growing;
  }
  EXPECT_EQ(outside, 0);
  EXPECT_GT(decided, count * 9 / 10);
}

// Units of length, mass and time change eigenvalues as rates change, and no verdict.
TEST(SteadyScales, UnitsDoNotMatter) {
  const auto in_units = [](double metre, double kilogram, double second) {
    const double force = kilogram * metre / (second * second), slope = force / metre;
    return motion_of(
        fmt::format("group = \"r2\"\ninertia = [{0:.17g}, {1:.17g}]\nvelocity = [0, 0]\n"
                    "force = [\"{2:.17g}*x1 - {3:.17g}*tanh(x1'/{4:.17g}) + {5:.17g}*x2\", "
                    "\"-{6:.17g}*x2*exp(-x2^2/{7:.17g}) - "
                    "{5:.17g}*x1\"]\n",
                    2 * kilogram, 3 * kilogram, -5 * slope, 0.4 * force, 0.01 * metre / second,
                    0.7 * slope, 9 * slope, 1e-6 * metre * metre));
  };
  const SteadyMotion first = in_units(1, 1, 1);
  ASSERT_EQ(first.eigenvalues.size(), 4u);
  for (const double metre : {1e-6, 1e-3, 1e3, 1e6}) {
    for (const double second : {1e-3, 1.0, 1e3}) {
      const SteadyMotion other = in_units(metre, 1 / metre, second);
      ASSERT_EQ(other.eigenvalues.size(), 4u) << metre << " " << second;
      EXPECT_EQ(other.decided_growing(), first.decided_growing());
      for (size_t i = 0; i < 4; ++i) {
        EXPECT_LE(std::abs(other.eigenvalues[i] * second - first.eigenvalues[i]),
                  other.round_off[i] * second + first.round_off[i])
            << metre << " " << second;
        EXPECT_LE(other.round_off[i] * second, 1e-8) << metre << " " << second;
      }
    }
  }
}

// The stone of Kane and Levinson, spun: run backwards its spectrum is that of the other sense, and
// turned over that of the other skew, so that a mode grows for every skew but 0. Steps of 0.01 are
// beyond its ellipsoid of 0.02 m.
TEST(SteadyScales, AThinRattlebackGrowsForEverySkew) {
  const auto stone = [](double skew, double spin) {
    return simulate("rattleback")
        .set("semi_axes", {0.2, 0.03, 0.02})
        .set("depth", 0.01)
        .set("inertia", {2e-4, 1.6e-3, 1.7e-3})
        .set("skew", skew)
        .start({.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0.01},
                .velocity = {0, 0, spin, 0, 0, 0}});
  };
  for (const double skew : {1e-4, 0.0143, 0.1, 0.3, 0.7}) {
    const SteadyMotion one = steady_motion(registry(), stone(skew, 5));
    const SteadyMotion backwards = steady_motion(registry(), stone(skew, -5));
    const SteadyMotion mirrored = steady_motion(registry(), stone(-skew, -5));
    ASSERT_EQ(one.eigenvalues.size(), 4u);
    ASSERT_EQ(backwards.eigenvalues.size(), 4u);
    EXPECT_EQ(one.decided_growing(), 2) << skew;
    EXPECT_EQ(backwards.decided_growing(), 2) << skew;
    for (size_t i = 0; i < 4; ++i) {
      const double known = one.round_off[i] + 1e-15;
      EXPECT_NEAR(one.eigenvalues[i].real(), -backwards.eigenvalues[3 - i].real(),
                  known + backwards.round_off[3 - i]);
      EXPECT_NEAR(one.eigenvalues[i].real(), mirrored.eigenvalues[i].real(),
                  known + mirrored.round_off[i]);
      EXPECT_LE(one.round_off[i], 1e-6) << skew;
    }
  }
  const SteadySweep sweep = sweep_steady(registry(), {0.002, 0.0616, 0.1212, 0.1808, 0.2404, 0.3},
                                         [&](double skew) { return stone(skew, 5); });
  EXPECT_TRUE(sweep.crossings.empty());
}

// The parts of a mode are the velocities of an eigenvector of A, which is not balanced. Entries
// that are round-off are no sizes to balance by: a segway fell over one wheel.
TEST(SteadyScales, PartsOfAModeAreOfAnEigenvector) {
  struct Case {
    const char* system;
    double speed;
  };
  for (const auto& [system, speed] :
       {Case{"segway", 0}, Case{"segway", 1}, Case{"bicycle", 3}, Case{"bicycle", 7},
        Case{"two_trailer_truck", -3}, Case{"falling_disk", 2}}) {
    const Simulation run = simulate(system).speed(speed);
    const Linearisation linear = linearisation(registry(), run);
    const SteadyMotion& motion = linear.motion;
    const int m = linear.a.rows, n = linear.embedding.rows / 2;
    Eigen::MatrixXd a(m, m), embedding(2 * n, m);
    for (int j = 0; j < m; ++j) {
      for (int i = 0; i < m; ++i) a(i, j) = linear.a(i, j);
      for (int i = 0; i < 2 * n; ++i) embedding(i, j) = linear.embedding(i, j);
    }
    const std::vector<Component> components = components_of(run.build().system());
    for (size_t k = 0; k < motion.eigenvalues.size(); ++k) {
      SCOPED_TRACE(fmt::format("{} {} mode {}", system, speed, k));
      // Two steps of inverse iteration from a value beside it.
      const auto shift = motion.eigenvalues[k] * (1 + 1e-9);
      const Eigen::MatrixXcd shifted =
          a.cast<std::complex<double>>() - shift * Eigen::MatrixXcd::Identity(m, m);
      Eigen::VectorXcd v = Eigen::VectorXcd::LinSpaced(m, 1, 2);
      for (int step = 0; step < 3; ++step) v = shifted.fullPivLu().solve(v).normalized();
      Eigen::VectorXd parts = (embedding * v).tail(n).cwiseAbs();
      parts /= parts.maxCoeff();
      std::map<std::string, double> said;
      for (const ModePart& part : motion.modes[k]) said[part.name] = part.size;
      for (int i = 0; i < n; ++i) {
        const auto found = said.find(components[static_cast<size_t>(i)].name);
        if (found != said.end()) EXPECT_NEAR(found->second, parts[i], 1e-5) << found->first;
        else EXPECT_LT(parts[i], 0.051) << components[static_cast<size_t>(i)].name;
      }
    }
  }
}

// Every entry of A, B and C has an error that covers it.
TEST(SteadyScales, EntriesHaveErrors) {
  const std::string text =
      "group = \"r1\"\ninertia = [2]\npotential = \"3*x1^2\"\n"
      "force = [\"-tanh(x1'/1e-3) + push\"]\nvelocity = [0]\n[inputs]\npush = {}\n";
  const Simulation run(registry(), "data",
                       OwnSystem{data_system_maker(registry(), "d.toml", text)});
  const Linearisation linear = linearisation(registry(), run);
  const double exact[] = {0, 1, -3, -500};
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_LE(std::abs(linear.a.values[i] - exact[i]), linear.a_error.values[i] + 1e-15);
    EXPECT_LE(linear.a_error.values[i], 1e-9);
  }
  ASSERT_EQ(linear.b.values.size(), 2u);
  EXPECT_LE(std::abs(linear.b.values[1] - 0.5), linear.b_error.values[1]);
  EXPECT_LE(linear.b_error.values[1], 1e-12);
  ASSERT_EQ(linear.c_error.values.size(), linear.c.values.size());
}

}  // namespace
}  // namespace hamel
