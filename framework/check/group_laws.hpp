// The group axioms, measured, by name and by type, a user's own groups included.
//
//   for (const auto& law : hamel::check_group(hamel::registry(), "se2*so2^3"))
//     std::cout << law << "\n";
//   for (const auto& law : hamel::check_group<MyGroup, MyRetraction>()) std::cout << law << "\n";
// By name: the laws as far as a run sees the group, through Geometry. By type also the functions
// that Geometry does not pass on. The retraction draws random elements (products of two tau(xi))
// and curves through e; any will do.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/check/laws.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/lie/group_info.hpp>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel {

/// The axioms on 20 random triples; geometry: the group with any retraction.
LawReport check_group(const GroupInfo& info, const Geometry& geometry, unsigned long long seed = 1);

/// A registered group, or a product of registered groups, with its first retraction. ConfigError on
/// an unknown name.
LawReport check_group(const Registry& registry, const std::string& group,
                      unsigned long long seed = 1);

namespace check {

/// Uniform direction and length between a tenth of the radius and the radius.
void random_vector(std::mt19937_64& random, double radius, Eigen::Ref<Eigen::VectorXd> out);
inline Eigen::VectorXd random_vector(std::mt19937_64& random, int n, double radius = 1) {
  Eigen::VectorXd out(n);
  random_vector(random, radius, out);
  return out;
}
template <int N>
Vec<N> random_vector(std::mt19937_64& random, double radius = 1) {
  return random_vector(random, N, radius);
}

/// tau(xi) tau(eta) with random xi, eta of length at most 1.
template <class R>
auto random_element(std::mt19937_64& random) {
  const auto first = R::tau(random_vector<R::Group::dim>(random));
  const auto second = R::tau(random_vector<R::Group::dim>(random));
  return R::Group::compose(first, second);
}

/// |q(g^-1 h) - q(e)|: how far apart two elements are.
template <class G>
double distance(const typename G::template Element<double>& g,
                const typename G::template Element<double>& h) {
  const std::vector<double> q = G::coordinates(G::compose(G::inverse(g), h)),
                            e = G::coordinates(G::template identity<double>());
  double sum = 0;
  for (size_t i = 0; i < q.size(); ++i) sum += (q[i] - e[i]) * (q[i] - e[i]);
  return std::sqrt(sum);
}

template <class G>
using FirstRetraction = typename FirstOf<typename G::Retractions>::type;

}  // namespace check

/// Every axiom. R: any retraction of G, by default the first of G::Retractions.
template <Group G, class R = check::FirstRetraction<G>>
LawReport check_group(unsigned long long seed = 1) {
  using check::algebraic;
  constexpr int n = G::dim;
  LawReport report = check_group(group_info<G>(), TypedGeometry<R>(), seed);
  std::mt19937_64 random(seed);
  check::Largest coad, hat, matrix_of_curve;
  for (int sample = 0; sample < 20; ++sample) {
    const Vec<n> xi = check::random_vector<n>(random), eta = check::random_vector<n>(random),
                 mu = check::random_vector<n>(random);
    const Mat<n, n> ad_xi = G::ad(xi);
    coad((G::coad(mu) * xi - ad_xi.transpose() * mu).norm());
    if constexpr (requires { G::hat(xi); }) {
      const Eigen::MatrixXd x = G::hat(xi), y = G::hat(eta);
      hat((G::hat(Vec<n>(ad_xi * eta)) - (x * y - y * x)).norm());
      if constexpr (requires { G::vee(G::hat(xi)); }) hat((G::vee(G::hat(xi)) - xi).norm());
      const auto curve = [&](double t) -> Eigen::MatrixXd {
        return G::matrix(R::tau(Vec<n>(t * xi)));
      };
      matrix_of_curve((check::derivative(curve) - x).norm());
    }
  }
  report.push_back({"coad(mu) eta = ad(eta)^T mu", coad.value, algebraic});
  if constexpr (requires(const Vec<n>& xi) { G::hat(xi); }) {
    report.push_back(
        {"hat([xi, eta]) = [hat(xi), hat(eta)], vee(hat(xi)) = xi", hat.value, algebraic});
    report.push_back(
        {"d/dt matrix(tau(t xi)) = hat(xi)", matrix_of_curve.value, check::differentiated});
  }
  return report;
}

}  // namespace hamel
