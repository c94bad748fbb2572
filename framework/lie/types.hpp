// Fixed-size linear algebra, named once.
//
// Vectors are columns. n is the dimension of the group, m = n - k the number of admissible
// directions.
#pragma once

#include <cstddef>
#include <type_traits>

#include <Eigen/Core>

// A program may be compiled with other flags than the library (-march=native, -fsanitize=address,
// ...), which change how Eigen aligns and takes memory. So the library keeps its own copies of
// Eigen's functions (tools/cmake/localise), and no memory that Eigen took on one side is given back
// on the other. All that must be equal on both sides is in the name of a symbol: else the program
// does not link, and the name gives the reason.
static_assert(std::is_same_v<Eigen::Index, std::ptrdiff_t> && !Eigen::MatrixXd::IsRowMajor,
              "hamel needs Eigen as it is: without EIGEN_DEFAULT_TO_ROW_MAJOR and "
              "EIGEN_DEFAULT_DENSE_INDEX_TYPE");
#ifdef _GLIBCXX_DEBUG
#define HAMEL_CONTAINERS _and_GLIBCXX_DEBUG
#else
#define HAMEL_CONTAINERS
#endif
#define HAMEL_JOINED(text, world, major, containers) text##world##_##major##containers
#define HAMEL_JOIN(text, world, major, containers) HAMEL_JOINED(text, world, major, containers)
#define HAMEL_BUILT_WITH                                                            \
  HAMEL_JOIN(hamel_was_built_with_Eigen_, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, \
             HAMEL_CONTAINERS)
extern "C" const int HAMEL_BUILT_WITH;
namespace hamel {
[[gnu::used]] static const int* const built_with = &HAMEL_BUILT_WITH;
}

/// Before a function on the hot path: everything it calls is inlined into it. Not under the
/// sanitizers, where that costs minutes of compilation.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HAMEL_FLATTEN
#elif defined(__has_feature)  // clang
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HAMEL_FLATTEN
#endif
#endif
#ifndef HAMEL_FLATTEN
#define HAMEL_FLATTEN [[gnu::flatten]]
#endif

namespace hamel {

/// Matrix and column vector over any scalar T (double, an automatic-differentiation number, ...).
template <class T, int Rows, int Cols>
using MatT = Eigen::Matrix<T, Rows, Cols>;
template <class T, int Rows>
using VecT = Eigen::Matrix<T, Rows, 1>;

/// Matrix over double.
template <int Rows, int Cols>
using Mat = MatT<double, Rows, Cols>;
template <int Rows>
using Vec = VecT<double, Rows>;

}  // namespace hamel
