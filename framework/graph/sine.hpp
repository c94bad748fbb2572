// Sine and cosine of a reduced angle over a scalar. Not installed.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <hamel/framework/graph/number.hpp>

namespace hamel::graph {

template <class T>
struct SineCosine {
  T sine, cosine;
};

/// c0 + z (c1 + z (c2 + ...)).
template <class T, size_t N>
T horner(const T& z, const std::array<double, N>& c) {
  T sum = c[N - 1];
  for (size_t i = N - 1; i-- > 0;) sum = T(c[i]) + z * sum;
  return sum;
}

/// sin x and cos x of |x| <= kLargestAngle, in rad (program.hpp).
template <class T>
SineCosine<T> sine_cosine(const T& x) {
  using std::abs;
  using std::rint;
  // pi/2 in three parts, the first two of 33 bits; polynomials on |r| <= pi/4: fdlibm,
  // e_rem_pio2.c, k_sin.c, k_cos.c.
  constexpr double kTwoOverPi = 6.36619772367581382433e-01;
  constexpr double kPart1 = 1.57079632673412561417e+00, kPart2 = 6.07710050630396597660e-11,
                   kPart3 = 2.02226624879595063154e-21;
  constexpr std::array<double, 6> kSine = {-1.66666666666666324348e-01, 8.33333333332248946124e-03,
                                           -1.98412698298579493134e-04, 2.75573137070700676789e-06,
                                           -2.50507602534068634195e-08, 1.58969099521155010221e-10};
  constexpr std::array<double, 6> kCosine = {
      4.16666666666666019037e-02,  -1.38888888888741095749e-03, 2.48015872894767294178e-05,
      -2.75573143513906633035e-07, 2.08757232129817482790e-09,  -1.13596475577881948265e-11};

  const T q = rint(x * T(kTwoOverPi));
  const T r = ((x - q * T(kPart1)) - q * T(kPart2)) - q * T(kPart3), z = r * r;
  const T sine = r + (r * z) * horner(z, kSine);
  const T half = T(0.5) * z,
          one = T(1) - half;  // (1 - half) - one: what the subtraction rounded off
  const T cosine = one + (((T(1) - one) - half) + (z * z) * horner(z, kCosine));

  const T quarter = q - T(4) * rint(T(0.25) * q);  // -2, -1, 0, 1, 2
  const auto odd = abs(quarter) == T(1);
  const T s = select(odd, cosine, sine), c = select(odd, sine, cosine);
  return {select(abs(quarter - T(0.5)) < T(1), s, -s), select(abs(quarter + T(0.5)) < T(1), c, -c)};
}

}  // namespace hamel::graph
