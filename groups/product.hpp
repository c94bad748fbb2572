// Products of groups: G1 x G2 x ...
//
// Element: the tuple of the factors' elements (part<I>()).
// Algebra: the factors' coordinates one after another; Ad, ad, dR, dL are block diagonal.
// Columns carry the number of the factor where another has the same: 1_theta, x, y, 2_theta.
// A product offers every retraction that all its factors offer (product_retraction.hpp);
// cayley_literal where one has it, beside cayley on the others.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <hamel/framework/lie/coordinates.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/framework/lie/types.hpp>
#include <hamel/groups/retractions.hpp>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace hamel {

template <class T, class... Gs>
struct ProductElement {
  std::tuple<typename Gs::template Element<T>...> parts;

  bool operator==(const ProductElement&) const = default;
  /// The element of factor I = 0, 1, ...
  template <std::size_t I>
  auto& part() {
    return std::get<I>(parts);
  }
  template <std::size_t I>
  const auto& part() const {
    return std::get<I>(parts);
  }
};

template <class... Gs>
struct Product {
  static_assert(sizeof...(Gs) >= 1);
  static constexpr int dim = (Gs::dim + ...);
  template <class T>
  using Element = ProductElement<T, Gs...>;
  template <std::size_t I>
  using Factor = std::tuple_element_t<I, std::tuple<Gs...>>;
  /// The retractions that every factor has, and cayley_literal.
  using Retractions = typename Concatenate<
      std::conditional_t<(has_retraction<Gs, Exp<Gs>> && ...), TypeList<Exp<Product>>, TypeList<>>,
      std::conditional_t<(has_retraction<Gs, Cayley<Gs>> && ...), TypeList<Cayley<Product>>,
                         TypeList<>>,
      std::conditional_t<(has_retraction<Gs, Polar<Gs>> && ...), TypeList<Polar<Product>>,
                         TypeList<>>,
      std::conditional_t<(has_retraction<Gs, SecondKind<Gs>> && ...), TypeList<SecondKind<Product>>,
                         TypeList<>>,
      std::conditional_t<(has_retraction<Gs, SecondKindSymmetric<Gs>> && ...),
                         TypeList<SecondKindSymmetric<Product>>, TypeList<>>,
      std::conditional_t<(has_retraction<Gs, Cayley<Gs>> && ...) &&
                             (has_retraction<Gs, CayleyLiteral<Gs>> || ...),
                         TypeList<CayleyLiteral<Product>>, TypeList<>>>::type;

  /// Offsets of the factors' coordinates in the algebra.
  static constexpr std::array<int, sizeof...(Gs)> offsets = [] {
    std::array<int, sizeof...(Gs)> result{};
    const int dims[] = {Gs::dim...};
    for (std::size_t i = 1; i < sizeof...(Gs); ++i) result[i] = result[i - 1] + dims[i - 1];
    return result;
  }();

