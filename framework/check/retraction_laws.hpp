// The laws of a retraction map, measured, by name and by type, also of a user's own.
//
//   for (const auto& law : hamel::check_retraction(hamel::registry(), "se3", "cayley"))
//     std::cout << law << "\n";
//   for (const auto& law : hamel::check_retraction<Cayley<SO3>>()) std::cout << law << "\n";
// By name: the laws as far as a run sees the map, through Geometry. By type also the functions that
// Geometry does not pass on, Newton's derivative among them.
//
// Points: |xi| from 1e-12 to 0.999 of the way to the edge of the domain (or 3 if there is none).
// Bounds (laws.hpp) are relative to the size of the maps involved; differences are taken no nearer
// to the edge than 0.7 of the way, where the seventh derivatives are still moderate. A tau that is
// wrong by 1e-13 fails: where it leaves the group, its defect; where its inverse or its derivatives
// are right, the law that compares them. No law sees a map that is consistently another one.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/framework/lie/retraction_members.hpp>

namespace hamel {

/// Every law of the concept Retraction that Geometry can show.
LawReport check_retraction(const GroupInfo& info, const Geometry& geometry,
                           unsigned long long seed = 1);

/// A retraction of a registered group, or of a product of registered groups. ConfigError on an
/// unknown name.
LawReport check_retraction(const Registry& registry, const std::string& group,
                           const std::string& retraction, unsigned long long seed = 1);

namespace check {

/// A point of the algebra to evaluate a retraction at.
struct Point {
  std::vector<double> xi, p;    // p: a covector
  double length = 0, edge = 0;  // |xi|, and how far the domain reaches in its direction
  bool reached = true;          // is tau^-1 defined up to the edge that in_domain states?
};
/// Twelve random directions with twelve lengths each.
std::vector<Point> points(const Geometry& geometry, unsigned long long seed);

/// A flag as a law: what is claimed must hold; what is denied must be seen to fail, but on an
/// abelian group it may hold by accident.
LawResult flag(const std::string& law, bool claimed, double violation, bool abelian);

}  // namespace check

/// Every law of the concept Retraction.
template <Retraction R>
LawReport check_retraction(unsigned long long seed = 1) {
  constexpr int n = R::Group::dim;
  using V = Vec<n>;
  using M = Mat<n, n>;
  const TypedGeometry<R> geometry;
  LawReport report = check_retraction(group_info<typename R::Group>(), geometry, seed);
  const M one = M::Identity();
  check::Largest inverses, stage, halves, ends, newton, tangent;
  for (const check::Point& point : check::points(geometry, seed)) {
    const V xi = Eigen::Map<const V>(point.xi.data()), p = Eigen::Map<const V>(point.p.data());
    const M dR = R::dtau_right(xi), dL = R::dtau_left(xi);
    const M dR_inverse = R::dtau_right_inverse(xi), dL_inverse = R::dtau_left_inverse(xi);
    const auto g = R::tau(xi);
    const double growth =
        std::max(1.0, R::Group::Ad(g).norm() * R::Group::Ad(R::Group::inverse(g)).norm() / n);
    const double condition = growth * std::max(1.0, dL_inverse.norm() * dL.norm());
    inverses((dR * dR_inverse - one).norm() / condition);
    inverses((dL * dL_inverse - one).norm() / condition);
    inverses((dR_inverse.transpose() * p - R::dtau_right_inverse_transpose(xi, p)).norm() /
             (condition * p.norm()));
    inverses((dL_inverse.transpose() * p - R::dtau_left_inverse_transpose(xi, p)).norm() /
             (condition * p.norm()));
    V rate;
    const auto together = R::Group::coordinates(tau_with_rate<R>(xi, p, rate));
    const auto alone = R::Group::coordinates(g);
    for (size_t i = 0; i < together.size(); ++i) {
      stage(std::abs(together[i] - alone[i]) / (1 + std::abs(alone[i])));
    }
    for (const V& got : {rate, apply_dtau_left_inverse<R>(xi, p)}) {
      stage((dL_inverse * p - got).norm() / (condition * p.norm()));
    }
    if constexpr (requires { R::tau_of_halves(xi); }) {
      const auto half = R::tau(V(0.5 * xi));
      const auto twice = R::Group::coordinates(R::Group::compose(half, half));
      const auto at_once = R::Group::coordinates(R::tau_of_halves(xi));
      for (size_t i = 0; i < twice.size(); ++i) halves(std::abs(twice[i] - at_once[i]));
    }
    if constexpr (has_end_momenta<R>) {
      V even, odd;
      R::end_momenta(xi, p, even, odd);
      const V half = 0.5 * xi, back = -half;
      const V q = mixed_momentum<R>(0.5, xi, p, V::Zero());
      const V base = R::dtau_right_inverse_transpose(back, q);
      const V starts = R::Group::Ad_transpose(R::tau(back), base);
      const V end = R::Group::Ad_transpose(R::tau(half), base);
      const double size = (1 + xi.squaredNorm()) * p.norm();
      ends((even + odd - starts).norm() / size);
      ends((even - odd - end).norm() / size);
    }
    if (point.length > 0.7 * point.edge) continue;
    const M slope = R::dtau_right_inverse_transpose_derivative(xi, p);
    M differences;
    for (int j = 0; j < n; ++j) {
      differences.col(j) = check::derivative([&](double t) -> V {
        return R::dtau_right_inverse(V(xi + t * V::Unit(j))).transpose() * p;
      });
    }
    newton((slope - differences).norm() / (1 + slope.norm()));
    if constexpr (requires { R::Group::hat(xi); }) {
      const V direction = xi / point.length;
      const Eigen::MatrixXd hat = R::Group::hat(direction);
      tangent((check::derivative([&](double t) -> Eigen::MatrixXd {
                 return R::Group::matrix(R::tau(V(t * direction)));
               }) -
               hat)
                  .norm());
    }
  }
  report.push_back({"dR dR^-1 = id = dL dL^-1", inverses.value, check::rounded});
  report.push_back({"tau and dL^-1 eta of a stage are those alone", stage.value, check::rounded});
  if constexpr (requires(const V& xi) { R::tau_of_halves(xi); })
    report.push_back({"tau(xi/2)^2 at once", halves.value, check::rounded});
  if constexpr (has_end_momenta<R>)
    report.push_back({"momenta at the ends of a step", ends.value, check::rounded});
  if constexpr (requires(const V& xi) { R::Group::hat(xi); })
    report.push_back({"d/dt matrix(tau(t xi)) = hat(xi)", tangent.value, check::differentiated});
  report.push_back(
      {"Newton derivative d[dR^-T p] against differences", newton.value, check::differentiated});
  return report;
}

/// Does not compile: the message names the member that R lacks.
template <class R>
requires(!Retraction<R>) LawReport check_retraction(unsigned long long /*seed*/ = 1) {
  refuse_incomplete<R>();
  return {};
}

}  // namespace hamel
