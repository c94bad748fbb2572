// Every registered system against the equations of motion (M4), Lagrange-d'Alembert with
// multipliers, in the coordinates of the trajectory file, integrated by Boost.odeint at 1e-13.
//
// Shared with the library: the system's own statements (I, A, b, force). Not shared: the group, the
// retraction, the schemes, the projections, the elimination of the multipliers.
#include <boost/numeric/odeint.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include <Eigen/LU>
#include <Eigen/SVD>

#include <hamel/hamel.hpp>

namespace hamel {
namespace {

using State = std::vector<double>;

// d/dt of a factor's coordinates with body velocity xi; advances both past the factor.
void factor_rate(const std::string& group, const double*& x, const double*& xi, double*& out) {
  const auto turn = [](const double* r, const double* w, double* to) {  // R' = R w^
    for (int i = 0; i < 3; ++i) {
      const double* a = r + 3 * i;
      to[3 * i + 0] = a[1] * w[2] - a[2] * w[1];
      to[3 * i + 1] = a[2] * w[0] - a[0] * w[2];
      to[3 * i + 2] = a[0] * w[1] - a[1] * w[0];
    }
  };
  if (group == "so2") {
    out[0] = xi[0];
    x += 1, xi += 1, out += 1;
  } else if (group == "se2") {
    const double c = std::cos(x[0]), s = std::sin(x[0]);
    out[0] = xi[0];
    out[1] = c * xi[1] - s * xi[2];
    out[2] = s * xi[1] + c * xi[2];
    x += 3, xi += 3, out += 3;
  } else if (group == "so3") {
    turn(x, xi, out);
    x += 9, xi += 3, out += 9;
  } else if (group == "se3") {
    turn(x, xi, out);
    for (int i = 0; i < 3; ++i) {
      out[9 + i] = x[3 * i] * xi[3] + x[3 * i + 1] * xi[4] + x[3 * i + 2] * xi[5];
    }
    x += 12, xi += 6, out += 12;
  } else if (group == "heisenberg") {  // (x, y, z)(a, b, c) = (x + a, y + b, z + c + (x b - y a)/2)
    out[0] = xi[0];
    out[1] = xi[1];
    out[2] = xi[2] + 0.5 * (x[0] * xi[1] - x[1] * xi[0]);
    x += 3, xi += 3, out += 3;
  } else if (group[0] == 'r') {
    const int n = std::stoi(group.substr(1));
    std::copy_n(xi, n, out);
    x += n, xi += n, out += n;
  } else {
    FAIL() << "no coordinates known for " << group;
  }
}

std::vector<std::string> factors_of(const std::string& group) {
  std::vector<std::string> out;
  std::istringstream in(group);
  for (std::string word; std::getline(in, word, '*');) {
    const size_t hat = word.find('^');
    const int count = hat == std::string::npos ? 1 : std::stoi(word.substr(hat + 1));
    out.insert(out.end(), static_cast<size_t>(count), word.substr(0, hat));
  }
  return out;
}

class Equations {
 public:
  explicit Equations(const SystemModel& system)
      : factors_(factors_of(system.group.name)),
        columns_(system.group.columns.size()),
        n_(system.group.dim),
        geometry_(registry().geometry(system.group.name, "exp")),
        mechanics_(system.mechanics) {}

  void rate(const double* x, const double* xi, double* out) const {
    for (const std::string& factor : factors_) factor_rate(factor, x, xi, out);
  }

