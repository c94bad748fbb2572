// An ensemble of bodies, and what two runs of one ensemble have in common.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hamel/hamel.hpp>

namespace hamel::test {

inline std::vector<double> column(const EnsembleResult& result, const std::string& name) {
  return std::get<0>(result.table.column(name).values);
}

/// A body from random starts, whose system lanes are compiled for.
inline EnsembleConfig body() {
  using Law = Variation::Law;
  EnsembleConfig config;
  config.run.system = "suslov";
  config.run.parameters["inertia"] = {2, 0.3, 0.5, 3, 0.4, 4};
  config.run.scheme = "lift";
  config.run.step = 0.05;
  config.run.until = 0.5;
  config.members = 100;
  config.seed = 3;
  config.vary = {{"start.omega1", Law::normal, {1, 0.2}}, {"start.omega2", Law::uniform, {-1, 1}}};
  config.keep = {{"", "end.omega1"}, {"", "max.energy_error"}, {"", "min.(omega1^2)"}};
  return config;
}

inline void expect_same(const EnsembleResult& a, const EnsembleResult& b) {
  ASSERT_EQ(a.table.columns.size(), b.table.columns.size());
  for (size_t i = 0; i < a.table.columns.size(); ++i)
    for (size_t k = 0; k < a.table.rows(); ++k)
      EXPECT_EQ(a.table.columns[i].text(k), b.table.columns[i].text(k)) << i << " " << k;
}

}  // namespace hamel::test
