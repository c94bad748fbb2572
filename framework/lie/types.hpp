// Fixed-size linear algebra, named once.
//
// Vectors are columns. n is the dimension of the group, m = n - k the number of admissible directions.
#pragma once

#include <Eigen/Core>

/// Before a function on the hot path: everything it calls is inlined into it. Not under the sanitizers, where that
/// costs minutes of compilation.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HAMEL_FLATTEN
#else
#define HAMEL_FLATTEN [[gnu::flatten]]
#endif

namespace hamel {

/// Matrix and column vector over any scalar T (double, an automatic-differentiation number, ...).
template <class T, int Rows, int Cols>
using MatT = Eigen::Matrix<T, Rows, Cols>;
template <class T, int Rows>
using VecT = Eigen::Matrix<T, Rows, 1>;

/// The same over double.
template <int Rows, int Cols>
using Mat = MatT<double, Rows, Cols>;
template <int Rows>
using Vec = VecT<double, Rows>;

}  // namespace hamel
