// Spans of exact brackets (framework/analysis/exact_brackets.hpp) against those of fields carried
// along paths by differences, which have other fields of the same directions.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include <hamel/framework/analysis/carried_fields.hpp>
#include <hamel/framework/analysis/exact_brackets.hpp>
#include <hamel/framework/analysis/recorded_rows.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/mechanics/natural_units.hpp>
#include <hamel/systems/simulate.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

using carried::Generation;
using carried::Matrix;
using carried::Vector;

// Projections onto what the brackets of up to 1, 2, ... fields span.
std::vector<Matrix> projections(const std::vector<Generation>& generations) {
  std::vector<Matrix> out;
  Matrix span(generations.front().brackets.rows(), 0);
  for (const Generation& generation : generations) {
    const Matrix left = generation.brackets - span * (span.transpose() * generation.brackets);
    const dense::Svd svd = dense::svd(left, Eigen::ComputeThinU);
    Eigen::Index fresh = 0;
    while (fresh < svd.values.size() && svd.values[fresh] > 1e-5 * generation.size) ++fresh;
    Matrix wider(span.rows(), span.cols() + fresh);
    wider << span, svd.u.leftCols(fresh);
    span = wider;
    out.emplace_back(span * span.transpose());
  }
  return out;
}

class ExactBrackets : public testing::TestWithParam<const char*> {};

// At random places beside the start, of systems with and without rows that move.
TEST_P(ExactBrackets, SpanWhatCarriedFieldsSpan) {
  const hamel::Run run = simulate(GetParam()).build();
  const SystemModel& system = run.system();
  const auto geometry = registry().geometry(system.group.name, "exp");
  Vector start(geometry->size());
  geometry->from_coordinates(run.config().start.configuration, start.data());
  const int n = geometry->dim();
  const bool drift = system.mechanics->has_drift();
  const std::vector<double> natural =
      natural_units(components_of(system), *system.mechanics, start.data());
  const Vector units = Eigen::Map<const Vector>(natural.data(), n);
  const auto rows = recorded_rows(system, *geometry, start.data());
  ASSERT_TRUE(rows.has_value());
  carried::ExactBrackets exact(*rows, *geometry, units, drift);
  std::mt19937 random(7);
  for (int place = 0; place < 3; ++place) {
    Vector step(n), g(start.size());
    for (int i = 0; i < n; ++i)
      step[i] = 0.3 * units[i] * (static_cast<double>(random()) / 2147483648.0 - 1);
    geometry->tau(step.data(), g.data());
    geometry->compose(start.data(), g.data(), g.data());
    carried::Fields fields(*geometry, *system.mechanics, g, units, drift);
    const std::vector<Matrix> found = projections(exact.generations(g, 0, 3)),
                              expected = projections(
                                  generations(fields, Vector::Zero(fields.coordinates()), 3));
    for (size_t i = 0; i < found.size(); ++i)
      EXPECT_LT((found[i] - expected[i]).norm(), 1e-6) << "of " << i + 1 << " fields";
  }
}

INSTANTIATE_TEST_SUITE_P(All, ExactBrackets,
                         testing::Values("falling_disk", "rattleback", "veselova", "chaplygin_ball",
                                         "ball_on_turntable", "snakeboard", "n_trailer",
                                         "contact_oscillator", "kick_scooter", "unicycle_rider",
                                         "two_trailer_truck"),
                         [](const auto& made) { return std::string(made.param); });

}  // namespace
}  // namespace hamel
