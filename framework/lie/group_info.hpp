// A group with its type erased, for reading, printing and describing elements.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/lie/concepts.hpp>

namespace hamel {

/// A matrix as plain numbers.
struct PlainMatrix {
  long rows = 0, columns = 0;
  std::vector<double> values = {};  // row after row
  explicit PlainMatrix(const Eigen::Ref<const Eigen::MatrixXd>& m)
      : rows(m.rows()), columns(m.cols()) {
    for (long i = 0; i < rows; ++i)
      for (long j = 0; j < columns; ++j) values.push_back(m(i, j));
  }
  double operator()(long i, long j) const { return values[static_cast<size_t>(i * columns + j)]; }
};

struct GroupInfo {
  std::string name;                  // "se2*so2"
  std::string summary;               // one line
  int dim = 0;                       // n
  std::vector<std::string> columns;  // of an element, as in the CSV
  std::vector<double> identity;      // the identity in those columns
  /// The nearest group element in coordinates; std::invalid_argument when values are not one.
  std::function<std::vector<double>(std::span<const double>)> element;
  /// Defining (or homogeneous) matrix; one for each factor of a product.
  std::function<std::vector<PlainMatrix>(std::span<const double>)> matrices;
};

/// The product of groups, factor after factor; columns carry the number of the factor.
GroupInfo product_info(const std::string& name, std::vector<GroupInfo> factors);

/// Erases G.
template <Group G>
GroupInfo group_info() {
  GroupInfo info;
  info.name = G::name();
  if constexpr (requires { G::summary(); }) info.summary = G::summary();
  info.dim = G::dim;
  info.columns = G::columns();
  info.identity = G::coordinates(G::template identity<double>());
  info.element = [](std::span<const double> values) {
    return G::coordinates(G::from_coordinates(values));
  };
  info.matrices = [](std::span<const double> values) {
    const auto g = G::from_coordinates(values);
    std::vector<PlainMatrix> out;
    if constexpr (requires { G::matrices(g); }) {
      for (const auto& factor : G::matrices(g)) out.emplace_back(factor);
    } else {
      out.emplace_back(G::matrix(g));
    }
    return out;
  };
  return info;
}

}  // namespace hamel
