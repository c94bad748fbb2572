// The group axioms, measured: `hamel::check_group<SO3>(seed)` for any group, a user's own included.
//
//   for (const auto& law : hamel::check_group<MyGroup, MyRetraction>(1)) std::cout << law << "\n";
// The retraction draws random elements (products of two tau(xi)) and curves through e; any will do.
// Bounds: algebraic laws 1e-12 (elements have entries of order 1 to 10 and a law chains some tens
// of operations: a few 1e-15 are seen, a wrong sign gives order 1); laws with a derivative 1e-9, by
// central differences of order 6 with step 4e-3 (round-off about 1e-13, truncation below 1e-10).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/lie/concepts.hpp>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/framework/lie/types.hpp>

namespace hamel {

/// One law: the largest violation that was seen, and the largest that round-off explains.
struct LawResult {
  std::string law;
  double measured = 0;
  double bound = 0;
  /// NaN does not pass.
  bool passed() const { return measured <= bound; }
};
using LawReport = std::vector<LawResult>;

inline std::ostream& operator<<(std::ostream& out, const LawResult& law) {
  return out << (law.passed() ? "holds  " : "FAILS  ") << law.law << ": " << law.measured
             << " (bound " << law.bound << ")";
}

namespace check {

inline constexpr double algebraic = 1e-12;
inline constexpr double differentiated = 1e-9;

/// The largest of measured values; NaN is kept.
struct Largest {
  double value = 0;
  void operator()(double x) {
    if (!(x <= value)) value = x;
  }
};

/// Uniform direction and length below `radius`.
template <int N>
Vec<N> random_vector(std::mt19937_64& random, double radius = 1) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.1, 1);
  Vec<N> v;
  for (int i = 0; i < N; ++i) v[i] = normal(random);
  return v * (radius * uniform(random) / v.norm());
}

/// tau(xi) tau(eta) with random xi, eta of length at most 1.
template <class R>
auto random_element(std::mt19937_64& random) {
  const auto first = R::tau(random_vector<R::Group::dim>(random));
  const auto second = R::tau(random_vector<R::Group::dim>(random));
  return R::Group::compose(first, second);
}

/// The coordinates as an Eigen vector.
template <class G>
Eigen::VectorXd coordinate_vector(const typename G::template Element<double>& g) {
  const std::vector<double> values = G::coordinates(g);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// |q(g^-1 h) - q(e)|: how far apart two elements are.
template <class G>
double distance(const typename G::template Element<double>& g,
                const typename G::template Element<double>& h) {
  return (coordinate_vector<G>(G::compose(G::inverse(g), h)) -
          coordinate_vector<G>(G::template identity<double>()))
      .norm();
}

/// f'(0) by central differences of order 6; f returns an Eigen vector or matrix.
template <class Function>
auto derivative(Function&& f, double step = 4e-3) {
  auto d = ((45.0 / (60 * step)) * (f(step) - f(-step))).eval();
  d += (-9.0 / (60 * step)) * (f(2 * step) - f(-2 * step));
  d += (1.0 / (60 * step)) * (f(3 * step) - f(-3 * step));
  return d;
}

/// Has the group a non-zero bracket?
template <class G>
bool nonabelian() {
  for (int i = 0; i < G::dim; ++i) {
    if (G::ad(Vec<G::dim>(Vec<G::dim>::Unit(i))).norm() > 0) return true;
  }
  return false;
}

template <class G>
struct FirstRetraction;
template <class G>
requires requires { typename G::Retractions; }
struct FirstRetraction<G> {
  template <class List>
  struct Head;
  template <class R, class... Rest>
  struct Head<TypeList<R, Rest...>> {
    using type = R;
  };
  using type = typename Head<typename G::Retractions>::type;
};

/// Does from_coordinates refuse these values with std::invalid_argument?
template <class G>
bool refuses(const std::vector<double>& values) {
  try {
    (void)G::from_coordinates(std::span<const double>(values));
  } catch (const std::invalid_argument&) {
    return true;
  }
  return false;
}

}  // namespace check

