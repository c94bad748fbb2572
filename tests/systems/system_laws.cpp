// Every registered system obeys the laws of framework/check/system_laws.hpp by name; that the laws
// see mistakes. By type: systems/typed_laws.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include <hamel/framework/check/system_laws.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/rn.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/simulate_typed.hpp>
#include <hamel/systems/suslov.hpp>

namespace {

using namespace hamel;

void expect(const LawReport& report, const std::string& what) {
  EXPECT_GE(report.size(), 4u) << what;
  for (const LawResult& law : report) EXPECT_TRUE(law.passed()) << what << ": " << law;
}
int failures(const LawReport& report) {
  int out = 0;
  for (const LawResult& law : report) out += law.passed() ? 0 : 1;
  return out;
}

TEST(SystemLaws, HoldForEveryRegisteredSystem) {
  for (const std::string& name : registry().systems()) expect(check_system(registry(), name), name);
}

/// Each plant is a system with one mistake in it.
struct WrongRate : Suslov {  // Omega of the exact motion runs 0.1 % too fast
  auto exact(const SO3::Element<double>& r0, const Vec<3>& omega0) const {
    return [flow = Suslov::exact(r0, omega0)](double t) mutable { return flow(1.001 * t); };
  }
};
struct WrongPath : Suslov {  // spatial for body: R' = Omega^ R
  auto exact(const SO3::Element<double>& r0, const Vec<3>& omega0) const {
    return [flow = Suslov::exact(r0, omega0)](double t) mutable {
      const auto [r, omega] = flow(t);
      return std::pair{SO3::inverse(r), omega};
    };
  }
};
struct WrongInertia : Suslov {  // the exact motion belongs to another body
  Mat<3, 3> inertia() const { return 1.5 * Suslov::inertia() + 0.5 * Mat<3, 3>::Identity(); }
};
struct WrongInvariant : Suslov {
  void invariants(auto& add) const {
    add("omega 1", [](const auto&, const Vec<3>& w) { return w[0]; });
  }
};
struct Inadmissible : Suslov {
  Start start() const { return {.configuration = {}, .velocity = {1, 0.5, 0.1}, .momentum = {}}; }
};
struct Asymmetric : Suslov {
  Mat<3, 3> inertia() const {
    Mat<3, 3> out = Suslov::inertia();
    out(0, 1) += 1e-6;
    return out;
  }
};
template <class S>
S full() {
  S body;
  body.moments = {2, .3, .5, 3, .4, 4};
  return body;
}
TEST(SystemLaws, SeePlantedMistakes) {
  EXPECT_GE(failures(check_system<WrongRate, Exp<SO3>>(full<WrongRate>())), 4);
  EXPECT_GE(failures(check_system<WrongPath, Exp<SO3>>(full<WrongPath>())), 2);
  EXPECT_GE(failures(check_system<WrongInertia, Exp<SO3>>(full<WrongInertia>())), 2);
  EXPECT_GE(failures(check_system<WrongInvariant, Exp<SO3>>(full<WrongInvariant>())), 2);
  EXPECT_GE(failures(check_system<Inadmissible, Exp<SO3>>(full<Inadmissible>())), 1);
  EXPECT_GE(failures(check_system<Asymmetric, Exp<SO3>>(full<Asymmetric>())), 1);
}

// A blade on a plane that states the rate of its row, times a factor.
struct Blade {
  using Group = Rn<3>;
  static std::string name() { return "blade"; }
  static Mat<3, 3> inertia() { return Vec<3>(1, 2, 3).asDiagonal(); }
  static Mat<1, 3> constraints(const Vec<3>& q) {
    return Mat<1, 3>{{0, std::sin(q[0]), -std::cos(q[0])}};
  }
  static Start start() { return {.velocity = {1, 1, 0}}; }
};
struct StatedRates final : LeftInvariantMechanics {
  explicit StatedRates(double times)
      : LeftInvariantMechanics(Blade::inertia(), Eigen::MatrixXd::Zero(1, 3)), factor(times) {}
  bool left_invariant() const override { return false; }
  bool constant_constraints() const override { return false; }
  void constraints(double, const double* q, Matrix a, Vector b) const override {
    a = Blade::constraints({q[0], q[1], q[2]});
    b.setZero();
  }
  bool exact_rates() const override { return true; }
  void rates(const Geometry&, double, const double* q, ConstVector xi, Vector rows,
             Vector momentum) const override {
    rows[0] = -factor * xi[0] * (std::cos(q[0]) * xi[1] + std::sin(q[0]) * xi[2]);
    momentum.setZero();
  }
  double factor;
};
TEST(SystemLaws, SeeRatesThatAreNotThoseOfTheRows) {
  const auto geometry = erased_geometry<Exp<Rn<3>>>();
  for (const double factor : {1.0, 1 + 1e-6}) {
    SystemModel model = erase(Blade());
    model.mechanics = std::make_shared<StatedRates>(factor);
    EXPECT_EQ(failures(check_system(model, 1, geometry.get())), factor == 1 ? 0 : 1) << factor;
  }
}

/// A parameter of default 0 that never reaches the struct; and one that cannot be anything but
/// whole.
struct LostParameter : ChaplyginSleigh {
  static std::string name() { return "lost_parameter"; }
  void fields(auto& f) {
    double nowhere = 0;
    f("tilt", nowhere, "rad");
  }
};
struct WholeParameter : ChaplyginSleigh {
  double count = 0;
  static std::string name() { return "whole_parameter"; }
  void fields(auto& f) { f("count", count, "1"); }
  Mat<3, 3> inertia() const {
    if (count != std::floor(count)) throw std::invalid_argument("count: expected a whole number");
    return ChaplyginSleigh::inertia();
  }
};
TEST(SystemLaws, SeeAParameterThatGoesNowhere) {
  Registry mine = registry();
  mine.add(system_info<LostParameter>());
  mine.add(system_info<WholeParameter>());
  const LawReport lost = check_system(mine, "lost_parameter");
  ASSERT_EQ(failures(lost), 1);
  for (const LawResult& law : lost) {
    if (!law.passed()) {
      EXPECT_EQ(law.law, "fields round trip");
    }
  }
  expect(check_system(mine, "whole_parameter"), "whole_parameter");
}

}  // namespace
