// The scalar coefficients of exp and dexp, as functions of x = theta^2, without cancellation.
//
//   sinc(x)  = sin(theta)/theta
//   cosc(x)  = (1 - cos(theta))/theta^2
//   sinc3(x) = (theta - sin(theta))/theta^3
//   cotc(x)  = (1 - (theta/2) cot(theta/2))/theta^2 = sum_k |B_2k|/(2k)! x^(k-1)
// With W = ad_omega on so(3), where W^3 = -x W (on se(2) likewise, x = omega^2):
//   exp(W)      = I + sinc W + cosc W^2
//   dR exp      = I + cosc W + sinc3 W^2
//   (dR exp)^-1 = I - W/2 + cotc W^2
// SE(3) is SO(3) over the dual numbers: its lower left blocks are derivatives of these along v,
// which need d/dx of each coefficient. Below x = 1/4 (theta = 1/2) every function is a Taylor
// polynomial whose truncation is below one ulp, so that a typical step needs no trigonometry. The
// functions whose closed form cancels use a longer polynomial up to x = 8. Source: Hairer, Lubich,
// Wanner, Geometric Numerical Integration, III.4.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace hamel {

namespace detail {

inline constexpr double short_series = 0.25;  // x below this: 8 or 9 terms
inline constexpr double long_series = 8.0;    // x below this: the whole table

template <std::size_t Begin, std::size_t Count, std::size_t N>
double estrin(const std::array<double, N>& a, const double* powers) {
  if constexpr (Count == 1) {
    return a[Begin];
  } else {
    constexpr std::size_t half = std::bit_floor(Count - 1);
    return estrin<Begin, half>(a, powers) +
           powers[std::bit_width(half) - 1] * estrin<Begin + half, Count - half>(a, powers);
  }
}

/// a_0 + a_1 x + ... of the first Terms entries. Estrin's order for double (short chains), Horner's
/// otherwise.
template <std::size_t Terms, std::size_t N, class T>
T polynomial(const std::array<double, N>& a, const T& x) {
  static_assert(Terms <= N);
  if constexpr (std::is_same_v<T, double>) {
    double powers[6] = {x};
    for (std::size_t i = 1; i < std::bit_width(Terms - 1); ++i) {
      powers[i] = powers[i - 1] * powers[i - 1];
    }
    return estrin<0, Terms>(a, powers);
  } else {
    T r(a[Terms - 1]);
    for (std::size_t i = Terms - 1; i-- > 0;) r = r * x + a[i];
    return r;
  }
}

/// (-1)^k/(2k + Shift)!, k = 0, 1, ...
template <int Shift>
constexpr std::array<double, 18> alternating_factorials() {
  std::array<double, 18> a{};
  long double factorial = 1;
  for (int i = 2; i <= Shift; ++i) factorial *= i;
  for (int k = 0; k < 18; ++k) {
    a[static_cast<std::size_t>(k)] = static_cast<double>((k % 2 == 0 ? 1 : -1) / factorial);
    factorial *= static_cast<long double>(2 * k + Shift + 1) * (2 * k + Shift + 2);
  }
  return a;
}

/// Coefficients of the derivative of a polynomial.
template <std::size_t N>
constexpr std::array<double, N - 1> differentiate(const std::array<double, N>& a) {
  std::array<double, N - 1> d{};
  for (std::size_t k = 1; k < N; ++k) d[k - 1] = a[k] * static_cast<double>(k);
  return d;
}

inline constexpr auto sinc_table = alternating_factorials<1>();
inline constexpr auto cosc_table = alternating_factorials<2>();
inline constexpr auto sinc3_table = alternating_factorials<3>();
inline constexpr auto cosc_derivative_table = differentiate(cosc_table);
inline constexpr auto sinc3_derivative_table = differentiate(sinc3_table);
/// |B_2k|/(2k)!, k = 1, 2, ..., from exact fractions.
inline constexpr std::array<double, 30> cotc_table = {
    0.08333333333333333,    0.001388888888888889,   3.306878306878307e-05,  8.267195767195768e-07,
    2.08767569878681e-08,   5.284190138687493e-10,  1.3382536530684679e-11, 3.3896802963225827e-13,
    8.586062056277845e-15,  2.174868698558062e-16,  5.5090028283602295e-18, 1.3954464685812522e-19,
    3.534707039629467e-21,  8.953517427037546e-23,  2.267952452337683e-24,  5.744790668872202e-26,
    1.455172475614865e-27,  3.6859949406653103e-29, 9.336734257095045e-31,  2.36502241570063e-32,
    5.990671762482134e-34,  1.5174548844682903e-35, 3.843758125454189e-37,  9.736353072646691e-39,
    2.466247044200681e-40,  6.247076741820743e-42,  1.5824030244644914e-43, 4.008273685948936e-45,
    1.0153075855569557e-46, 2.5718041582418717e-48};
inline constexpr auto cotc_derivative_table = differentiate(cotc_table);
inline constexpr auto cotc_second_derivative_table = differentiate(cotc_derivative_table);

/// 8 terms below short_series, the whole table below long_series, closed_form() above.
template <std::size_t N, class T, class ClosedForm>
T tiered(const std::array<double, N>& table, const T& x, ClosedForm closed_form) {
  constexpr std::size_t terms = N == 28 ? 9 : 8;  // second derivatives converge more slowly
  if (x < short_series) [[likely]] {
    return polynomial<terms>(table, x);
  }
  if (x < long_series) return polynomial<N>(table, x);
  return closed_form();
}

}  // namespace detail

