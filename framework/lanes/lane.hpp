// A scalar that holds one number of each of W bodies: a SIMD register.
//
// The templates of groups, retractions, problems and steps take it for double. Each lane has the
// sums, products and quotients of double in the same order, without fused operations (these units
// are compiled with -ffp-contract=off), and so the same bits. A comparison is of all lanes at once;
// lanes that differ are distinguished by masks (where, all_of). Needs xsimd (libxsimd-dev).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include <xsimd/xsimd.hpp>

namespace hamel {

/// Arch: xsimd::sse2, xsimd::avx2, ...
template <class Arch>
struct Lane {
  using Batch = xsimd::batch<double, Arch>;
  using Mask = typename Batch::batch_bool_type;
  static constexpr int width = static_cast<int>(Batch::size);
  Batch v;

  Lane() = default;
  Lane(const Batch& batch) : v(batch) {}  // NOLINT(google-explicit-constructor)
  Lane(double x) : v(x) {}                // NOLINT(google-explicit-constructor)

  Lane& operator+=(const Lane& b) { return *this = *this + b; }
  Lane& operator-=(const Lane& b) { return *this = *this - b; }
  Lane& operator*=(const Lane& b) { return *this = *this * b; }
  Lane& operator/=(const Lane& b) { return *this = *this / b; }
  Lane operator-() const { return -v; }
  friend Lane operator+(const Lane& a, const Lane& b) { return a.v + b.v; }
  friend Lane operator-(const Lane& a, const Lane& b) { return a.v - b.v; }
  friend Lane operator*(const Lane& a, const Lane& b) { return a.v * b.v; }
  friend Lane operator/(const Lane& a, const Lane& b) { return a.v / b.v; }
  friend Mask below(const Lane& a, const Lane& b) { return a.v < b.v; }
  friend Mask at_most(const Lane& a, const Lane& b) { return a.v <= b.v; }
  /// a where the mask is true, else b.
  friend Lane select(const Mask& mask, const Lane& a, const Lane& b) {
    return xsimd::select(mask, a.v, b.v);
  }
  /// In all lanes?
  friend bool operator==(const Lane& a, const Lane& b) { return xsimd::all(a.v == b.v); }
  /// 1 or 0 in each lane.
  friend Lane less(const Lane& a, const Lane& b) {
    return xsimd::select(a.v < b.v, Batch(1.0), Batch(0.0));
  }
  friend Lane equal(const Lane& a, const Lane& b) {
    return xsimd::select(a.v == b.v, Batch(1.0), Batch(0.0));
  }
  friend Lane sqrt(const Lane& a) { return xsimd::sqrt(a.v); }

  /// The number of one lane.
  double get(int lane) const { return reinterpret_cast<const double*>(&v)[lane]; }
  void set(int lane, double x) { reinterpret_cast<double*>(&v)[lane] = x; }
};

/// A mask's truth in one lane.
template <class T>
bool get_lane(const typename T::Mask& mask, int lane) {
  alignas(64) bool all[T::width];
  mask.store_aligned(all);
  return all[lane];
}
template <class T>
void set_lane(typename T::Mask& mask, int lane, bool truth) {
  alignas(64) bool all[T::width];
  mask.store_aligned(all);
  all[lane] = truth;
  mask = T::Mask::load_aligned(all);
}

/// Lanes that are not finite are looked for by a batch, at the end of a step.
template <class Arch, int N>
constexpr bool all_finite(const Eigen::Matrix<Lane<Arch>, N, 1>& /*x*/) {
  return true;
}

/// visit(number of a, number of b) for each number of two elements, nodes' parts or matrices of one
/// kind over different scalars.
template <class A, class B, class Visit>
void each_number(A& a, B& b, const Visit& visit) {
  if constexpr (requires { a.coeff(0, 0); }) {
    for (Eigen::Index i = 0; i < a.size(); ++i) visit(a.data()[i], b.data()[i]);
  } else if constexpr (requires { a.turns; }) {
    visit(a.c, b.c);
    visit(a.s, b.s);
    visit(a.turns, b.turns);
  } else if constexpr (requires { a.translation; }) {
    each_number(a.rotation, b.rotation, visit);
    each_number(a.translation, b.translation, visit);
  } else {
    std::apply(
        [&](auto&... parts_of_a) {
          std::apply(
              [&](auto&... parts_of_b) { (each_number(parts_of_a, parts_of_b, visit), ...); },
              b.parts);
        },
        a.parts);
  }
}
/// The numbers of one body into a lane, and back.
template <class A, class B>
void put_lane(A& lanes, int lane, const B& one) {
  each_number(lanes, one,
              [lane](auto& to, const auto& from) { to.set(lane, static_cast<double>(from)); });
}
template <class A, class B>
void get_lane(const A& lanes, int lane, B& one) {
  each_number(lanes, one, [lane](const auto& from, auto& to) {
    to = static_cast<std::remove_reference_t<decltype(to)>>(from.get(lane));
  });
}

/// one(x) into the lanes of `out` that the mask leaves out, x the lane's number.
template <class Arch, class Out, class One>
[[gnu::noinline, gnu::cold]] void put_others(const typename Lane<Arch>::Mask& mask,
                                             const Lane<Arch>& x, Out& out, const One& one) {
  for (int lane = 0; lane < Lane<Arch>::width; ++lane)
    if (!get_lane<Lane<Arch>>(mask, lane)) put_lane(out, lane, one(x.get(lane)));
}

/// Bodies of one type, whose members are joined over them.
template <class One>
class EachBody {
 public:
  explicit EachBody(std::vector<const One*> bodies) : bodies_(std::move(bodies)) {}
  /// count of them, from the one with that index.
  EachBody(std::span<const One* const> bodies, int first, int count)
      : bodies_(bodies.begin() + first, bodies.begin() + first + count) {}
  const One& first() const { return *bodies_.front(); }
  template <class Part, class Out>
  void operator()(Part One::*member, Out& out) const {
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      put_lane(out, static_cast<int>(i), bodies_[i]->*member);
  }
  template <class Part>
  EachBody<Part> of(Part One::*member) const {
    std::vector<const Part*> parts;
    for (const One* body : bodies_) parts.push_back(&(body->*member));
    return EachBody<Part>(std::move(parts));
  }

 private:
  std::vector<const One*> bodies_;
};

}  // namespace hamel

namespace Eigen {
template <class Arch>
struct NumTraits<hamel::Lane<Arch>> : GenericNumTraits<hamel::Lane<Arch>> {
  using Real = hamel::Lane<Arch>;
  using NonInteger = Real;
  using Literal = double;
  using Nested = Real;
  enum {
    IsInteger = 0,
    IsSigned = 1,
    IsComplex = 0,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
  static double epsilon() { return NumTraits<double>::epsilon(); }
  static double dummy_precision() { return NumTraits<double>::dummy_precision(); }
};
template <class Arch, class Op>
struct ScalarBinaryOpTraits<double, hamel::Lane<Arch>, Op> {
  using ReturnType = hamel::Lane<Arch>;
};
template <class Arch, class Op>
struct ScalarBinaryOpTraits<hamel::Lane<Arch>, double, Op> {
  using ReturnType = hamel::Lane<Arch>;
};
// A lane has its own alignment: Eigen's, the largest for the flags of a build, may be less.
namespace internal {
template <class Arch, int Size>
struct compute_default_alignment<hamel::Lane<Arch>, Size> {
  enum { value = 0 };
};
template <class Arch>
struct compute_default_alignment<hamel::Lane<Arch>, Dynamic> {
  enum { value = 0 };
};
}  // namespace internal
}  // namespace Eigen