  /// f(index) for each factor, index a std::integral_constant.
  template <class Function>
  static void for_each_factor(Function&& f) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (f(std::integral_constant<std::size_t, I>{}), ...);
    }
    (std::index_sequence_for<Gs...>{});
  }
  /// The coordinates of factor I in a vector of the algebra or its dual.
  template <std::size_t I, class T>
  static VecT<T, Factor<I>::dim> segment(const VecT<T, dim>& v) {
    return v.template segment<Factor<I>::dim>(offsets[I]);
  }
  /// The block-diagonal matrix of block(index).
  template <class T, class Function>
  static MatT<T, dim, dim> block_diagonal(Function&& block) {
    MatT<T, dim, dim> m = MatT<T, dim, dim>::Zero();
    for_each_factor([&](auto i) {
      m.template block<Factor<i>::dim, Factor<i>::dim>(offsets[i], offsets[i]) = block(i);
    });
    return m;
  }

  static std::string name() {
    std::string text;
    const auto add = [&text](const std::string& factor) {
      if (!text.empty()) text += '*';
      text += factor;
    };
    (add(Gs::name()), ...);
    return text;
  }

  template <class T = double>
  static Element<T> identity() {
    return {{Gs::template identity<T>()...}};
  }
  template <class T>
  static Element<T> compose(const ProductElement<T, Gs...>& g, const ProductElement<T, Gs...>& h) {
    return each<T>(
        [&](auto i) { return Factor<i>::compose(g.template part<i>(), h.template part<i>()); });
  }
  template <class T>
  static Element<T> inverse(const ProductElement<T, Gs...>& g) {
    return each<T>([&](auto i) { return Factor<i>::inverse(g.template part<i>()); });
  }
  /// g over another scalar, its derivatives zero.
  template <class T>
  static Element<T> constant(const ProductElement<double, Gs...>& g) {
    return each<T>([&](auto i) { return constant_part<T, Factor<i>>(g.template part<i>()); });
  }
  /// g with its derivative along xi, as dual numbers, where the factors have it.
  template <class Dual>
  requires(requires(const typename Gs::template Element<double>& g, const Vec<Gs::dim>& xi) {
    Gs::template along<Dual>(g, xi);
  } && ...) static Element<Dual> along(const ProductElement<double, Gs...>& g, const Vec<dim>& xi) {
    return each<Dual>([&](auto i) {
      return Factor<i>::template along<Dual>(g.template part<i>(), segment<i>(xi));
    });
  }
  template <class T>
  static MatT<T, dim, dim> Ad(const ProductElement<T, Gs...>& g) {
    return block_diagonal<T>([&](auto i) { return Factor<i>::Ad(g.template part<i>()); });
  }
  template <class T>
  static MatT<T, dim, dim> ad(const VecT<T, dim>& xi) {
    return block_diagonal<T>([&](auto i) { return Factor<i>::ad(segment<i>(xi)); });
  }
  template <class T>
  static VecT<T, dim> Ad_transpose(const ProductElement<T, Gs...>& g, const VecT<T, dim>& mu) {
    VecT<T, dim> r;
    for_each_factor([&](auto i) {
      r.template segment<Factor<i>::dim>(offsets[i]) =
          Factor<i>::Ad_transpose(g.template part<i>(), segment<i>(mu));
    });
    return r;
  }
  template <class T>
  static MatT<T, dim, dim> coad(const VecT<T, dim>& mu) {
    return block_diagonal<T>([&](auto i) { return Factor<i>::coad(segment<i>(mu)); });
  }
  template <class T>
  static Element<T> normalise(const ProductElement<T, Gs...>& g) {
    return each<T>([&](auto i) { return Factor<i>::normalise(g.template part<i>()); });
  }
  /// The largest of the factors' defects.
  template <class T>
  static T defect(const ProductElement<T, Gs...>& g) {
    T largest(0.0);
    for_each_factor([&](auto i) {
      const T d = Factor<i>::defect(g.template part<i>());
      if (!(d <= largest)) largest = d;
    });
    return largest;
  }
  /// The largest of the factors' rotations; NaN where no factor rotates.
  static double rotation_angle(const ProductElement<double, Gs...>& g) {
    double largest = std::numeric_limits<double>::quiet_NaN();
    for_each_factor([&](auto i) {
      largest = std::fmax(largest, part_rotation<Factor<i>>(g.template part<i>()));
    });
    return largest;
  }

  /// The factors' matrices, and the block-diagonal matrix of them.
  template <class T>
  static auto matrices(const ProductElement<T, Gs...>& g) {
    std::vector<MatT<T, Eigen::Dynamic, Eigen::Dynamic>> result;
    for_each_factor([&](auto i) { result.emplace_back(Factor<i>::matrix(g.template part<i>())); });
    return result;
  }
  template <class T>
  static MatT<T, Eigen::Dynamic, Eigen::Dynamic> matrix(const ProductElement<T, Gs...>& g) {
    return assemble<T>(matrices(g));
  }
  /// The block-diagonal matrix of the factors' hats.
  template <class T>
  static MatT<T, Eigen::Dynamic, Eigen::Dynamic> hat(const VecT<T, dim>& xi) {
    std::vector<MatT<T, Eigen::Dynamic, Eigen::Dynamic>> blocks;
    for_each_factor([&](auto i) { blocks.emplace_back(Factor<i>::hat(segment<i>(xi))); });
    return assemble<T>(blocks);
  }

  static std::vector<std::string> columns() {
    std::vector<std::vector<std::string>> names;
    add_columns(names);
    return number_repeated(names);
  }
  /// The columns of each factor, of a product among them those of its own.
  static void add_columns(std::vector<std::vector<std::string>>& names) {
    (add_columns_of<Gs>(names), ...);
  }
  template <class T>
  static auto coordinates(const ProductElement<T, Gs...>& g) {
    Coordinates<T, (coordinate_count<Gs> + ...)> values;
    auto to = values.begin();
    for_each_factor([&](auto i) {
      const auto own = Factor<i>::coordinates(g.template part<i>());
      to = std::copy(own.begin(), own.end(), to);
    });
    return values;
  }
  /// The factors' values one after another. Throws std::invalid_argument.
  static Element<double> from_coordinates(std::span<const double> values) {
    check_coordinates<Product>(values);
    return each<double>([&](auto i) { return Factor<i>::from_coordinates(take<i>(values)); });
  }
  static Element<double> nearest(std::span<const double> values) {
    return each<double>([&](auto i) { return nearest_element<Factor<i>>(take<i>(values)); });
  }

  /// The element whose part I is part(index).
  template <class T, class Function>
  static Element<T> each(Function&& part) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      return Element<T>{std::tuple<typename Gs::template Element<T>...>{
          part(std::integral_constant<std::size_t, I>{})...}};  // braces: left to right
    }
    (std::index_sequence_for<Gs...>{});
  }

 private:
  /// The coordinates of factor I, taken off the front.
  template <std::size_t I>
  static std::span<const double> take(std::span<const double>& values) {
    constexpr std::size_t count = coordinate_count<Factor<I>>;
    const auto own = values.first(count);
    values = values.subspan(count);
    return own;
  }
  // Functions, since clang 14 takes a requires-expression in a generic lambda for false.
  template <class Group>
  static void add_columns_of(std::vector<std::vector<std::string>>& names) {
    if constexpr (requires { Group::add_columns(names); }) Group::add_columns(names);
    else names.push_back(Group::columns());
  }
  template <class Group, class Part>
  static double part_rotation([[maybe_unused]] const Part& g) {
    if constexpr (requires { Group::rotation_angle(g); }) return Group::rotation_angle(g);
    else return std::numeric_limits<double>::quiet_NaN();
  }
  template <class T, class Group, class Part>
  static typename Group::template Element<T> constant_part(const Part& g) {
    if constexpr (requires { g.template cast<T>(); }) return g.template cast<T>();
    else return Group::template constant<T>(g);
  }
  template <class T>
  static auto assemble(const std::vector<MatT<T, Eigen::Dynamic, Eigen::Dynamic>>& blocks) {
    Eigen::Index size = 0, at = 0;
    for (const auto& block : blocks) size += block.rows();
    MatT<T, Eigen::Dynamic, Eigen::Dynamic> m =
        MatT<T, Eigen::Dynamic, Eigen::Dynamic>::Zero(size, size);
    for (const auto& block : blocks) {
      m.block(at, at, block.rows(), block.cols()) = block;
      at += block.rows();
    }
    return m;
  }
};

/// Packed factor after factor, as in ProductGeometry.
template <class... Gs>
struct Packing<Product<Gs...>> {
  using G = Product<Gs...>;
  using Element = typename G::template Element<double>;
  static constexpr int size = (Packing<Gs>::size + ...);
  static Element load(const double* from) {
    return G::template each<double>([&](auto i) {
      using Part = Packing<typename G::template Factor<i>>;
      from += Part::size;
      return Part::load(from - Part::size);
    });
  }
  static void store(const Element& g, double* to) {
    G::for_each_factor([&](auto i) {
      using Part = Packing<typename G::template Factor<i>>;
      Part::store(g.template part<i>(), to);
      to += Part::size;
    });
  }
};

}  // namespace hamel
