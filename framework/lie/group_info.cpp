#include <hamel/framework/lie/group_info.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

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
  check("columns", factor.names.size(), factor.columns);
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

std::vector<std::string> number_repeated(const std::vector<std::vector<std::string>>& factors) {
  std::map<std::string, int> count;
  for (const std::vector<std::string>& names : factors)
    for (const std::string& name : names) ++count[name];
  std::vector<std::string> out;
  for (size_t i = 0; i < factors.size(); ++i)
    for (const std::string& name : factors[i])
      out.push_back(count[name] > 1 ? fmt::format("{}_{}", i + 1, name) : name);
  return out;
}

std::vector<double> element_of(const GroupInfo& group, std::span<const double> values) {
  if (values.size() != group.columns.size())
    throw std::invalid_argument(fmt::format("{}: {} values, expected {} ({})", group.name,
                                            values.size(), group.columns.size(),
                                            fmt::join(group.columns, ", ")));
  for (size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw std::invalid_argument(fmt::format("{}: {} = {}, expected a finite number", group.name,
                                              group.columns[i], to_text(values[i])));
  return group.element(values);
}

GroupInfo product_info(const std::string& name, std::vector<GroupInfo> factors) {
  GroupInfo info;
  info.name = name;
  info.summary = "product of its factors, put together at run time";
  for (const GroupInfo& factor : factors) {
    info.dim += factor.dim;
    info.identity.insert(info.identity.end(), factor.identity.begin(), factor.identity.end());
    info.factors.insert(info.factors.end(), factor.factors.begin(), factor.factors.end());
  }
  std::vector<std::vector<std::string>> names;
  for (const GroupFactor& factor : info.factors) names.push_back(factor.names);
  info.columns = number_repeated(names);
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
