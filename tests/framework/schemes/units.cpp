// The certificate of a solve does not depend on the unit of length: |F|/scale of every general
// scheme is the same for a body in metres and in millimetres, where momenta mix N m s with N s.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

/// |F|/scale at a velocity near the solution, for a skate of the plane in units of 1/length metres;
/// with a constant force along the body.
double relative_residual(const SchemeInfo& scheme, double s, double length, bool forced) {
  class Pushed final : public Mechanics {
   public:
    Pushed(Eigen::MatrixXd inertia, Eigen::MatrixXd rows, Eigen::VectorXd force)
        : inertia_(std::move(inertia)), rows_(std::move(rows)), force_(std::move(force)) {}
    int dim() const override { return 3; }
    int constraint_count() const override { return 1; }
    bool constant_constraints() const override { return true; }
    void inertia(const double*, Matrix out) const override { out = inertia_; }
    void constraints(double, const double*, Matrix a, Vector b) const override {
      a = rows_;
      b.setZero();
    }
    void force(double, const double*, ConstVector, Vector out) const override { out = force_; }

   private:
    Eigen::MatrixXd inertia_, rows_;
    Eigen::VectorXd force_;
  };
  const Vec<3> unit(1, length, length);  // velocities in the new unit; momenta by length^2/unit
  const Mat<3, 3> to = unit.asDiagonal(), back = to.inverse();
  Mat<3, 3> inertia{{0.7, 0.1, 0.3}, {0.1, 2, 0}, {0.3, 0, 2}};
  inertia = (length * length * back * inertia * back).eval();
  const Mat<1, 3> row = Mat<1, 3>(0.2, -0.3, 1) * back;
  const Vec<3> force =
      forced ? Vec<3>(length * length * back * Vec<3>(0.1, 0.4, -0.2)) : Vec<3>(Vec<3>::Zero());
  SystemModel model;
  model.name = "skate";
  model.group = *registry().group("se2");
  model.mechanics = std::make_shared<Pushed>(inertia, row, force);
  double found = 0;
  class Inspector final : public Solver {
   public:
    Inspector(double& found, const Vec<3>& shift) : found_(found), shift_(shift) {}
    SolveReport solve(const Equation& equation, std::span<double> x, double) override {
      std::vector<double> f(x.size());
      for (size_t i = 0; i < x.size(); ++i) x[i] += shift_[static_cast<int>(i % 3)];
      equation.evaluate(x, f, {});
      double sum = 0;
      for (const double value : f) sum += value * value;
      found_ = std::sqrt(sum) / equation.scale();
      return {};
    }

   private:
    double& found_;
    Vec<3> shift_;
  };
  Registry mine = registry();
  mine.add(SolverInfo{"inspector", "", "", [&] {
                        return std::make_shared<Inspector>(found, to * Vec<3>(0.01, -0.02, 0.03));
                      }});
  const Vec<3> velocity = to * Vec<3>(0.9, 1.6, 0.3);
  Simulation simulation(mine, "skate", OwnSystem{[model](const Parameters&) { return model; }});
  simulation.scheme(scheme.name).s(s).solver("inspector").step(0.1);
  simulation.start({.velocity = {velocity.begin(), velocity.end()}});
  hamel::Run run = simulation.build();
  (void)run.step();
  return found;
}

TEST(Units, OfLengthDoNotChangeWhatASolveIsJudgedBy) {
  int schemes = 0;
  for (const std::string& name : registry().schemes()) {
    const SchemeInfo& scheme = *registry().scheme(name);
    if (scheme.explicit_step || scheme.left_invariant_only) continue;
    for (const double s : {0.0, 0.5}) {
      for (const bool forced : {false, true}) {
        const double metres = relative_residual(scheme, s, 1, forced),
                     millimetres = relative_residual(scheme, s, 1000, forced);
        EXPECT_GT(metres, 1e-4) << name;
        EXPECT_NEAR(millimetres, metres, 1e-10 * metres) << name << ", s = " << s << ", " << forced;
        ++schemes;
      }
    }
  }
  EXPECT_GE(schemes, 4 * 5);
}

}  // namespace
}  // namespace hamel
