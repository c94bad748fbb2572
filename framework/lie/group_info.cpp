#include <hamel/framework/lie/group_info.hpp>

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

extern "C" const int HAMEL_BUILT_WITH = 1;

namespace hamel {
namespace detail {

void check_factor(const GroupFactor& factor) {
  const auto check = [&](const char* what, size_t count, int expected) {
    if (count > 0 && count != static_cast<size_t>(expected)) {
      throw std::invalid_argument(
          fmt::format("{}: {}: {} entries, expected {}", factor.name, what, count, expected));
    }
  };
  check("components", factor.components.size(), factor.dim);
  check("units", factor.units.size(), factor.columns);
  if (factor.is_shape) check("is_shape: columns", static_cast<size_t>(factor.columns), factor.dim);
}

void copy_rates(std::span<const double>, std::span<const double> xi, std::span<double> out) {
  std::copy(xi.begin(), xi.end(), out.begin());
}

void add_slopes(std::span<const double>, std::span<const double> slope, std::span<double> out) {
  for (size_t i = 0; i < out.size(); ++i) out[i] += slope[i];
}

}  // namespace detail

GroupInfo product_info(const std::string& name, std::vector<GroupInfo> factors) {
  GroupInfo info;
  info.name = name;
  info.summary = "product of its factors, put together at run time";
  for (size_t i = 0; i < factors.size(); ++i) {
    info.dim += factors[i].dim;
    for (const std::string& column : factors[i].columns) {
      info.columns.push_back(fmt::format("{}_{}", i + 1, column));
    }
    info.identity.insert(info.identity.end(), factors[i].identity.begin(),
                         factors[i].identity.end());
    info.factors.insert(info.factors.end(), factors[i].factors.begin(), factors[i].factors.end());
  }
  info.element = [name, factors, count = info.columns.size()](std::span<const double> values) {
    if (values.size() != count) {
      throw std::invalid_argument(
          fmt::format("{}: {} values, expected {}", name, values.size(), count));
    }
    std::vector<double> out;
    for (const GroupInfo& factor : factors) {
      const auto part = factor.element(values.subspan(out.size(), factor.columns.size()));
      out.insert(out.end(), part.begin(), part.end());
    }
    return out;
  };
  info.matrices = [factors](std::span<const double> values) {
    std::vector<PlainMatrix> out;
    size_t at = 0;
    for (const GroupInfo& factor : factors) {
      for (auto& m : factor.matrices(values.subspan(at, factor.columns.size()))) out.push_back(m);
      at += factor.columns.size();
    }
    return out;
  };
  return info;
}

}  // namespace hamel
