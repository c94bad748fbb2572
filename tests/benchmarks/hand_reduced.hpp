// The equations of four systems, reduced by hand as a user of an integrator of ordinary
// differential equations would.
//
// Rotations are unit quaternions q = (w, x, y, z), q' = 1/2 q (0, omega); nothing keeps their
// length, answers divide by it. Each is a right-hand side over any scalar for Boost.odeint and
// SUNDIALS:
//   State, size          y, and its length
//   operator()(y, dy, t) y' = f(y)
//   start(), answer(y)   y of hamel's start; the element's CSV columns and xi of y
// Sources of the equations: the headers in systems/.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/rattleback.hpp>
#include <hamel/systems/suslov.hpp>

namespace hamel::benchmarks {

/// q' of q at dq, body rates w.
template <class T>
void turn(const T* q, const T* w, T* dq) {
  dq[0] = T(-0.5) * (q[1] * w[0] + q[2] * w[1] + q[3] * w[2]);
  dq[1] = T(0.5) * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]);
  dq[2] = T(0.5) * (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]);
  dq[3] = T(0.5) * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]);
}
/// The rotation matrix of q of any length.
template <class T>
MatT<T, 3, 3> rotation(const T* q) {
  const T s = T(2) / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return MatT<T, 3, 3>{{1 - s * (q[2] * q[2] + q[3] * q[3]), s * (q[1] * q[2] - q[0] * q[3]),
                        s * (q[1] * q[3] + q[0] * q[2])},
                       {s * (q[1] * q[2] + q[0] * q[3]), 1 - s * (q[1] * q[1] + q[3] * q[3]),
                        s * (q[2] * q[3] - q[0] * q[1])},
                       {s * (q[1] * q[3] - q[0] * q[2]), s * (q[2] * q[3] + q[0] * q[1]),
                        1 - s * (q[1] * q[1] + q[2] * q[2])}};
}
/// Rows of R, then the other numbers.
template <class T>
std::vector<double> answer_of(const MatT<T, 3, 3>& r, std::initializer_list<T> others) {
  std::vector<double> out;
  for (int i = 0; i < 9; ++i) out.push_back(static_cast<double>(r(i / 3, i % 3)));
  for (const T& x : others) out.push_back(static_cast<double>(x));
  return out;
}

/// y = (w1, w2, q); n = e3:  J w' = (k . w) (-w2, w1).
template <class T>
struct SuslovByHand {
  static constexpr std::size_t size = 6;
  using State = std::array<T, size>;
  T a, b, c, k1, k2;  // J^-1 = (a b; b c), k

  explicit SuslovByHand(const Suslov& body) {
    const Mat<3, 3> i = body.inertia();
    const T det = T(i(0, 0)) * i(1, 1) - T(i(0, 1)) * i(0, 1);
    a = i(1, 1) / det, b = -i(0, 1) / det, c = i(0, 0) / det, k1 = i(0, 2), k2 = i(1, 2);
  }
  void operator()(const State& y, State& dy, T /*t*/) const {
    const T p = k1 * y[0] + k2 * y[1], u = -p * y[1], v = p * y[0];
    dy[0] = a * u + b * v;
    dy[1] = b * u + c * v;
    const T w[3] = {y[0], y[1], 0};
    turn(&y[2], w, &dy[2]);
  }
  static State start() { return {1, 0.5, 1, 0, 0, 0}; }
  static std::vector<double> answer(const State& y) {
    return answer_of(rotation(&y[2]), {y[0], y[1], T(0)});
  }
};

/// y = (theta, x, y, omega, v).
template <class T>
struct SleighByHand {
  static constexpr std::size_t size = 5;
  using State = std::array<T, size>;
  T offset, drag;

  explicit SleighByHand(const ChaplyginSleigh& body)
      : offset(body.offset),
        drag(T(body.mass) * body.offset /
             (body.moment + T(body.mass) * body.offset * body.offset)) {}
  void operator()(const State& y, State& dy, T /*t*/) const {
    using std::cos;
    using std::sin;
    dy[0] = y[3];
    dy[1] = y[4] * cos(y[0]);
    dy[2] = y[4] * sin(y[0]);
    dy[3] = -drag * y[4] * y[3];
    dy[4] = offset * y[3] * y[3];
  }
  static State start() { return {0, 0, 0, T(0.9), -1}; }
  static std::vector<double> answer(const State& y) {
    return {double(y[0]), double(y[1]), double(y[2]), double(y[3]), double(y[4]), 0};
  }
};

/// y = (psi, theta, phi, x, y, w1, w2, w3): precession, lean, spin; rates on e1 horizontal, e2 from
/// the contact to the centre, e3 the axis. With c3 = w2 cot(theta), e_z = sin(theta) e2 +
/// cos(theta) e3,
///   (A + m r^2) w1' = A c3 w2 - (C + m r^2) w2 w3 - m g r cos(theta),
///   A w2' = C w1 w3 - A c3 w1,   (C + m r^2) w3' = m r^2 w1 w2,   v = r (-w3 e1 + w1 e3).
template <class T>
struct DiskByHand {
  static constexpr std::size_t size = 8;
  using State = std::array<T, size>;
  T radius, tilt, turn_over, gravity, ratio, spin;

