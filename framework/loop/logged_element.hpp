// Elements of a group in a log of states (StateLog), as a step has them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

namespace hamel {

/// Elements whose sizes are known at run time are logged in their own layout.
template <class P>
inline constexpr bool logged_as_it_is = std::is_same_v<typename P::Element, Eigen::VectorXd>;

template <class P>
std::size_t logged_size(const P& problem, const typename P::Element& g) {
  if constexpr (logged_as_it_is<P>) return static_cast<std::size_t>(g.size());
  else return static_cast<std::size_t>(problem.element_size());
}
template <class P>
void log_element(const P& problem, const typename P::Element& g, double* to) {
  if constexpr (logged_as_it_is<P>) std::copy_n(g.data(), g.size(), to);
  else problem.store(g, to);
}
template <class P>
void load_element(const P& problem, const double* from, typename P::Element& g) {
  if constexpr (logged_as_it_is<P>) std::copy_n(from, g.size(), g.data());
  else problem.load(from, g);
}

/// Do its coordinates tell it, as those of an angle of 1e9 rad do not? coordinates: work space.
template <class P>
bool is_element(const P& problem, const typename P::Element& g, std::vector<double>& coordinates) {
  coordinates.resize(static_cast<std::size_t>(problem.columns()));
  problem.coordinates(g, coordinates.data());
  double largest = 0;
  for (const double x : coordinates) largest += std::abs(x);
  if (largest < 1e9 && problem.defect(g) < 1e-7) return true;  // bounds of every group
  try {
    typename P::Element read = problem.element();
    problem.from_coordinates(coordinates, read);
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

}  // namespace hamel
