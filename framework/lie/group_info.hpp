// A group with its type erased, for reading, printing and describing elements.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/lie/concepts.hpp>
#include <hamel/framework/lie/coordinates.hpp>

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

/// A linear map at the element with coordinates x; out has the size of the result.
using MapAt = void (*)(std::span<const double> x, std::span<const double> v, std::span<double> out);

/// A group that is no product, by what it states of its velocities and coordinates
/// (group_defaults.hpp).
struct GroupFactor {
  std::string name;  // "se2"
  int dim = 0, columns = 0;
  std::vector<std::string> names = {};     // of the columns
  std::vector<Component> components = {};  // of the body velocity; empty: not stated
  std::vector<std::string> units = {};     // of the columns; empty: not stated
  bool is_shape = false;                   // its coordinates are the integrals of its components
  MapAt coordinate_rates = nullptr;        // out = C(g) xi; null: not stated
  MapAt add_pulled_back = nullptr;         // out += C(g)^T slope
};

struct GroupInfo {
  std::string name;                  // "se2*so2"
  std::string summary;               // one line
  std::string formula, source;       // what an element is, and who writes so
  int dim = 0;                       // n
  std::vector<std::string> columns;  // of an element, as in the CSV
  std::vector<double> identity;      // the identity in those columns
  /// The nearest group element in coordinates; std::invalid_argument when values are not one.
  std::function<std::vector<double>(std::span<const double>)> element;
  /// Defining (or homogeneous) matrix; one for each factor of a product.
  std::function<std::vector<PlainMatrix>(std::span<const double>)> matrices;
  /// The group itself, or the factors of a product.
  std::vector<GroupFactor> factors;
};

/// group.element of these values; std::invalid_argument with the group's columns where they are not
/// as many, or not finite.
std::vector<double> element_of(const GroupInfo& group, std::span<const double> values);

/// The product of groups, factor after factor.
GroupInfo product_info(const std::string& name, std::vector<GroupInfo> factors);

namespace detail {

// Throws std::invalid_argument where the number of components or units is wrong.
void check_factor(const GroupFactor& factor);

// The maps of a group whose coordinates are the integrals of its components.
void copy_rates(std::span<const double> x, std::span<const double> xi, std::span<double> out);
void add_slopes(std::span<const double> x, std::span<const double> slope, std::span<double> out);

template <class G>
constexpr bool states_rates() {
  constexpr bool rates = requires(std::span<const double> x, std::span<double> out) {
    G::coordinate_rates(x, x, out);
  };
  constexpr bool slopes = requires(std::span<const double> x, std::span<double> out) {
    G::add_pulled_back(x, x, out);
  };
  static_assert(
      rates || !requires { &G::coordinate_rates; },
      "coordinate_rates of this group cannot be called: expected static "
      "coordinate_rates(std::span<const double> x, xi, std::span<double> out)");
  static_assert(
      slopes || !requires { &G::add_pulled_back; },
      "add_pulled_back of this group cannot be called: expected static "
      "add_pulled_back(std::span<const double> x, slope, std::span<double> out)");
  static_assert(rates == slopes, "coordinate_rates and add_pulled_back of a group go together");
  return rates;
}

template <class G>
GroupFactor factor_of() {
  using Given = std::span<const double>;
  GroupFactor out{G::name(), G::dim, static_cast<int>(coordinate_count<G>), G::columns()};
  if constexpr (requires { G::components(); }) out.components = G::components();
  if constexpr (requires { G::units(); }) out.units = G::units();
  if constexpr (requires { G::is_shape; }) out.is_shape = G::is_shape;
  if constexpr (states_rates<G>()) {
    out.coordinate_rates = [](Given x, Given xi, std::span<double> to) {
      G::coordinate_rates(x, xi, to);
    };
    out.add_pulled_back = [](Given x, Given slope, std::span<double> to) {
      G::add_pulled_back(x, slope, to);
    };
  } else if (out.is_shape) {
    out.coordinate_rates = copy_rates;
    out.add_pulled_back = add_slopes;
  }
  check_factor(out);
  return out;
}

template <class G>
std::vector<GroupFactor> factors_of() {
  if constexpr (requires { typename G::template Factor<0>; }) {
    std::vector<GroupFactor> out;
    G::for_each_factor([&out](auto i) {
      for (GroupFactor& factor : factors_of<typename G::template Factor<i>>())
        out.push_back(std::move(factor));
    });
    return out;
  } else {
    return {factor_of<G>()};
  }
}

template <class G>
GroupInfo erased_group() {
  GroupInfo info;
  info.name = G::name();
  if constexpr (requires { G::summary(); }) info.summary = G::summary();
  if constexpr (requires { G::formula(); }) info.formula = G::formula();
  if constexpr (requires { G::source(); }) info.source = G::source();
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
  info.factors = detail::factors_of<G>();
  return info;
}

}  // namespace detail

/// Erases G. Specialised where a library has it compiled.
template <Group G>
GroupInfo group_info() {
  return detail::erased_group<G>();
}

}  // namespace hamel
