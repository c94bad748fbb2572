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
// which need d/dx of each coefficient. Below x = 5/2 (theta = 1.58) every function is a polynomial
// of 8 to 11 terms, in double the one of least relative error (at most 0.1 ulp beside rounding), so
// that a step needs no trigonometry and has one branch. The functions whose closed form cancels use
// a Taylor polynomial up to x = 8, and so do other scalars, whose derivatives are then as accurate.
// Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, III.4; minimax: J.-M. Muller,
// Elementary Functions (2016), ch. 3.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace hamel {

namespace detail {

inline constexpr double minimax_end = 2.5;  // x below this: a minimax polynomial (double)
inline constexpr double series_end = 8.0;   // x below this: the whole Taylor table

template <std::size_t Begin, std::size_t Count, std::size_t N, class T>
T estrin(const std::array<double, N>& a, const T* powers) {
  if constexpr (Count == 1) {
    return a[Begin];
  } else {
    constexpr std::size_t half = std::bit_floor(Count - 1);
    return estrin<Begin, half>(a, powers) +
           powers[std::bit_width(half) - 1] * estrin<Begin + half, Count - half>(a, powers);
  }
}

/// double, or one in each lane (lanes/lane.hpp)?
template <class T>
inline constexpr bool is_number = std::is_same_v<T, double> || requires {
  T::width;
};

/// a_0 + a_1 x + ... of the first Terms entries. Estrin's order for numbers (short chains),
/// Horner's otherwise.
template <std::size_t Terms, std::size_t N, class T>
T polynomial(const std::array<double, N>& a, const T& x) {
  static_assert(Terms <= N);
  if constexpr (is_number<T>) {
    T powers[6] = {x};
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

// On [0, minimax_end], by least squares of the relative error at 48 Chebyshev nodes in 60 digits,
// the coefficients rounded one after another.
inline constexpr std::array sinc_minimax = {1.0,
                                            -0.16666666666666666,
                                            0.008333333333333203,
                                            -0.0001984126984121049,
                                            2.7557319211143344e-06,
                                            -2.5052106859640324e-08,
                                            1.605893852436782e-10,
                                            -7.642950074668353e-13,
                                            2.720647385725127e-15};
inline constexpr std::array cosc_minimax = {0.5,
                                            -0.04166666666666639,
                                            0.0013888888888861266,
                                            -2.4801587292266195e-05,
                                            2.7557317723608366e-07,
                                            -2.087662727801868e-09,
                                            1.1464560740105588e-11,
                                            -4.6259513181768386e-14};
inline constexpr std::array sinc3_minimax = {
    0.16666666666666666,   -0.008333333333333182,   0.00019841269841197089, -2.7557319208094114e-06,
    2.505210652957334e-08, -1.6058920063950736e-10, 7.642434585973499e-13,  -2.714958840385713e-15};
inline constexpr std::array cosc_derivative_minimax = {
    -0.041666666666666664,   0.0027777777777777376,   -7.440476190455406e-05,
    1.1022927684711812e-06,  -1.0438377879839422e-08, 6.882403198605569e-11,
    -3.3438128532024804e-13, 1.2093784684732475e-15};
inline constexpr std::array sinc3_derivative_minimax = {
    -0.008333333333333333,  0.0003968253968253948, -8.26719576718546e-06,   1.0020843351770839e-07,
    -8.029521617839434e-10, 4.588276769712425e-12, -1.9671405228536096e-14, 6.38386949886703e-17};
inline constexpr std::array cotc_minimax = {
    0.08333333333333333,    0.001388888888889008,  3.306878306787455e-05,  8.267195799106448e-07,
    2.0876750811311115e-08, 5.284262062973228e-10, 1.3377294217285766e-11, 3.4136874393524657e-13,
    7.920341643340453e-15,  3.1733528842542723e-16};
inline constexpr std::array cotc_derivative_minimax = {
    0.001388888888888889,  6.6137566137567e-05,   2.480158730133722e-06, 8.350702810978175e-08,
    2.642094614634916e-09, 8.029593670306739e-11, 2.372103611429681e-12, 6.90716194076472e-14,
    1.828163342687711e-15, 7.832567339573188e-17};
inline constexpr std::array cotc_second_derivative_minimax = {
    6.613756613756614e-05, 4.960317460317312e-06,  2.50521083855877e-07,  1.0568380270722873e-08,
    4.014761127931825e-10, 1.4236631073237498e-11, 4.808455379507524e-13, 1.5642079512474243e-14,
    5.029765196867046e-16, 1.3476854714444395e-17, 7.349674978367518e-19};

/// The minimax polynomial below minimax_end (double), the Taylor table below series_end,
/// closed_form() above.
template <std::size_t M, std::size_t N, class T, class ClosedForm>
T tiered(const std::array<double, M>& minimax, const std::array<double, N>& table, const T& x,
         ClosedForm closed_form) {
  if constexpr (std::is_same_v<T, double>) {
    if (x < minimax_end) [[likely]] {
      return polynomial<M>(minimax, x);
    }
  }
  if (x < series_end) return polynomial<N>(table, x);
  return closed_form();
}

}  // namespace detail

/// sin(theta)/theta.
template <class T>
T sinc(const T& x) {
  using std::sin;
  using std::sqrt;
  return detail::tiered(detail::sinc_minimax, detail::sinc_table, x, [&]() -> T {
    const T theta = sqrt(x);
    return sin(theta) / theta;
  });
}

/// (1 - cos(theta))/theta^2.
template <class T>
T cosc(const T& x) {
  using std::sin;
  using std::sqrt;
  return detail::tiered(detail::cosc_minimax, detail::cosc_table, x, [&]() -> T {
    const T s = sin(0.5 * sqrt(x));
    return 2.0 * s * s / x;
  });
}

/// (theta - sin(theta))/theta^3 = (1 - sinc)/x.
template <class T>
T sinc3(const T& x) {
  return detail::tiered(detail::sinc3_minimax, detail::sinc3_table, x,
                        [&]() -> T { return (1.0 - sinc(x)) / x; });
}

/// d cosc/dx = (sinc - 2 cosc)/(2 x).
template <class T>
T cosc_derivative(const T& x) {
  return detail::tiered(detail::cosc_derivative_minimax, detail::cosc_derivative_table, x,
                        [&]() -> T { return 0.5 * (sinc(x) - 2.0 * cosc(x)) / x; });
}

/// d sinc3/dx = (cosc - 3 sinc3)/(2 x).
template <class T>
T sinc3_derivative(const T& x) {
  return detail::tiered(detail::sinc3_derivative_minimax, detail::sinc3_derivative_table, x,
                        [&]() -> T { return 0.5 * (cosc(x) - 3.0 * sinc3(x)) / x; });
}

/// (1 - gamma)/x with gamma = (theta/2) cot(theta/2); poles at theta = 2 pi, 4 pi, ...
template <class T>
T cotc(const T& x) {
  using std::sqrt;
  using std::tan;
  return detail::tiered(detail::cotc_minimax, detail::cotc_table, x, [&]() -> T {
    const T half = 0.5 * sqrt(x);
    return (1.0 - half / tan(half)) / x;
  });
}

/// d cotc/dx = (1/8 - gamma cotc/2 - cotc)/x.
template <class T>
T cotc_derivative(const T& x) {
  return detail::tiered(detail::cotc_derivative_minimax, detail::cotc_derivative_table, x,
                        [&]() -> T {
                          const T c = cotc(x);
                          return (0.125 - 0.5 * (1.0 - x * c) * c - c) / x;
                        });
}

/// d^2 cotc/dx^2 = -((gamma' cotc + gamma cotc')/2 + 2 cotc')/x with gamma' = gamma cotc/2 - 1/8.
template <class T>
T cotc_second_derivative(const T& x) {
  return detail::tiered(detail::cotc_second_derivative_minimax,
                        detail::cotc_second_derivative_table, x, [&]() -> T {
                          const T c = cotc(x), d = cotc_derivative(x), gamma = 1.0 - x * c;
                          return -(0.5 * ((0.5 * gamma * c - 0.125) * c + gamma * d) + 2.0 * d) / x;
                        });
}

/// Coefficients of tau and dtau^-1 of one vector, evaluated together: one branch, powers of x once.
template <class T>
struct ExpCoefficients {
  T sinc, cosc, sinc3, cotc, cotc_derivative;

  static ExpCoefficients at(const T& x) {
    if constexpr (std::is_same_v<T, double>) {
      using namespace detail;
      if (x < minimax_end) [[likely]] {
        return {polynomial<sinc_minimax.size()>(sinc_minimax, x),
                polynomial<cosc_minimax.size()>(cosc_minimax, x),
                polynomial<sinc3_minimax.size()>(sinc3_minimax, x),
                polynomial<cotc_minimax.size()>(cotc_minimax, x),
                polynomial<cotc_derivative_minimax.size()>(cotc_derivative_minimax, x)};
      }
    }
    return beyond(x);
  }

 private:
  [[gnu::noinline, gnu::cold]] static ExpCoefficients beyond(const T& x) {
    return {hamel::sinc(x), hamel::cosc(x), hamel::sinc3(x), hamel::cotc(x),
            hamel::cotc_derivative(x)};
  }
};

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
