// Named runs give what they gave before the schemes and the loop became one
// (tests/verification/stored_runs.json, as printed by `hamel run … --json`). falling_disk by rkmk4
// is recorded anew since its stages carry y of the frame (M6): another member of order 4 (error
// 2.0e-7 in place of 1.2e-7 there; dop853 at equal tolerance is as accurate in fewer steps).
// Nine are recorded anew since a kept Jacobian learns (solvers/newton.hpp). They changed by at most
// 4.7e-13 and came nearer to what the solver hybrid gives (energy_preserving: 3.5e-13 off before,
// 2.3e-14 now), but for the sleigh (5e-14, as before) and ball_on_turntable (7e-14, now 1.3e-13).
// ball_on_turntable, n_trailer and routh_sphere are recorded anew since a step's equation is
// without a basis (metric/metric.hpp). They changed by 1.2e-13, 1.1e-13 and 1.8e-13; distances from
// what hybrid gives: 4.6e-14 before, 1.8e-14 now; 6.0e-14, 6.3e-14; 1.5e-13, 4.3e-14. Over ten
// sizes of the step the means are 7.7e-14, 4.7e-14; 3.9e-14, 4.4e-14; 1.6e-13, 2.1e-13.
//
// Bound: 1e-13, relative to the largest entry of the element, of the velocity and of the energy
// where that exceeds
// 1. Two ways to evaluate one step differ by some units of round-off, 2e-16 each, and 500 steps add
// up to less.
#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "../cli/program.hpp"

namespace {

using namespace hamel::test;
using Json = nlohmann::json;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// The numbers of a matrix, of a list of matrices, of a vector or of one number.
std::vector<double> numbers(const Json& value) {
  if (!value.is_array()) return {value.is_number() ? value.get<double>() : std::nan("")};
  std::vector<double> out;
  for (const Json& entry : value) {
    const std::vector<double> more = numbers(entry);
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

/// max |a - b| over max(1, max |b|); infinite where they cannot be compared.
double difference(const Json& measured, const Json& stored) {
  const std::vector<double> a = numbers(measured), b = numbers(stored);
  if (a.size() != b.size()) return infinite;
  double size = 1, largest = 0;
  for (size_t i = 0; i < b.size(); ++i) {
    size = std::max(size, std::abs(b[i]));
    const double distance = std::abs(a[i] - b[i]);
    largest = std::isnan(distance) ? infinite : std::max(largest, distance);
  }
  return largest / size;
}

class StoredRuns : public CommandLine {};

TEST_F(StoredRuns, AreRepeated) {
  const Json all = Json::parse(source_file("tests/verification/stored_runs.json"));
  ASSERT_GE(all.size(), 28u);
  for (const Json& stored : all) {
    const std::string what = stored.at("run");
    SCOPED_TRACE("hamel run " + what);
    std::vector<std::string> arguments = split(what, ' ');
    arguments.insert(arguments.begin(), "run");
    arguments.push_back("--json");
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Json record = Json::parse(outcome.out);
    EXPECT_EQ(record.at("steps"), stored.at("steps"));
    for (const char* member : {"element", "velocity", "energy"}) {
      EXPECT_LE(difference(record.at("final").at(member), stored.at(member)), 1e-13) << member;
    }
  }
}

/// The comparison must be able to fail: a difference of 2e-13 in one entry, a missing entry, no
/// number.
TEST(StoredRunsDifference, IsSeen) {
  const Json stored = {{0.5, 2.0}, {0.0, -4.0}};
  EXPECT_EQ(difference(stored, stored), 0);
  Json changed = stored;
  changed[1][0] = 8e-13;
  EXPECT_NEAR(difference(changed, stored), 2e-13, 1e-16);
  changed[1][0] = nullptr;
  EXPECT_EQ(difference(changed, stored), infinite);
  EXPECT_EQ(difference(Json{0.5, 2.0}, stored), infinite);
}

}  // namespace
