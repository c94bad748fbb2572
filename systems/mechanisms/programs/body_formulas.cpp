#include <hamel/systems/mechanisms/programs/body_formulas.hpp>

#include <cmath>
#include <limits>

namespace hamel::mechanisms {
namespace {

constexpr double kDust = 4 * std::numeric_limits<double>::epsilon();

// Entries that round-off has left are zeros of the formula.
template <class M>
M without_dust(M m, double size) {
  for (double& x : m.reshaped())
    if (std::abs(x) <= kDust * size) x = 0;
  return m;
}

// B T B^T of a rotation B, without round-off where T is one of the terms of a turning about e3.
Mat<3, 3> conjugated(const Mat<3, 3>& b, const Mat<3, 3>& t) {
  const Vec3 e = b.col(2);
  const Mat<3, 3> one = Mat<3, 3>::Identity(), along = Vec3(0, 0, 1).asDiagonal();
  const Mat<3, 3> turning = cross_matrix(Vec3(0, 0, 1));
  if (t.isZero(0) || t == one) return t;
  if (t == along) return e * e.transpose();
  if (t == one - along) return one - Mat<3, 3>(e * e.transpose());
  if (t == turning) return cross_matrix(e);
  return without_dust(Mat<3, 3>(b * t * b.transpose()), 1);
}

// The motion of a joint, affine in the numbers of its element: constant + sum g_k terms_k; of one
// number x along which it turns, a screw, constant exp(S x).
struct AffineMotion {
  Rigid constant;
  std::vector<Rigid> terms;
  bool screw = false;
  Vec3 turning = Vec3::Zero(), sliding = Vec3::Zero();  // S of a screw

  explicit AffineMotion(const Joint& joint) {
    screw = joint.dim() == 1 && joint.geometry()->size() == 1 && !joint.turning().empty();
    if (screw) {
      turning = joint.directions().col(0).head<3>();
      sliding = joint.directions().col(0).tail<3>();
    }
    std::vector<double> element(static_cast<size_t>(joint.geometry()->size()), 0.0);
    constant = joint.motion(element.data());
    for (double& number : element) {
      number = 1;
      const Rigid one = joint.motion(element.data());
      number = 0;
      terms.push_back({one.rotation - constant.rotation, one.position - constant.position});
    }
  }
  Pose at(std::span<const Number> g) const {
    if (screw) return along_screw(g[0]);
    Pose out = numbers(constant);
    for (size_t k = 0; k < terms.size(); ++k) {
      for (int i = 0; i < 9; ++i)
        out.rotation.reshaped()[i] += terms[k].rotation.reshaped()[i] * g[k];
      for (int i = 0; i < 3; ++i) out.position[i] += terms[k].position[i] * g[k];
    }
    return out;
  }
  // exp by Rodrigues: 1 + sin u W + (1 - cos u) W^2, and (u + (1 - cos u) W + (u - sin u) W^2) v, W
  // of length 1 and v per radian, u = |omega| x.
  Pose along_screw(const Number& x) const {
    const double size = turning.norm();
    const Mat<3, 3> w = cross_matrix(Vec3(turning / size)), w2 = w * w;
    const Vec3 v = sliding / size, wv = w * v, w2v = w2 * v;
    const Number u = size * x, s = sin(u), c = 1 - cos(u);
    Pose moved;
    for (int i = 0; i < 9; ++i)
      moved.rotation.reshaped()[i] =
          (i % 4 == 0 ? 1.0 : 0.0) + w.reshaped()[i] * s + w2.reshaped()[i] * c;
    for (int i = 0; i < 3; ++i) moved.position[i] = v[i] * u + wv[i] * c + w2v[i] * (u - s);
    const Pose before = numbers(constant);
    return {before.rotation.lazyProduct(moved.rotation), before.apply(moved.position)};
  }
  // Number k is an entry of the motion, or its negative: its rate is that of the entry.
  Number rate(size_t k, const Pose& rates) const {
    for (int i = 0; i < 12; ++i) {
      const double own = entry(terms[k], i);
      if (std::abs(own) != 1 || entry(constant, i) != 0) continue;
      bool alone = true;
      for (size_t j = 0; j < terms.size(); ++j)
        alone = alone && (j == k || entry(terms[j], i) == 0);
      if (!alone) continue;
      return own * (i < 9 ? rates.rotation.reshaped()[i] : rates.position[i - 9]);
    }
    return 0;
  }

