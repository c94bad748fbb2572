#include <hamel/systems/suslov.hpp>

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace hamel {

Suslov::Velocity::Velocity(const Suslov& body, const double* start) {
  const Vec<3> omega0(start), n = body.normal.normalized();
  Mat<3, 2> frame;
  frame.col(0) = n.unitOrthogonal();
  frame.col(1) = n.cross(frame.col(0));
  Eigen::Map<Mat<3, 2>>{frame_} = frame;
  const Mat<3, 3> inertia = body.inertia();
  const Mat<2, 2> j = frame.transpose() * inertia * frame;
  const Vec<2> k = frame.transpose() * (inertia * n), b = j.inverse() * k;
  const Vec<2> w0 = frame.transpose() * omega0;
  Eigen::Map<Vec<2>>{w0_} = w0;
  const double spread = std::sqrt(j.norm() * j.inverse().norm());
  const double p0 = k.dot(w0), q0 = b[1] * w0[0] - b[0] * w0[1];
  if (std::abs(p0) > 1e-15 * inertia.norm() * w0.norm()) {  // else constant
    root_det_ = std::copysign(std::sqrt(j.determinant()), p0);
    a_ = std::hypot(q0, p0 / root_det_);
    at0_ = std::asinh(q0 * std::sqrt(j.determinant()) / std::abs(p0));
    Eigen::Map<Mat<2, 2>>{solve_} = Mat<2, 2>{{k[0], k[1]}, {b[1], -b[0]}}.inverse();
  }
  rate_ = a_ + spread * w0.norm();
}

void Suslov::Velocity::at(double t, double* omega) const {
  const Eigen::Map<const Mat<3, 2>> frame(frame_);
  Eigen::Map<Vec<3>> out(omega);
  if (a_ == 0) {
    out = frame * Eigen::Map<const Vec<2>>(w0_);
    return;
  }
  const double x = a_ * t - at0_;
  const Vec<2> pq = {root_det_ * a_ / std::cosh(x), -a_ * std::tanh(x)};
  out = frame * (Eigen::Map<const Mat<2, 2>>(solve_) * pq);
}

}  // namespace hamel