  // [ I  -A^T ] [xi']     [ ad*_xi I xi + force - (dI/dt) xi ]
  // [ A   0   ] [lambda] = [ db/dt - (dA/dt) xi               ]
  void operator()(const State& state, State& out, double t) const {
    const auto n = static_cast<Eigen::Index>(n_);
    const Eigen::Index k = mechanics_->constraint_count();
    out.resize(state.size());
    const Eigen::VectorXd xi = Eigen::Map<const Eigen::VectorXd>(state.data() + columns_, n);
    rate(state.data(), xi.data(), out.data());
    Eigen::MatrixXd inertia(n, n), a(k, n), inertia_rate = Eigen::MatrixXd::Zero(n, n),
                                            a_rate = Eigen::MatrixXd::Zero(k, n), m(n, n), r(k, n);
    Eigen::VectorXd b(k), b_rate = Eigen::VectorXd::Zero(k), force(n), some(k),
                          g(geometry_->size());
    load(state, g);
    const auto element = [&](double shift) {  // g exp(shift xi)
      const Eigen::VectorXd step = shift * xi;
      Eigen::VectorXd moved(geometry_->size());
      geometry_->tau(step.data(), moved.data());
      geometry_->compose(g.data(), moved.data(), moved.data());
      return moved;
    };
    // Fourth-order differences.
    const double e = 1e-3;
    for (const auto& [shift, weight] : {std::pair{-2 * e, 1 / (12 * e)},
                                        {-e, -8 / (12 * e)},
                                        {e, 8 / (12 * e)},
                                        {2 * e, -1 / (12 * e)}}) {
      const Eigen::VectorXd at = element(shift);
      mechanics_->inertia(at.data(), m);
      mechanics_->constraints(t + shift, at.data(), r, some);
      inertia_rate += weight * m;
      a_rate += weight * r;
      b_rate += weight * some;
    }
    mechanics_->inertia(g.data(), inertia);
    mechanics_->constraints(t, g.data(), a, b);
    mechanics_->force(t, g.data(), xi, force);
    Eigen::VectorXd momentum = inertia * xi, coadjoint(n);
    geometry_->ad_transpose(xi.data(), momentum.data(), coadjoint.data());
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + k, n + k);
    whole << inertia, -a.transpose(), a, Eigen::MatrixXd::Zero(k, k);
    Eigen::VectorXd right(n + k);
    right << coadjoint + force - inertia_rate * xi, b_rate - a_rate * xi;
    const Eigen::VectorXd solution = whole.fullPivLu().solve(right);
    for (Eigen::Index i = 0; i < n; ++i) out[columns_ + static_cast<size_t>(i)] = solution[i];
  }

  // The element next to the coordinates: a stage of the integration may leave SO(3) by its error.
  void load(const State& state, Eigen::VectorXd& g) const {
    State x(state.begin(), state.begin() + static_cast<long>(columns_));
    size_t at = 0;
    for (const std::string& factor : factors_) {
      if (factor == "so3" || factor == "se3") {
        using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
        Eigen::Map<Rows> r(x.data() + at);
        const Eigen::JacobiSVD<Mat<3, 3>> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
        r = svd.matrixU() * svd.matrixV().transpose();
      }
      at += registry().group(factor)->columns.size();
    }
    geometry_->from_coordinates(x, g.data());
  }

 private:
  std::vector<std::string> factors_;
  size_t columns_;
  int n_;
  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> mechanics_;
};

class Every : public testing::TestWithParam<std::string> {};

TEST_P(Every, AgreesWithTheMultiplierEquations) {
  const double until = 1;
  const Result result = simulate(GetParam())
                            .scheme("lift")
                            .retraction("exp")
                            .s(0.5)
                            .compose("kahan_li6")
                            .step(0.005)
                            .until(until)
                            .every(1000)
                            .run();
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  State state = result.config.start.configuration;
  state.insert(state.end(), result.config.start.velocity.begin(),
               result.config.start.velocity.end());
  using namespace boost::numeric::odeint;
  const Equations equations(*result.system);
  integrate_adaptive(make_controlled<runge_kutta_fehlberg78<State>>(1e-12, 1e-12), equations, state,
                     0.0, until, 1e-3);
  State end = result.last.coordinates;
  end.insert(end.end(), result.last.velocity.begin(), result.last.velocity.end());
  double error = 0;
  for (size_t i = 0; i < end.size(); ++i) error = std::max(error, std::abs(end[i] - state[i]));
  EXPECT_LT(error, 1e-8) << GetParam();
  RecordProperty("error", std::to_string(error));
}

INSTANTIATE_TEST_SUITE_P(Systems, Every, testing::ValuesIn(registry().systems()),
                         [](const auto& it) { return it.param; });

}  // namespace
}  // namespace hamel