/// sin(theta)/theta.
template <class T>
T sinc(const T& x) {
  using std::sin;
  using std::sqrt;
  if (x < detail::short_series) [[likely]] {
    return detail::polynomial<8>(detail::sinc_table, x);
  }
  const T theta = sqrt(x);
  return sin(theta) / theta;
}

/// (1 - cos(theta))/theta^2.
template <class T>
T cosc(const T& x) {
  using std::sin;
  using std::sqrt;
  if (x < detail::short_series) [[likely]] {
    return detail::polynomial<8>(detail::cosc_table, x);
  }
  const T s = sin(0.5 * sqrt(x));
  return 2.0 * s * s / x;
}

/// (theta - sin(theta))/theta^3 = (1 - sinc)/x.
template <class T>
T sinc3(const T& x) {
  return detail::tiered(detail::sinc3_table, x, [&]() -> T { return (1.0 - sinc(x)) / x; });
}

/// d cosc/dx = (sinc - 2 cosc)/(2 x).
template <class T>
T cosc_derivative(const T& x) {
  return detail::tiered(detail::cosc_derivative_table, x,
                        [&]() -> T { return 0.5 * (sinc(x) - 2.0 * cosc(x)) / x; });
}

/// d sinc3/dx = (cosc - 3 sinc3)/(2 x).
template <class T>
T sinc3_derivative(const T& x) {
  return detail::tiered(detail::sinc3_derivative_table, x,
                        [&]() -> T { return 0.5 * (cosc(x) - 3.0 * sinc3(x)) / x; });
}

/// (1 - gamma)/x with gamma = (theta/2) cot(theta/2); poles at theta = 2 pi, 4 pi, ...
template <class T>
T cotc(const T& x) {
  using std::sqrt;
  using std::tan;
  return detail::tiered(detail::cotc_table, x, [&]() -> T {
    const T half = 0.5 * sqrt(x);
    return (1.0 - half / tan(half)) / x;
  });
}

/// d cotc/dx = (1/8 - gamma cotc/2 - cotc)/x.
template <class T>
T cotc_derivative(const T& x) {
  return detail::tiered(detail::cotc_derivative_table, x, [&]() -> T {
    const T c = cotc(x);
    return (0.125 - 0.5 * (1.0 - x * c) * c - c) / x;
  });
}

/// d^2 cotc/dx^2 = -((gamma' cotc + gamma cotc')/2 + 2 cotc')/x with gamma' = gamma cotc/2 - 1/8.
template <class T>
T cotc_second_derivative(const T& x) {
  return detail::tiered(detail::cotc_second_derivative_table, x, [&]() -> T {
    const T c = cotc(x), d = cotc_derivative(x), gamma = 1.0 - x * c;
    return -(0.5 * ((0.5 * gamma * c - 0.125) * c + gamma * d) + 2.0 * d) / x;
  });
}

/// atan(u)/u as a function of y = u^2.
template <class T>
T atanc(const T& y) {
  using std::atan;
  using std::sqrt;
  if (y < 1e-2) {  // sum (-y)^k/(2k + 1), truncated below 1e-17
    T r(1.0 / 17);
    for (int k = 7; k >= 0; --k) r = 1.0 / (2 * k + 1) - y * r;
    return r;
  }
  const T u = sqrt(y);
  return atan(u) / u;
}

}  // namespace hamel
