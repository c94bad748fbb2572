// Parts of C++20 that libc++ 13, of emscripten 3.1.6, lacks, as far as this project uses
// them. Force-included in every source of the build for WebAssembly, and in nothing else.
#pragma once

#if defined(__cplusplus) && __cplusplus > 201703L

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

namespace std {
namespace ranges {

// Range forms of the algorithms, with projections where the project uses them.
struct Less {
  template <class A, class B>
  constexpr bool operator()(const A& a, const B& b) const {
    return a < b;
  }
};
template <class R, class T, class P = identity>
constexpr auto find(R&& range, const T& value, P of = {}) {
  return std::find_if(std::begin(range), std::end(range),
                      [&](auto&& e) -> bool { return std::invoke(of, e) == value; });
}
template <class R, class F, class P = identity>
constexpr auto find_if(R&& range, F f, P of = {}) {
  return std::find_if(std::begin(range), std::end(range),
                      [&](auto&& e) -> bool { return std::invoke(f, std::invoke(of, e)); });
}
template <class R, class F, class P = identity>
constexpr bool any_of(R&& range, F f, P of = {}) {
  return ranges::find_if(range, f, of) != std::end(range);
}
template <class R, class F, class P = identity>
constexpr bool none_of(R&& range, F f, P of = {}) {
  return !ranges::any_of(range, f, of);
}
template <class R, class F, class P = identity>
constexpr bool all_of(R&& range, F f, P of = {}) {
  return std::all_of(std::begin(range), std::end(range),
                     [&](auto&& e) -> bool { return std::invoke(f, std::invoke(of, e)); });
}
template <class R, class F, class P = identity>
constexpr auto count_if(R&& range, F f, P of = {}) {
  return std::count_if(std::begin(range), std::end(range),
                       [&](auto&& e) -> bool { return std::invoke(f, std::invoke(of, e)); });
}
template <class R, class T, class P = identity>
constexpr auto count(R&& range, const T& value, P of = {}) {
  return ranges::count_if(
      range, [&](auto&& e) -> bool { return e == value; }, of);
}
template <class R, class C = Less, class P = identity>
constexpr auto sort(R&& range, C before = {}, P of = {}) {
  std::sort(std::begin(range), std::end(range), [&](auto&& a, auto&& b) -> bool {
    return std::invoke(before, std::invoke(of, a), std::invoke(of, b));
  });
  return std::end(range);
}
template <class R, class C = Less, class P = identity>
auto stable_sort(R&& range, C before = {}, P of = {}) {
  std::stable_sort(std::begin(range), std::end(range), [&](auto&& a, auto&& b) -> bool {
    return std::invoke(before, std::invoke(of, a), std::invoke(of, b));
  });
  return std::end(range);
}
template <class R, class C = Less, class P = identity>
constexpr auto max_element(R&& range, C before = {}, P of = {}) {
  return std::max_element(std::begin(range), std::end(range), [&](auto&& a, auto&& b) -> bool {
    return std::invoke(before, std::invoke(of, a), std::invoke(of, b));
  });
}
template <class R, class C = Less, class P = identity>
constexpr auto min_element(R&& range, C before = {}, P of = {}) {
  return std::min_element(std::begin(range), std::end(range), [&](auto&& a, auto&& b) -> bool {
    return std::invoke(before, std::invoke(of, a), std::invoke(of, b));
  });
}
template <class A, class B, class F = std::equal_to<>>
constexpr bool equal(A&& a, B&& b, F same = {}) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b), same);
}
template <class R, class T, class C = Less, class P = identity>
constexpr auto lower_bound(R&& range, const T& value, C before = {}, P of = {}) {
  return std::lower_bound(
      std::begin(range), std::end(range), value,
      [&](auto&& e, const auto& v) -> bool { return std::invoke(before, std::invoke(of, e), v); });
}
template <class R, class T>
constexpr bool binary_search(R&& range, const T& value) {
  return std::binary_search(std::begin(range), std::end(range), value);
}
template <class T>
struct MinMax {
  T min, max;
};
template <class R>
constexpr auto minmax(R&& range) {
  const auto both = std::minmax_element(std::begin(range), std::end(range));
  return MinMax<std::decay_t<decltype(*both.first)>>{*both.first, *both.second};
}
template <class R, class O>
constexpr auto move(R&& range, O out) {
  return std::move(std::begin(range), std::end(range), out);
}
template <class R, class O>
constexpr auto copy(R&& range, O out) {
  return std::copy(std::begin(range), std::end(range), out);
}
template <class R, class O, class F>
constexpr auto copy_if(R&& range, O out, F f) {
  return std::copy_if(std::begin(range), std::end(range), out, f);
}
template <class R, class T>
constexpr void fill(R&& range, const T& value) {
  std::fill(std::begin(range), std::end(range), value);
}
template <class R, class T>
constexpr void replace(R&& range, const T& value, const T& other) {
  std::replace(std::begin(range), std::end(range), value, other);
}
template <class R>
constexpr auto reverse(R&& range) {
  std::reverse(std::begin(range), std::end(range));
  return std::end(range);
}
template <class A, class B, class O>
constexpr auto set_intersection(A&& a, B&& b, O out) {
  return std::set_intersection(std::begin(a), std::end(a), std::begin(b), std::end(b), out);
}

}  // namespace ranges

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

// Decimal numbers: no leading space or plus, no hexadecimal.
inline from_chars_result from_chars(const char* first, const char* last, double& out,
                                    chars_format = chars_format::general) {
  std::string text(first, last);
  const bool skipped =
      text.empty() || isspace(static_cast<unsigned char>(text[0])) != 0 || text[0] == '+';
  if (skipped) return {first, errc::invalid_argument};
  if (const size_t x = text.find_first_of("xX"); x != std::string::npos) text.resize(x);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  const char* const behind = first + (end - text.c_str());
  const bool named = text.find_first_of("iI") != std::string::npos;
  if (std::isinf(value) && !named) return {behind, errc::result_out_of_range};
  out = value;
  return {behind, errc{}};
}
inline to_chars_result to_chars(char* first, char* last, double value, chars_format,
                                int precision) {
  char text[64];
  const int size = std::snprintf(text, sizeof text, "%.*g", precision, value);
  if (size > last - first) return {last, errc::value_too_large};
  std::memcpy(first, text, static_cast<size_t>(size));
  return {first + size, errc{}};
}

// Without threads: the work at once, in the caller.
class jthread {
 public:
  jthread() = default;
  template <class F, class... A>
  explicit jthread(F&& f, A&&... arguments) {
    std::invoke(std::forward<F>(f), std::forward<A>(arguments)...);
  }
  jthread(jthread&&) = default;
  jthread& operator=(jthread&&) = default;
  void join() {}
  bool joinable() const { return false; }
};

}  // namespace std

#endif
