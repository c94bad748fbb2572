#include <hamel/framework/check/retraction_laws.hpp>

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/check/algebra.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/lie/decompositions.hpp>

namespace hamel {

using check::Matrix;
using check::Vector;

namespace check {

std::vector<Point> points(const Geometry& geometry, unsigned long long seed) {
  const Algebra on{geometry};
  std::mt19937_64 random(seed);
  std::vector<Point> out;
  for (int sample = 0; sample < 12; ++sample) {
    const Vector direction = random_vector(random, on.n).normalized();
    const Vector p = random_vector(random, on.n);
    double edge = on.reach(direction, [&](const Vector& xi) { return on.in_domain(xi); });
    const bool reached = on.reaches(0.999 * edge * direction);
    if (!reached) edge = on.reach(direction, [&](const Vector& xi) { return on.reaches(xi); });
    for (const double length : {1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.1 * edge, 0.3 * edge, 0.45 * edge,
                                0.55 * edge, 0.7 * edge, 0.9 * edge, 0.999 * edge}) {
      const Vector xi = length * direction;
      out.push_back({{xi.begin(), xi.end()}, {p.begin(), p.end()}, length, edge, reached});
    }
  }
  return out;
}

LawResult flag(const std::string& law, bool claimed, double violation, bool abelian) {
  if (claimed) return {law, violation, rounded};
  const bool denied = !(violation <= differentiated) || abelian;
  return {law, denied ? 0.0 : 1.0, 0,
          fmt::format("not claimed, and violated by {:.3g}{}", violation,
                      denied ? "" : fmt::format(", expected more than {:g}", differentiated))};
}

}  // namespace check

LawReport check_retraction(const GroupInfo& info, const Geometry& geometry,
                           unsigned long long seed) {
  using check::differentiated;
  using check::Largest;
  using check::rounded;
  const check::Algebra on{geometry};
  const int n = on.n;
  constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
  const Matrix one = Matrix::Identity(n, n);
  const Vector zero = Vector::Zero(n), e = on.from_coordinates(info.identity);
  const check::NumericalDerivative numerical(geometry);
  Largest origin, tangent, at_identity, defect, right, left, adjoint, inverses, base, round_trip,
      recovered, domain, nan, symmetry, one_parameter, commuting;

  std::string outside;  // a point that is no member of the domain
  origin(on.distance(on.tau(zero), e));
  origin(on.tau_inverse(e).norm());
  at_identity((on.dtau_right(zero) - one).norm());
  at_identity((on.dtau_left_inverse(zero) - one).norm());
  domain(on.in_domain(zero) ? 0 : 1);
  for (int i = 0; i < n; ++i) {
    nan(on.in_domain(nan_value * Vector::Unit(n, i)) ? 1 : 0);
    Vector bad = zero;
    bad[i] = nan_value;
    nan(on.in_domain(bad) ? 1 : 0);
  }

  for (const auto& [there, covector, length, edge, reached] : check::points(geometry, seed)) {
    const Vector xi = Eigen::Map<const Vector>(there.data(), n),
                 p = Eigen::Map<const Vector>(covector.data(), n);
    const Vector g = on.tau(xi);
    defect(geometry.defect(g.data()));
    const Matrix dR = on.dtau_right(xi), dL_inverse = on.dtau_left_inverse(xi);
    const double condition = std::max(1.0, dL_inverse.norm() * dense::inverse(dL_inverse).norm());
    if (!(reached && on.in_domain(xi))) {
      domain(1);
      outside = fmt::format("not at |xi| = {:.6g}", length);
    }
    // dR may come from dR^-1 by elimination: its relative round-off is that of the condition.
    adjoint((dR * dL_inverse - on.Ad(g)).norm() /
            (condition * std::max(1.0, dR.norm() * dL_inverse.norm())));
    Vector q(n);
    geometry.dtau_right_inverse_transpose(xi.data(), p.data(), q.data());
    const double growth = on.growth(g);
    inverses((dR.transpose() * q - p).norm() / (growth * condition * p.norm()));
    const Vector nu = 0.3 * p.reverse();
    for (const double s : {0.0, 0.3, 0.5}) {  // m0 of the cotangent lift (trivialised.hpp)
      Vector m0(n), mixed(n);
      const Vector z0 = -s * xi;
      geometry.mixed_momentum(s, xi.data(), p.data(), nu.data(), mixed.data());
      geometry.dtau_right_inverse_transpose(z0.data(), mixed.data(), m0.data());
      const Matrix d0 = on.dtau_right(-s * xi), d1 = on.dtau_right((1 - s) * xi);
      const Vector sum = s * d0.transpose() * m0 + (1 - s) * d1.transpose() * (m0 + nu) - p;
      base(sum.norm() / (condition * condition * (p.norm() + m0.norm())));
    }
    const double resolved = length < 0.1 * edge ? std::max(length, on.resolution(xi)) : length;
    round_trip((on.tau_inverse(g) - xi).norm() / (resolved * condition));
    if (length > 0.7 * edge) continue;
    const Vector direction = xi / length;
    tangent((check::derivative([&](double t) { return on.Ad(on.tau(t * direction)); }) -
             on.ad(direction))
                .norm());
    right((numerical.right(xi) - dR).norm() / condition);
    left((numerical.left(xi) * dL_inverse - one).norm() / condition);
    // Farther out the step of a map that is not symmetric may be one of a shorter xi.
    for (const double s : {0.0, 0.3, 0.5, 1.0}) {
      if (length > 0.35 * edge) break;
      const Vector step = on.compose(on.inverse(on.tau(-s * xi)), on.tau((1 - s) * xi));
      recovered((on.recover_step(step, s) - xi).norm() / (resolved * condition));
    }
    if (length < 0.1 * edge) continue;
    symmetry(on.distance(on.compose(on.tau(-xi), g), e) / growth);
    const Vector part = on.tau(0.3 * xi);
    commuting(on.distance(on.compose(part, g), on.compose(g, part)) / growth);
    for (const double s : {-0.3, 0.2, 0.5}) {
      const Vector one_way = on.compose(on.inverse(on.tau(-s * xi)), on.tau((1 - s) * xi));
      one_parameter(on.distance(one_way, g) / growth);
    }
  }

  const bool abelian = on.abelian();
  return {
      {"tau(0) = e, tau^-1(e) = 0", origin.value, rounded},
      {"tau(xi) is an element", defect.value, rounded},
      {"dR tau = id = dL tau at 0", at_identity.value, rounded},
      {"d/dt Ad(tau(t xi)) = ad(xi)", tangent.value, differentiated},
      {"dR tau against differences of tau", right.value, differentiated},
      {"dL tau against differences of tau", left.value, differentiated},
      {"dR tau = Ad(tau) dL tau", adjoint.value, rounded},
      {"dR^T dR^-T = id", inverses.value, rounded},
      {"s dR_z0^T m0 + (1-s) dR_z1^T (m0 + nu) = p for mixed_momentum", base.value, rounded},
      {"tau^-1(tau(xi)) = xi from |xi| = 1e-12 to the edge", round_trip.value, rounded},
      {"recover_step(tau(-s xi)^-1 tau((1-s) xi), s) = xi to 0.3 of the edge", recovered.value,
       rounded},
      {"0 and everything up to the edge is in the domain, and tau^-1 is defined there",
       domain.value, 0, outside},
      {"NaN is not in the domain", nan.value, 0},
      check::flag("flag symmetric is right: tau(-xi) = tau(xi)^-1", geometry.symmetric(),
                  symmetry.value, abelian),
      check::flag("flag one_parameter is right: tau(-s xi)^-1 tau((1-s) xi) = tau(xi)",
                  geometry.one_parameter(), one_parameter.value, abelian),
      {"tau(a xi) tau(b xi) = tau(b xi) tau(a xi) where commuting is set",
       geometry.commuting() ? commuting.value : 0, rounded},
  };
}

LawReport check_retraction(const Registry& registry, const std::string& group,
                           const std::string& retraction, unsigned long long seed) {
  const auto info = registry.group_or_product(group);
  if (!info) throw ConfigError({unknown_name("group", group, registry.groups())});
  const auto geometry = registry.geometry(group, retraction);
  if (geometry == nullptr) {
    throw ConfigError({unknown_name("retraction of " + group, retraction,
                                    registry.retractions_or_common(group))});
  }
  return check_retraction(*info, *geometry, seed);
}

}  // namespace hamel