 private:
  static double entry(const Rigid& x, int i) {
    return i < 9 ? x.rotation.reshaped()[i] : x.position[i - 9];
  }
};

NumberMat3 cross_numbers(const NumberVec3& v) {
  NumberMat3 out;
  out << Number(0), -v[2], v[1], v[2], Number(0), -v[0], -v[1], v[0], Number(0);
  return out;
}

}  // namespace

BodyFormulas::BodyFormulas(const Tree& tree, std::span<const Number> g, std::span<const Number> xi,
                           const Vec3& gravity)
    : tree_(tree),
      xi_(xi.begin(), xi.end()),
      gravity_(gravity),
      nodes_(static_cast<size_t>(tree.links())),
      element_rates_(g.size()) {
  for (int link = 0; link < tree.links(); ++link) {
    place(link, g);
    move(link);
    if (!tree.rotor(link)) find_moments(link);
  }
}

// iota of a link's joint; the rates of its numbers.
Pose BodyFormulas::motion(int link, std::span<const Number> g) {
  const Joint& joint = tree_.joint(link);
  const AffineMotion motion(joint);
  const auto first = static_cast<size_t>(tree_.element(link));
  const Pose out = motion.at(g.subspan(first, motion.terms.size()));
  NumberVec3 omega = numbers(Vec3(Vec3::Zero())), velocity = omega;
  for (int i = 0; i < joint.dim(); ++i) {
    const Number& rate = xi_[static_cast<size_t>(tree_.first(link) + i)];
    for (int x = 0; x < 3; ++x) {
      omega[x] += joint.directions()(x, i) * rate;
      velocity[x] += joint.directions()(3 + x, i) * rate;
    }
  }
  const Pose rates{out.rotation.lazyProduct(cross_numbers(omega)), out.turn(velocity)};
  for (size_t k = 0; k < motion.terms.size(); ++k)
    element_rates_[first + k] =
        motion.screw ? xi_[static_cast<size_t>(tree_.first(link))] : motion.rate(k, rates);
  return out;
}

void BodyFormulas::place(int link, std::span<const Number> g) {
  Node& node = nodes_[static_cast<size_t>(link)];
  const Link& drawn = tree_.link(link);
  const Joint& joint = *drawn.joint;
  const Pose iota = motion(link, g);
  const Rigid &before = drawn.on_parent, &after = drawn.on_child;
  const bool conjugates = before.rotation == after.rotation && !AffineMotion(joint).screw;
  NumberMat3 turned = iota.rotation;  // P iota C^-1
  if (conjugates) {
    const AffineMotion motion(joint);
    turned = numbers(conjugated(before.rotation, motion.constant.rotation));
    for (size_t k = 0; k < motion.terms.size(); ++k) {
      const Mat<3, 3> term = conjugated(before.rotation, motion.terms[k].rotation);
      const Number& number = g[static_cast<size_t>(tree_.element(link)) + k];
      for (int i = 0; i < 9; ++i) turned.reshaped()[i] += term.reshaped()[i] * number;
    }
  } else {
    turned = numbers(before.rotation)
                 .lazyProduct(NumberMat3(turned.lazyProduct(numbers(after.rotation).transpose())));
  }
  const NumberVec3 at =
      numbers(before.position) + numbers(before.rotation).lazyProduct(iota.position);
  if (is_root(link)) {
    node.place.position = numbers(after.position);
    node.world.rotation = turned;
    node.world.position = at - turned.lazyProduct(numbers(after.position));
  } else {
    const int parent = tree_.parent(link);
    const NumberVec3 lever = at - numbers(tree_.link(parent).on_child.position);
    node.place.rotation = this->at(parent).place.rotation.lazyProduct(turned);
    node.place.position = this->at(parent).place.apply(lever);
  }
  const bool fixed = !is_root(link) && joint.dim() == 1;  // the axis, in the parent
  const NumberMat3 frame =
      fixed ? NumberMat3(
                  this->at(tree_.parent(link)).place.rotation.lazyProduct(numbers(before.rotation)))
            : NumberMat3(node.place.rotation.lazyProduct(numbers(after.rotation)));
  for (int i = 0; i < joint.dim(); ++i) {
    node.turns.push_back(frame.lazyProduct(numbers(Vec3(joint.directions().col(i).head<3>()))));
    node.slides.push_back(frame.lazyProduct(numbers(Vec3(joint.directions().col(i).tail<3>()))));
  }
}

void BodyFormulas::move(int link) {
  Node& node = nodes_[static_cast<size_t>(link)];
  node.turning = node.sliding = numbers(Vec3(Vec3::Zero()));
  for (size_t i = 0; i < node.turns.size(); ++i) {
    const Number& rate = xi_[static_cast<size_t>(tree_.first(link)) + i];
    node.turning += rate * node.turns[i];
    node.sliding += rate * node.slides[i];
  }
  node.omega = node.turning;
  node.velocity = node.sliding;
  if (is_root(link)) return;
  const Node& parent = at(tree_.parent(link));
  node.omega += parent.omega;
  node.velocity +=
      parent.velocity + cross(parent.omega, node.place.position - parent.place.position);
}

void BodyFormulas::find_moments(int link) {
  Node& node = nodes_[static_cast<size_t>(link)];
  const Vec3& c = tree_.link(link).on_child.position;
  const Inertia& drawn = tree_.drawn_inertia(link);
  const double length = 1 + c.norm();
  const Inertia about = moved({Mat<3, 3>::Identity(), -c}, drawn);
  const Vec3 first = without_dust(about.first, drawn.first.norm() + drawn.mass * c.norm());
  const Mat<3, 3> second =
      without_dust(about.second, drawn.second.norm() + drawn.mass * length * c.norm());
  node.own = {drawn.mass, node.place.turn(numbers(first)),
              turned_symmetric(node.place.rotation, numbers(second))};
}

NumberVec3 BodyFormulas::point(int link, const Vec3& drawn) const {
  if (link == kGround) return numbers(drawn);
  return at(link).place.apply(numbers(Vec3(drawn - tree_.link(link).on_child.position)));
}

NumberVec3 BodyFormulas::direction(int link, const Vec3& drawn) const {
  if (link == kGround) return numbers(drawn);
  return at(link).place.turn(numbers(drawn));
}

const Pose& BodyFormulas::root_in_world(int link) const {
  if (link == kGround) return rest_;
  while (!is_root(link)) link = tree_.parent(link);
  return at(link).world;
}

void BodyFormulas::each_effect(int link, const NumberVec3& q, const NumberVec3& u,
                               const std::function<void(int, const Number&)>& f) const {
  for (int j = link; j != kGround; j = tree_.parent(j)) {
    const Node& node = at(j);
    const NumberVec3 lever = q - node.place.position;
    for (size_t i = 0; i < node.turns.size(); ++i)
      f(tree_.first(j) + static_cast<int>(i), dot(u, node.slides[i] + cross(node.turns[i], lever)));
  }
}

void BodyFormulas::each_turning(int link, const NumberVec3& u,
                                const std::function<void(int, const Number&)>& f) const {
  for (int j = link; j != kGround; j = tree_.parent(j)) {
    const Node& node = at(j);
    for (size_t i = 0; i < node.turns.size(); ++i)
      f(tree_.first(j) + static_cast<int>(i), dot(u, node.turns[i]));
  }
}

NumberVec3 BodyFormulas::velocity(int link, const NumberVec3& q) const {
  if (link == kGround) return numbers(Vec3(Vec3::Zero()));
  const Node& node = at(link);
  return node.velocity + cross(node.omega, q - node.place.position);
}

NumberVec3 BodyFormulas::turning(int link) const {
  return link == kGround ? numbers(Vec3(Vec3::Zero())) : at(link).omega;
}

}  // namespace hamel::mechanisms