/// Every axiom on 20 random triples. R: any retraction of G, by default the first of
/// G::Retractions.
template <Group G, class R = typename check::FirstRetraction<G>::type>
LawReport check_group(unsigned long long seed = 1) {
  using check::Largest;
  constexpr int n = G::dim;
  std::mt19937_64 random(seed);
  const auto e = G::template identity<double>();
  const Mat<n, n> one = Mat<n, n>::Identity();
  Largest associative, neutral, inverse, homomorphism, ad_inverse, ad_of_curve, conjugation, jacobi,
      antisymmetric, coad, transpose, idempotent, defect, round_trip, names, refusal, matrix, hat,
      matrix_of_curve;

  for (int sample = 0; sample < 20; ++sample) {
    const auto g = check::random_element<R>(random), h = check::random_element<R>(random),
               k = check::random_element<R>(random);
    const Vec<n> xi = check::random_vector<n>(random), eta = check::random_vector<n>(random),
                 mu = check::random_vector<n>(random);
    const auto gh = G::compose(g, h);
    const auto back = G::inverse(g);
    associative(check::distance<G>(G::compose(gh, k), G::compose(g, G::compose(h, k))));
    neutral(check::distance<G>(G::compose(e, g), g));
    neutral(check::distance<G>(G::compose(g, e), g));
    inverse(check::distance<G>(G::compose(g, back), e));
    inverse(check::distance<G>(G::compose(back, g), e));

    const Mat<n, n> Ad_g = G::Ad(g), ad_xi = G::ad(xi), ad_eta = G::ad(eta);
    homomorphism((G::Ad(gh) - Ad_g * G::Ad(h)).norm());
    ad_inverse((G::Ad(back) * Ad_g - one).norm());
    ad_of_curve(
        (check::derivative([&](double t) -> Mat<n, n> { return G::Ad(R::tau(Vec<n>(t * eta))); }) -
         ad_eta)
            .norm());
    // Both curves leave e; their tangents are Ad_g eta.
    const Vec<n> turned = Ad_g * eta;
    conjugation((check::derivative([&](double t) -> Eigen::VectorXd {
                   const auto small = R::tau(Vec<n>(t * eta));
                   return check::coordinate_vector<G>(G::compose(G::compose(g, small), back));
                 }) -
                 check::derivative([&](double t) -> Eigen::VectorXd {
                   return check::coordinate_vector<G>(R::tau(Vec<n>(t * turned)));
                 })).norm());
    jacobi((G::ad(Vec<n>(ad_xi * eta)) - (ad_xi * ad_eta - ad_eta * ad_xi)).norm());
    antisymmetric((ad_xi * eta + ad_eta * xi).norm());
    coad((G::coad(mu) * eta - ad_eta.transpose() * mu).norm());
    transpose((G::Ad_transpose(g, mu) - Ad_g.transpose() * mu).norm());

    const auto normal = G::normalise(gh);
    idempotent(check::distance<G>(G::normalise(normal), normal));
    idempotent(check::distance<G>(normal, gh));
    defect(G::defect(normal));
    std::vector<double> values = G::coordinates(gh);
    round_trip(check::distance<G>(G::from_coordinates(std::span<const double>(values)), gh));
    names(values.size() == G::columns().size() ? 0 : 1);
    values[static_cast<std::size_t>(sample) % values.size()] =
        std::numeric_limits<double>::quiet_NaN();
    refusal(check::refuses<G>(values) ? 0 : 1);
    values.assign(values.size() + 1, 0.0);
    refusal(check::refuses<G>(values) ? 0 : 1);

    const Eigen::MatrixXd m_g = G::matrix(g), m_h = G::matrix(h), m_gh = G::matrix(gh);
    matrix((m_gh - m_g * m_h).norm());
    matrix((G::matrix(e) - Eigen::MatrixXd::Identity(m_g.rows(), m_g.cols())).norm());
    if constexpr (requires { G::hat(xi); }) {
      const Eigen::MatrixXd x = G::hat(xi), y = G::hat(eta);
      hat((G::hat(Vec<n>(ad_xi * eta)) - (x * y - y * x)).norm());
      if constexpr (requires { G::vee(G::hat(xi)); }) hat((G::vee(G::hat(xi)) - xi).norm());
      matrix_of_curve((check::derivative([&](double t) -> Eigen::MatrixXd {
                         return G::matrix(R::tau(Vec<n>(t * xi)));
                       }) -
                       x)
                          .norm());
    }
  }

  using check::algebraic;
  using check::differentiated;
  LawReport report = {
      {"(g h) k = g (h k)", associative.value, algebraic},
      {"e g = g = g e", neutral.value, algebraic},
      {"g g^-1 = e = g^-1 g", inverse.value, algebraic},
      {"Ad(g h) = Ad(g) Ad(h)", homomorphism.value, algebraic},
      {"Ad(g^-1) = Ad(g)^-1", ad_inverse.value, algebraic},
      {"d/dt Ad(tau(t eta)) = ad(eta)", ad_of_curve.value, differentiated},
      {"d/dt g tau(t eta) g^-1 = Ad(g) eta", conjugation.value, differentiated},
      {"Jacobi: ad([xi, eta]) = [ad(xi), ad(eta)]", jacobi.value, algebraic},
      {"[xi, eta] = -[eta, xi]", antisymmetric.value, algebraic},
      {"coad(mu) eta = ad(eta)^T mu", coad.value, algebraic},
      {"Ad_transpose(g, mu) = Ad(g)^T mu", transpose.value, algebraic},
      {"normalise is idempotent and near the identity", idempotent.value, algebraic},
      {"defect(normalise(g)) is round-off", defect.value, 1e-14},
      {"from_coordinates(coordinates(g)) = g", round_trip.value, algebraic},
      {"one column name for each coordinate", names.value, 0},
      {"from_coordinates refuses NaN and wrong lengths", refusal.value, 0},
      {"matrix(g h) = matrix(g) matrix(h)", matrix.value, 10 * algebraic},
  };
  if constexpr (requires(const Vec<n>& xi) { G::hat(xi); }) {
    report.push_back(
        {"hat([xi, eta]) = [hat(xi), hat(eta)], vee(hat(xi)) = xi", hat.value, algebraic});
    report.push_back({"d/dt matrix(tau(t xi)) = hat(xi)", matrix_of_curve.value, differentiated});
  }
  return report;
}

}  // namespace hamel
