// A group with its type erased, for reading, printing and describing elements.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/lie/concepts.hpp>

namespace hamel {

struct GroupInfo {
  std::string name;                  // "se2*so2"
  std::string summary;               // one line
  int dim = 0;                       // n
  std::vector<std::string> columns;  // of an element, as in the CSV
  std::vector<double> identity;      // the identity in those columns
  /// The nearest group element in coordinates; std::invalid_argument when values are not one.
  std::function<std::vector<double>(std::span<const double>)> element;
  /// Defining (or homogeneous) matrix; one for each factor of a product.
  std::function<std::vector<Eigen::MatrixXd>(std::span<const double>)> matrices;
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
  info.matrices = [](std::span<const double> values) -> std::vector<Eigen::MatrixXd> {
    const auto g = G::from_coordinates(values);
    if constexpr (requires { G::matrices(g); }) {
      return G::matrices(g);
    } else {
      return {G::matrix(g)};
    }
  };
  return info;
}

}  // namespace hamel
