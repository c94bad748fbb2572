#include <hamel/systems/mechanisms/programs/lift_layout.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <hamel/framework/lie/packing.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/se3.hpp>
#include <hamel/groups/so3.hpp>

namespace hamel::mechanisms {
namespace {

using LinkKind = LiftLayout::Kind;

constexpr double kTurn = 2 * std::numbers::pi;

size_t count_of(LinkKind kind) {
  switch (kind) {
    case LinkKind::added: return 1;
    case LinkKind::wheel: return 2;
    case LinkKind::turning: return 3;
    case LinkKind::ball: return 9;
    case LinkKind::planar: return 5;
    default: return 12;
  }
}

// Does nothing depend on the angle of a link?
bool is_idle(const MechanismParts& parts, int link) {
  const auto& [tree, rows, forces, kept, holonomic, geometry] = parts;
  if (!tree.rotor(link)) return false;
  const auto holds = [link](const auto& part) { return part.a == link || part.b == link; };
  return std::ranges::none_of(rows.contacts,
                              [link](const Contact& one) { return one.carrier == link; }) &&
         std::ranges::none_of(rows.loops, holds) && std::ranges::none_of(forces.springs, holds) &&
         std::ranges::none_of(forces.forces, [link](const Force& f) { return f.link == link; });
}

std::optional<LinkKind> kind_of(const MechanismParts& parts, int link) {
  const Joint& joint = parts.tree.joint(link);
  const std::string& group = joint.group().name;
  const bool root = parts.tree.parent(link) == kGround;
  if (group == "r1") return LinkKind::added;
  if (group == "so2") return is_idle(parts, link) ? LinkKind::wheel : LinkKind::turning;
  if (group == "so3") return LinkKind::ball;
  if (group == "se2" && root) return LinkKind::planar;
  if (group == "se3" && root) return LinkKind::free;
  return std::nullopt;
}

SO2Element<double> plane_turn(double angle, double turns) {
  if (std::abs(angle) < 3) [[likely]]  // far from half a turn
    return {std::cos(angle), std::sin(angle), std::llround(turns)};
  SO2Element<double> out = SO2::from_angle(angle);
  out.turns += std::llround(turns);
  return out;
}

// Full turns of an angle whose cosine and sine are these.
std::int64_t turns_of(double angle, double c, double s) {
  const double turns = std::rint(angle / kTurn);
  if (std::abs(angle - kTurn * turns) < 3) [[likely]]  // far from half a turn
    return static_cast<std::int64_t>(turns);
  return std::llround((angle - SO2Element<double>{c, s, 0}.angle()) / kTurn);
}

}  // namespace

std::shared_ptr<const LiftLayout> LiftLayout::of(const MechanismParts& parts) {
  auto out = std::make_shared<LiftLayout>();
  for (int link = 0; link < parts.tree.links(); ++link) {
    const std::optional<LinkKind> kind = kind_of(parts, link);
    if (!kind) return nullptr;
    out->parts_.push_back(
        {*kind, static_cast<int>(out->size_), parts.tree.element(link), parts.tree.first(link)});
    out->size_ += count_of(*kind);
    out->turning_ += *kind == LinkKind::turning;
  }
  return out;
}

void LiftLayout::pack(const double* numbers, double* element) const {
  for (const Part& part : parts_) {
    const double* x = numbers + part.first;
    double* to = element + part.element;
    switch (part.kind) {
      case LinkKind::wheel: Packing<SO2>::store(plane_turn(x[0], x[1]), to); break;
      case LinkKind::turning: {
        Packing<SO2>::store({x[1], x[2], turns_of(x[0], x[1], x[2])}, to);
        break;
      }
      case LinkKind::planar:
        Packing<SE2>::store({{x[0], x[1], std::llround(x[4])}, {x[2], x[3]}}, to);
        break;
      default: std::copy_n(x, count_of(part.kind), to);
    }
  }
}

void LiftLayout::unpack(const double* element, double* numbers) const {
  for (const Part& part : parts_) {
    const double* from = element + part.element;
    double* x = numbers + part.first;
    switch (part.kind) {
      case LinkKind::wheel: {
        const SO2Element<double> g = Packing<SO2>::load(from);
        x[0] = SO2Element<double>{g.c, g.s, 0}.angle();
        x[1] = static_cast<double>(g.turns);
        break;
      }
      case LinkKind::turning: {
        const SO2Element<double> g = Packing<SO2>::load(from);
        x[0] = g.angle();
        x[1] = g.c;
        x[2] = g.s;
        break;
      }
      case LinkKind::planar: {
        const SE2Element<double> g = Packing<SE2>::load(from);
        x[0] = g.rotation.c;
        x[1] = g.rotation.s;
        x[2] = g.translation[0];
        x[3] = g.translation[1];
        x[4] = static_cast<double>(g.rotation.turns);
        break;
      }
      default: std::copy_n(from, count_of(part.kind), x);
    }
  }
}

void LiftLayout::coordinates(const double* numbers, double* out) const {
  const auto put = [&out](const auto& values) {
    out = std::copy(values.begin(), values.end(), out);
  };
  for (const Part& part : parts_) {
    const double* x = numbers + part.first;
    switch (part.kind) {
      case LinkKind::added:
      case LinkKind::turning: *out++ = x[0]; break;
      case LinkKind::wheel: *out++ = x[0] + kTurn * x[1]; break;
      case LinkKind::ball: put(SO3::coordinates(Packing<SO3>::load(x))); break;
      case LinkKind::planar:
        put(SE2::coordinates(SE2Element<double>{{x[0], x[1], std::llround(x[4])}, {x[2], x[3]}}));
        break;
      case LinkKind::free: put(SE3::coordinates(Packing<SE3>::load(x))); break;
    }
  }
}

void LiftLayout::normalise(double* numbers) const {
  for (const Part& part : parts_) {
    double* x = numbers + part.first;
    const auto scale = [](double& c, double& s) {
      const double by = 1.5 - 0.5 * (c * c + s * s);
      c *= by;
      s *= by;
    };
    switch (part.kind) {
      case LinkKind::added: break;
      case LinkKind::wheel:
        if (std::abs(x[0]) > std::numbers::pi) {
          const double turns = std::rint(x[0] / kTurn);
          x[0] -= kTurn * turns;
          x[1] += turns;
        }
        break;
      case LinkKind::turning: {
        scale(x[1], x[2]);
        const double angle = std::atan2(x[2], x[1]);
        x[0] = angle + kTurn * std::rint((x[0] - angle) / kTurn);
        break;
      }
      case LinkKind::planar: scale(x[0], x[1]); break;
      default: {
        Eigen::Map<Mat<3, 3>> rotation(x);
        rotation = SO3::normalise(Mat<3, 3>(rotation));
      }
    }
  }
}

bool LiftLayout::moves_by(const Geometry& geometry) const {
  std::vector<double> xi(static_cast<size_t>(geometry.dim())),
      moved(static_cast<size_t>(geometry.size())), numbers(size_), expected(moved.size());
  for (size_t i = 0; i < xi.size(); ++i) xi[i] = 0.3 * std::sin(2.0 * static_cast<double>(i) + 1);
  geometry.tau(xi.data(), moved.data());
  for (const Part& part : parts_) {
    const double* v = xi.data() + part.dof;
    double* to = expected.data() + part.element;
    switch (part.kind) {
      case LinkKind::added: *to = *v; break;
      case LinkKind::wheel:
      case LinkKind::turning: Packing<SO2>::store(SO2::from_angle(*v), to); break;
      case LinkKind::ball: Packing<SO3>::store(Cayley<SO3>::tau(Vec<3>(v)), to); break;
      case LinkKind::planar: Packing<SE2>::store(Cayley<SE2>::tau(Vec<3>(v)), to); break;
      case LinkKind::free: Packing<SE3>::store(Cayley<SE3>::tau(Vec<6>(v)), to); break;
    }
  }
  for (size_t i = 0; i < moved.size(); ++i)
    if (!(std::abs(moved[i] - expected[i]) <= 1e-14)) return false;
  return true;
}

// Between two places on one side of the cut there is no turn, in less than half a one.
void LiftLayout::count_turns(const Part& part, const double* before, double angle, double* after) {
  const double *from = before + part.first, *to = after + part.first;
  if (std::signbit(from[1]) == std::signbit(to[1]) && std::abs(angle) < 4) [[likely]]
    return;
  const SO2Element<double> half = Cayley<SE2>::tau(Vec<3>(0.5 * angle, 0, 0)).rotation;
  const SO2Element<double> start{from[0], from[1], std::llround(from[4])};
  after[part.first + 4] = static_cast<double>(SO2::compose(SO2::compose(start, half), half).turns);
}

}  // namespace hamel::mechanisms
