#include <hamel/framework/check/group_laws.hpp>

#include <limits>
#include <memory>

#include <hamel/framework/check/algebra.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/coordinate_rates.hpp>

namespace hamel {

using check::Matrix;
using check::Vector;

namespace check {

void random_vector(std::mt19937_64& random, double radius, Eigen::Ref<Vector> v) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.1, 1);
  for (double& x : v) x = normal(random);
  v *= radius * uniform(random) / v.norm();
}

namespace {

// C(g) as the group states it, against the motion of its coordinates.
LawReport coordinate_rates(const GroupInfo& info, const Geometry& geometry, const Algebra& on,
                           std::mt19937_64& random) {
  const CoordinateRates rates(info,
                              std::shared_ptr<const Geometry>(std::shared_ptr<void>(), &geometry));
  Largest along, transposed;
  for (int sample = 0; sample < 20; ++sample) {
    const Vector first = on.tau(random_vector(random, on.n));
    const Vector g = on.compose(first, on.tau(random_vector(random, on.n)));
    const Vector xi = random_vector(random, on.n), x = on.coordinates(g);
    const Vector slope = random_vector(random, static_cast<int>(x.size()));
    Vector rate = Vector::Zero(x.size()), pulled_back = Vector::Zero(on.n);
    if (!rates.along(x.data(), xi.data(), rate.data())) return {};
    rates.add_pulled_back(g.data(), x.data(), slope.data(), pulled_back);
    along(
        (derivative([&](double t) { return on.coordinates(on.compose(g, on.tau(t * xi))); }) - rate)
            .norm());
    transposed(std::abs(slope.dot(rate) - pulled_back.dot(xi)));
  }
  return {{"d/dt coordinates(g tau(t xi)) = C(g) xi", along.value, differentiated},
          {"slope . C(g) xi = C(g)^T slope . xi", transposed.value, algebraic}};
}

}  // namespace
}  // namespace check

LawReport check_group(const GroupInfo& info, const Geometry& geometry, unsigned long long seed) {
  using check::algebraic;
  using check::differentiated;
  using check::Largest;
  const check::Algebra on{geometry};
  const int n = on.n;
  std::mt19937_64 random(seed);
  const auto random_element = [&] {
    const Vector first = on.tau(check::random_vector(random, n));
    return on.compose(first, on.tau(check::random_vector(random, n)));
  };
  const Vector e = on.from_coordinates(info.identity);
  Largest associative, neutral, inverse, homomorphism, ad_inverse, ad_of_curve, conjugation, jacobi,
      antisymmetric, transpose, idempotent, defect, round_trip, refusal, matrix;

  for (int sample = 0; sample < 20; ++sample) {
    const Vector g = random_element(), h = random_element(), k = random_element();
    const Vector xi = check::random_vector(random, n), eta = check::random_vector(random, n);
    const Vector gh = on.compose(g, h), back = on.inverse(g);
    associative(on.distance(on.compose(gh, k), on.compose(g, on.compose(h, k))));
    neutral(on.distance(on.compose(e, g), g));
    neutral(on.distance(on.compose(g, e), g));
    inverse(on.distance(on.compose(g, back), e));
    inverse(on.distance(on.compose(back, g), e));

    const Matrix Ad_g = on.Ad(g), ad_xi = on.ad(xi), ad_eta = on.ad(eta);
    homomorphism((on.Ad(gh) - Ad_g * on.Ad(h)).norm());
    ad_inverse((on.Ad(back) * Ad_g - Matrix::Identity(n, n)).norm());
    ad_of_curve(
        (check::derivative([&](double t) { return on.Ad(on.tau(t * eta)); }) - ad_eta).norm());
    // Both curves leave e; their tangents are Ad_g eta.
    const Vector turned = Ad_g * eta;
    conjugation((check::derivative([&](double t) {
                   return on.coordinates(on.compose(on.compose(g, on.tau(t * eta)), back));
                 }) -
                 check::derivative([&](double t) {
                   return on.coordinates(on.tau(t * turned));
                 })).norm());
    jacobi((on.ad(ad_xi * eta) - (ad_xi * ad_eta - ad_eta * ad_xi)).norm());
    antisymmetric((ad_xi * eta + ad_eta * xi).norm());
    transpose((on.Ad_transpose(g) - Ad_g.transpose()).norm());

    const Vector normal = on.normalise(gh);
    idempotent(on.distance(on.normalise(normal), normal));
    idempotent(on.distance(normal, gh));
    defect(geometry.defect(normal.data()));
    const Vector q = on.coordinates(gh);
    std::vector<double> values(q.begin(), q.end());
    round_trip(on.distance(on.from_coordinates(values), gh));
    values[static_cast<size_t>(sample) % values.size()] = std::numeric_limits<double>::quiet_NaN();
    refusal(on.refuses(values) ? 0 : 1);
    values.assign(values.size() + 1, 0.0);
    refusal(on.refuses(values) ? 0 : 1);

    const auto matrices = [&](const Vector& of) {
      const Vector at = on.coordinates(of);
      std::vector<Matrix> out;
      for (const PlainMatrix& m : info.matrices(std::vector<double>(at.begin(), at.end()))) {
        out.emplace_back(m.rows, m.columns);
        for (long i = 0; i < m.rows; ++i)
          for (long j = 0; j < m.columns; ++j) out.back()(i, j) = m(i, j);
      }
      return out;
    };
    const auto of_g = matrices(g), of_h = matrices(h), of_gh = matrices(gh), of_e = matrices(e);
    for (size_t i = 0; i < of_g.size(); ++i) {
      matrix((of_gh[i] - of_g[i] * of_h[i]).norm());
      matrix((of_e[i] - Matrix::Identity(of_e[i].rows(), of_e[i].cols())).norm());
    }
  }

  const auto count = static_cast<size_t>(geometry.columns());
  const bool named = info.columns.size() == count && info.identity.size() == count && info.dim == n;
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
      {"Ad_transpose(g, mu) = Ad(g)^T mu", transpose.value, algebraic},
      {"normalise is idempotent and near the identity", idempotent.value, algebraic},
      {"defect(normalise(g)) is round-off", defect.value, 1e-14},
      {"from_coordinates(coordinates(g)) = g", round_trip.value, algebraic},
      {"one column name for each coordinate", named ? 0.0 : 1.0, 0},
      {"from_coordinates refuses NaN and wrong lengths", refusal.value, 0},
      {"matrix(g h) = matrix(g) matrix(h)", matrix.value, 10 * algebraic},
  };
  check::append(report, check::coordinate_rates(info, geometry, on, random));
  return report;
}

LawReport check_group(const Registry& registry, const std::string& group, unsigned long long seed) {
  const auto info = registry.group_or_product(group);
  const auto names = registry.retractions_or_common(group);
  if (!info || names.empty()) {
    throw ConfigError({registry.missing_group(group)});
  }
  return check_group(*info, *registry.geometry(group, names.front()), seed);
}

}  // namespace hamel
