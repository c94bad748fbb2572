// Derivatives of runs by parameters, inputs and starts: closed forms, differences of whole runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/tangent/sensitivities.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace {

using hamel::Sensitivities;
using testing::HasSubstr;

const std::vector<double>& column(const Sensitivities& s, const std::string& name) {
  return std::get<std::vector<double>>(s.rows.column(name).values);
}

/// v' = a omega^2, (I + m a^2) omega' = -m a v omega: v = U tanh k(t - t0), omega = W sech k(t -
/// t0) (tools: systems/chaplygin_sleigh.hpp); derivatives by complex steps of this.
template <class T>
std::pair<T, T> exact_sleigh(T a, T v0, T w0, double t) {
  using std::atanh, std::cosh, std::sqrt, std::tanh;
  const T j = 1.0 + a * a;
  const T u = sqrt(v0 * v0 + j * w0 * w0), w = u / sqrt(j), k = a * u / j;
  const T s = k * t + atanh(v0 / u);
  return {u * tanh(s), w / cosh(s)};
}

TEST(Sensitivities, OfTheSleighAreClosed) {
  const Sensitivities s = hamel::simulate("chaplygin_sleigh")
                              .set("mass", 1)
                              .set("inertia", 1)
                              .set("offset", 0.2)
                              .start({.velocity = {1, 1, 0}})
                              .tolerance({.relative = 1e-12})
                              .output(0.5)
                              .until(4)
                              .sensitivities({"offset", "start.v1", "start.omega"});
  ASSERT_TRUE(s.status.ok) << s.status.reason;
  using C = std::complex<double>;
  const double tiny = 1e-30;
  const std::vector<double>& t = column(s, "t");
  ASSERT_EQ(t.size(), 9u);
  const std::vector<std::string> by = {"offset", "start.v1", "start.omega"};
  for (size_t i = 0; i < t.size(); ++i) {
    for (size_t p = 0; p < 3; ++p) {
      C x[3] = {0.2, 1.0, 1.0};
      x[p] += C(0, tiny);
      const auto [v, w] = exact_sleigh<C>(x[0], x[1], x[2], t[i]);
      EXPECT_NEAR(column(s, "d(v1)/d(" + by[p] + ")")[i], v.imag() / tiny, 2e-9) << t[i] << by[p];
      EXPECT_NEAR(column(s, "d(omega)/d(" + by[p] + ")")[i], w.imag() / tiny, 2e-9) << by[p];
    }
  }
  for (const double error : s.errors) EXPECT_LT(error, 1e-6);
}

/// The same numbers as one: the kinetic energy is that of the start, m v0^2/2 + (I + m a^2) w0^2/2.
TEST(Sensitivities, OfANumberAtTheEndAreItsGradient) {
  const hamel::Simulation sleigh = hamel::simulate("chaplygin_sleigh")
                                       .set("mass", 1)
                                       .set("inertia", 1)
                                       .set("offset", 0.2)
                                       .start({.velocity = {1, 1, 0}})
                                       .tolerance({.relative = 1e-12})
                                       .until(4);
  const hamel::Gradient energy =
      sleigh.gradient("energy", {"offset", "mass", "start.v1", "start.omega"});
  ASSERT_TRUE(energy.status.ok) << energy.status.reason;
  EXPECT_NEAR(energy.value, 1.02, 1e-10);
  const std::vector<double> exact = {0.2, 0.52, 1, 1.04};
  for (size_t i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(energy.by[i], exact[i], 1e-9) << energy.names[i];
    EXPECT_LT(energy.errors[i], 1e-5);
  }
  // v^2 + J w^2 with the parameter in the formula too: J' = 2 a.
  const hamel::Gradient formula = sleigh.gradient("v1^2 + (1 + offset^2)*omega^2", {"offset"});
  EXPECT_NEAR(formula.by[0], 0.4, 1e-9);
  EXPECT_THROW(sleigh.gradient("v9 + 1", {"offset"}), hamel::ConfigError);
}

/// By every parameter of every system, from differences of whole runs.
TEST(Sensitivities, ByEveryParameterAreThoseOfWholeRuns) {
  int parameters = 0;
  for (const std::string& name : hamel::systems()) {
    SCOPED_TRACE(name);
    const hamel::Simulation simulation =
        hamel::simulate(name).scheme("dop853").step(0.02).until(0.1).every(5);
    const auto model = simulation.system();
    for (const hamel::Field& field : model->fields) {
      if (field.value.size() != 1 || field.value[0] == 0) continue;
      SCOPED_TRACE(field.name);
      const double p = field.value[0], e = 0x1p-6 * std::abs(p);
      const auto end = [&](double x) {
        hamel::Run run = hamel::Simulation(simulation).set(field.name, p + x).build();
        EXPECT_TRUE(run.advance_to(0.1).ok);
        return run.state().velocity;
      };
      Sensitivities s;
      try {
        s = simulation.sensitivities({field.name});
        end(e);
        end(-e);
      } catch (const hamel::ConfigError&) {  // whole numbers, and edges of ranges
        continue;
      }
      ASSERT_TRUE(s.status.ok) << s.status.reason;
      const std::vector<double> a = end(e), b = end(-e), c = end(e / 2), d = end(-e / 2),
                                f = end(e / 4), g = end(-e / 4);
      for (size_t i = 0; i < a.size(); ++i) {
        const double coarse = (a[i] - b[i]) / (2 * e), finer = (c[i] - d[i]) / e,
                     finest = (f[i] - g[i]) / (e / 2),
                     expected = (64 * finest - 20 * finer + coarse) / 45;
        const double found = column(s, "d(" + model->rates[i] + ")/d(" + field.name + ")").back();
        EXPECT_NEAR(found, expected, 1e-8 * (std::abs(expected) + 1)) << model->rates[i];
      }
      ++parameters;
    }
  }
  EXPECT_GT(parameters, 80);
}

TEST(Sensitivities, RefuseWhatTheyDoNotCover) {
  const auto mistake = [](const hamel::Simulation& simulation,
                          const std::vector<std::string>& names) -> std::string {
    try {
      simulation.sensitivities(names);
      return "";
    } catch (const hamel::ConfigError& error) {
      return error.what();
    }
  };
  const hamel::Simulation sleigh = hamel::simulate("chaplygin_sleigh");
  EXPECT_THAT(mistake(sleigh, {"ofset"}), HasSubstr("did you mean 'offset'?"));
  EXPECT_THAT(mistake(sleigh, {"start.omga"}), HasSubstr("did you mean 'start.omega'?"));
  EXPECT_THAT(mistake(hamel::simulate("falling_disk").set("friction", 0.3), {"mass"}),
              HasSubstr("there is no tangent through an impact or a switch of contacts yet"));
}

/// A gradient over a horizon over which it has lost its digits.
TEST(Sensitivities, AreRefusedWhereTheyHaveGrown) {
  const Sensitivities s =
      hamel::simulate("segway").scheme("dop853").step(0.05).until(60).every(10).sensitivities(
          {"start.pitch'"});
  EXPECT_FALSE(s.status.ok);
  EXPECT_THAT(s.status.reason, HasSubstr("more than 1e+08"));
  EXPECT_GT(s.rows.rows(), 3u);
}

}  // namespace