  explicit DiskByHand(const FallingDisk& disk) : radius(disk.radius) {
    const T a = disk.diametral_inertia, c = disk.axial_inertia, m = disk.mass,
            mr2 = m * radius * radius;
    tilt = a / (a + mr2);
    turn_over = (c + mr2) / (a + mr2);
    gravity = m * disk.gravity * radius / (a + mr2);
    ratio = c / a;
    spin = mr2 / (c + mr2);
  }
  void operator()(const State& y, State& dy, T /*t*/) const {
    using std::cos;
    using std::sin;
    const T s = sin(y[1]), c = cos(y[1]), c_psi = cos(y[0]), s_psi = sin(y[0]);
    const T w1 = y[5], w2 = y[6], w3 = y[7], psi = w2 / s, c3 = psi * c;
    dy[0] = psi;
    dy[1] = w1;
    dy[2] = w3 - c3;
    dy[3] = radius * (w1 * s * s_psi - w3 * c_psi);
    dy[4] = -radius * (w1 * s * c_psi + w3 * s_psi);
    dy[5] = tilt * c3 * w2 - turn_over * w2 * w3 - gravity * c;
    dy[6] = w1 * (ratio * w3 - c3);
    dy[7] = spin * w1 * w2;
  }
  static State start() { return {0, T(1.3), 0, 0, 0, T(0.1), T(0.4), 5}; }
  std::vector<double> answer(const State& y) const {
    using std::cos;
    using std::sin;
    const T s = sin(y[1]), c = cos(y[1]), cp = cos(y[0]), sp = sin(y[0]), cf = cos(y[2]),
            sf = sin(y[2]);
    // Body axes: e1, e2 turned back by phi; the centre is at height r sin(theta).
    const MatT<T, 3, 3> frame{{cp, -c * sp, s * sp}, {sp, c * cp, -s * cp}, {0, s, c}};
    const MatT<T, 3, 3> own{{cf, -sf, 0}, {sf, cf, 0}, {0, 0, 1}};
    const VecT<T, 3> w = own.transpose() * VecT<T, 3>(y[5], y[6], y[7]);
    const VecT<T, 3> v = own.transpose() * VecT<T, 3>(-radius * y[7], 0, radius * y[5]);
    return answer_of<T>(frame * own, {y[3], y[4], radius * s, w[0], w[1], w[2], v[0], v[1], v[2]});
  }
};

/// y = (omega, q, x, y): with gamma = R^T e_z, s = sqrt(gamma^T D^2 gamma), r = d e3 - D^2 gamma /
/// s, v = r x omega,
///   (I + m (r.r - r r^T)) omega' = -omega x I omega + m r x (r' x omega + omega x v + g gamma).
template <class T>
struct RattlebackByHand {
  static constexpr std::size_t size = 9;
  using State = std::array<T, size>;
  using V = VecT<T, 3>;
  MatT<T, 3, 3> inertia;
  V squares;
  T mass, depth, gravity, tilt;

  explicit RattlebackByHand(const Rattleback& body)
      : inertia(body.inertia().topLeftCorner<3, 3>().template cast<T>()),
        squares(body.semi_axes.cwiseAbs2().template cast<T>()),
        mass(body.mass),
        depth(body.depth),
        gravity(body.gravity),
        tilt(0.02) {}
  V contact(const V& gamma) const {
    using std::sqrt;
    const V d = squares.cwiseProduct(gamma);
    return V(0, 0, depth) - d / sqrt(gamma.dot(d));
  }
  void operator()(const State& y, State& dy, T /*t*/) const {
    using std::sqrt;
    const V w(y[0], y[1], y[2]);
    const MatT<T, 3, 3> rot = rotation(&y[3]);
    const V gamma = rot.row(2).transpose(), rate = gamma.cross(w), d = squares.cwiseProduct(gamma);
    const T s2 = gamma.dot(d), s = sqrt(s2);
    const V r = V(0, 0, depth) - d / s, v = r.cross(w);
    const V moved = (d * (rate.dot(d) / s2) - squares.cwiseProduct(rate)) / s;
    const V torque = r.cross(V(moved.cross(w) + w.cross(v) + gravity * gamma));
    const V right = mass * torque - w.cross(V(inertia * w));
    // Cramer's rule, on the symmetric M.
    MatT<T, 3, 3> m = inertia - mass * r * r.transpose();
    m.diagonal().array() += mass * r.dot(r);
    const V c0 = m.col(1).cross(m.col(2)), c1 = m.col(2).cross(m.col(0)),
            c2 = m.col(0).cross(m.col(1));
    const T det = m.col(0).dot(c0);
    dy[0] = c0.dot(right) / det;
    dy[1] = c1.dot(right) / det;
    dy[2] = c2.dot(right) / det;
    turn(&y[3], &y[0], &dy[3]);
    dy[7] = rot.row(0).dot(v);
    dy[8] = rot.row(1).dot(v);
  }
  State start() const {
    using std::cos;
    using std::sin;
    const T spin = T(-1.5);
    return {0, spin * sin(tilt), spin * cos(tilt), cos(tilt / 2), sin(tilt / 2), 0, 0, 0, 0};
  }
  std::vector<double> answer(const State& y) const {
    const MatT<T, 3, 3> rot = rotation(&y[3]);
    const V gamma = rot.row(2).transpose(), r = contact(gamma), w(y[0], y[1], y[2]), v = r.cross(w);
    return answer_of<T>(rot, {y[7], y[8], -gamma.dot(r), w[0], w[1], w[2], v[0], v[1], v[2]});
  }
};

}  // namespace hamel::benchmarks
