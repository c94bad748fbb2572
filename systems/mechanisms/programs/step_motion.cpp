#include <hamel/systems/mechanisms/programs/step_motion.hpp>

#include <numbers>

#include <hamel/groups/cayley.hpp>
#include <hamel/groups/se3.hpp>
#include <hamel/groups/so3.hpp>

namespace hamel::mechanisms {
namespace {

using StepKind = LiftLayout::Kind;

template <int N>
VecT<Number, N> part_of(std::span<const Number> all, int first) {
  VecT<Number, N> out;
  for (int i = 0; i < N; ++i) out[i] = all[static_cast<size_t>(first + i)];
  return out;
}
template <class V>
void put(const V& values, int first, std::vector<Number>& out) {
  for (Eigen::Index i = 0; i < values.size(); ++i)
    out[static_cast<size_t>(first + i)] = values.reshaped()[i];
}
NumberMat3 rotation_of(std::span<const Number> all, int first) {
  NumberMat3 out;
  for (int i = 0; i < 9; ++i) out.reshaped()[i] = all[static_cast<size_t>(first + i)];
  return out;
}
// x y of unit complex numbers.
VecT<Number, 2> complex_product(const VecT<Number, 2>& x, const VecT<Number, 2>& y) {
  return {x[0] * y[0] - x[1] * y[1], x[1] * y[0] + x[0] * y[1]};
}

// Momenta at the ends of a part: even -+ odd of (M50), and on a ball what nu adds, with a = h
// omega/4 and dR = (1 + a^)/(1 + |a|^2) at h omega/2 (cayley.hpp):
//   m0 = (1 + |a|^2) p + (a x nu - nu)/2,   m1 = m0 + nu,   mu0 = R m0,   mu1 = R^T m1.
template <class Tau, int N>
void end_momenta(const VecT<Number, N>& step, const VecT<Number, N>& p, VecT<Number, N>& start,
                 VecT<Number, N>& end) {
  VecT<Number, N> even, odd;
  Tau::end_momenta(step, p, even, odd);
  start = even + odd;
  end = even - odd;
}

}  // namespace

StepMotion::StepMotion(const LiftLayout& layout, std::span<const Number> from,
                       std::span<const Number> v, const Number& h)
    : layout_(layout), v_(v.begin(), v.end()), h_(h), middle_(layout.size()), end_(layout.size()) {
  for (const LiftLayout::Part& part : layout.parts()) move(part, from);
}

void StepMotion::move(const LiftLayout::Part& part, std::span<const Number> from) {
  const Number half = 0.5 * h_;
  const auto at = static_cast<size_t>(part.first);
  const Number& rate = v_[static_cast<size_t>(part.dof)];
  const auto add = [&] {
    middle_[at] = from[at] + half * rate;
    end_[at] = from[at] + h_ * rate;
  };
  switch (part.kind) {
    case StepKind::added: add(); break;
    case StepKind::wheel:
      add();
      middle_[at + 1] = end_[at + 1] = from[at + 1];
      break;
    case StepKind::turning: {
      add();
      const VecT<Number, 2> by{cos(half * rate), sin(half * rate)};
      const VecT<Number, 2> here = complex_product(part_of<2>(from, part.first + 1), by);
      put(here, part.first + 1, middle_);
      put(complex_product(here, by), part.first + 1, end_);
      break;
    }
    case StepKind::ball: {
      const NumberMat3 by = Cayley<SO3>::tau(VecT<Number, 3>(half * part_of<3>(v_, part.dof)));
      const NumberMat3 here = rotation_of(from, part.first).lazyProduct(by);
      put(here, part.first, middle_);
      put(NumberMat3(here.lazyProduct(by)), part.first, end_);
      break;
    }
    case StepKind::planar: {
      const SE2Element<Number> by =
          Cayley<SE2>::tau(VecT<Number, 3>(half * part_of<3>(v_, part.dof)));
      const VecT<Number, 2> once{by.rotation.c, by.rotation.s},
          start = part_of<2>(from, part.first);
      const VecT<Number, 2> moved = part_of<2>(from, part.first + 2), shift = by.translation;
      const VecT<Number, 2> twice_shift = shift + complex_product(once, shift);
      put(complex_product(start, once), part.first, middle_);
      put(complex_product(start, complex_product(once, once)), part.first, end_);
      put(VecT<Number, 2>(moved + complex_product(start, shift)), part.first + 2, middle_);
      put(VecT<Number, 2>(moved + complex_product(start, twice_shift)), part.first + 2, end_);
      middle_[at + 4] = end_[at + 4] = from[at + 4];
      break;
    }
    case StepKind::free: {
      const SE3Element<Number> by =
          Cayley<SE3>::tau(VecT<Number, 6>(half * part_of<6>(v_, part.dof)));
      const NumberMat3 start = rotation_of(from, part.first), here = start.lazyProduct(by.rotation);
      const NumberVec3 moved = part_of<3>(from, part.first + 9) + start.lazyProduct(by.translation);
      put(here, part.first, middle_);
      put(moved, part.first + 9, middle_);
      put(NumberMat3(here.lazyProduct(by.rotation)), part.first, end_);
      put(NumberVec3(moved + here.lazyProduct(by.translation)), part.first + 9, end_);
      break;
    }
  }
}

std::pair<StepMotion::Numbers, StepMotion::Numbers> StepMotion::momenta(const Numbers& p,
                                                                        const Numbers& nu) const {
  Numbers start = p, end = p;
  for (const LiftLayout::Part& part : layout_.parts()) {
    switch (part.kind) {
      case StepKind::ball: {
        const VecT<Number, 3> step = h_ * part_of<3>(v_, part.dof), n = part_of<3>(nu, part.dof),
                              a = 0.25 * step, turned = cross(a, n);
        VecT<Number, 3> mu0, mu1;
        end_momenta<Cayley<SO3>, 3>(step, part_of<3>(p, part.dof), mu0, mu1);
        const NumberMat3 by = Cayley<SO3>::tau(VecT<Number, 3>(0.5 * step));
        mu0 += by.lazyProduct(VecT<Number, 3>(0.5 * (turned - n)));
        mu1 += by.transpose().lazyProduct(VecT<Number, 3>(0.5 * (turned + n)));
        put(mu0, part.dof, start);
        put(mu1, part.dof, end);
        break;
      }
      case StepKind::planar: {
        VecT<Number, 3> mu0, mu1;
        end_momenta<Cayley<SE2>, 3>(h_ * part_of<3>(v_, part.dof), part_of<3>(p, part.dof), mu0,
                                    mu1);
        put(mu0, part.dof, start);
        put(mu1, part.dof, end);
        break;
      }
      case StepKind::free: {
        VecT<Number, 6> mu0, mu1;
        end_momenta<Cayley<SE3>, 6>(h_ * part_of<6>(v_, part.dof), part_of<6>(p, part.dof), mu0,
                                    mu1);
        put(mu0, part.dof, start);
        put(mu1, part.dof, end);
        break;
      }
      default: {
        const auto i = static_cast<size_t>(part.dof);
        start[i] -= 0.5 * nu[i];
        end[i] += 0.5 * nu[i];
      }
    }
  }
  return {std::move(start), std::move(end)};
}

std::vector<Number> tree_element(const LiftLayout& layout, const Tree& tree,
                                 std::span<const Number> numbers) {
  std::vector<Number> out(static_cast<size_t>(tree.size()));
  for (const LiftLayout::Part& part : layout.parts()) {
    const auto from = static_cast<size_t>(part.first), to = static_cast<size_t>(part.element);
    switch (part.kind) {
      case StepKind::wheel: out[to] = 1; break;
      case StepKind::turning:
        out[to] = numbers[from + 1];
        out[to + 1] = numbers[from + 2];
        break;
      case StepKind::planar:
        out[to] = numbers[from];
        out[to + 1] = numbers[from + 1];
        out[to + 3] = numbers[from + 2];
        out[to + 4] = numbers[from + 3];
        break;
      default: {
        const size_t count = part.kind == StepKind::added  ? 1
                             : part.kind == StepKind::ball ? 9
                                                           : 12;
        for (size_t i = 0; i < count; ++i) out[to + i] = numbers[from + i];
      }
    }
  }
  return out;
}

Number coordinate_of(const LiftLayout::Part& part, std::span<const Number> numbers) {
  const auto at = static_cast<size_t>(part.first);
  if (part.kind != StepKind::wheel) return numbers[at];
  return numbers[at] + 2 * std::numbers::pi * numbers[at + 1];
}

}  // namespace hamel::mechanisms
