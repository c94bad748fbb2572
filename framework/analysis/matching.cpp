#include <hamel/framework/analysis/matching.hpp>

#include <algorithm>
#include <tuple>

namespace hamel::reduced {

std::vector<int> matched(const std::vector<Complex>& values, const std::vector<Complex>& others) {
  std::vector<std::tuple<double, int, int>> pairs;
  for (size_t i = 0; i < values.size(); ++i) {
    for (size_t j = 0; j < others.size(); ++j) {
      pairs.emplace_back(std::abs(values[i] - others[j]), static_cast<int>(i), static_cast<int>(j));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> out(values.size(), -1);
  std::vector<bool> taken(others.size(), false);
  for (const auto& [distance, i, j] : pairs) {
    if (out[static_cast<size_t>(i)] >= 0 || taken[static_cast<size_t>(j)]) continue;
    out[static_cast<size_t>(i)] = j;
    taken[static_cast<size_t>(j)] = true;
  }
  return out;
}

}  // namespace hamel::reduced
