#include <hamel/framework/analysis/steady.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/analysis/reduced_flow.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel {
namespace {

using namespace reduced;
using Complex = std::complex<double>;

constexpr double kGood = 1e-9;  // residual of a steady motion

// What is 1e-10 of the largest column, or of 1, is zero.
Vector least_norm(const Matrix& a, const Vector& b) {
  if (a.cols() == 0) return Vector(0);
  const double most = a.colwise().norm().maxCoeff();
  return dense::least_norm(a, b, most < 1 ? std::min(0.5, 1e-10 / std::max(1e-300, most)) : 1e-10);
}

Vector to_vector(const std::vector<double>& v) {
  return Eigen::Map<const Vector>(v.data(), static_cast<Eigen::Index>(v.size()));
}

// The point (g, xi) and the symmetry that carries it.
class Finder {
 public:
  Finder(const Flow& flow, Vector g, Vector xi)
      : flow_(flow), g_(std::move(g)), xi_(std::move(xi)), symmetries_(flow.symmetries(g_)) {
    settle();
    carrier_ = least_norm(flow_.orbit(symmetries_, g_, xi_), field());
  }
  const Vector& g() const { return g_; }
  const Vector& xi() const { return xi_; }

  /// Newton's method; the residual reached. It ends where it gets no better. hold: the momentum along the guess stays,
  /// where steady motions of all speeds form a family.
  double find(bool hold) {
    const int n = flow_.dim(), count = 2 * n + flow_.held() + flow_.rows();
    const Vector guess = xi_, along = flow_.momentum(g_, xi_).normalized();
    double residual = settle(), reach = 1;
    for (int k = 0; k < 60 && residual > 1e-14 && reach > 1e-3; ++k) {
      const Vector g = g_, xi = xi_;
      Matrix slope = Matrix::Zero(count + 1, 2 * n + symmetries_.cols());
      Vector left = Vector::Zero(count + 1);
      slope.topLeftCorner(count, 2 * n) = derivative();
      slope.topRightCorner(2 * n, symmetries_.cols()) = -flow_.orbit(symmetries_, g_, xi_);
      left.head(count) = equations(carrier_, g_, xi_);
      if (hold) {
        slope.block(count, n, 1, n) = along.transpose();
        left[count] = along.dot(xi_ - guess);
      }
      Vector step = -least_norm(slope, left);
      const double most = 0.5 * (1 + xi_.norm());
      step *= reach * std::min(1.0, most / std::max(1e-300, step.norm()));
      g_ = flow_.moved(g_, step.head(n));
      xi_ += step.segment(n, n);
      const double now = settle();
      if (now < residual) {
        residual = now;
        reach = std::min(1.0, 2 * reach);
        continue;
      }
      g_ = g;
      xi_ = xi;
      settle();
      reach = residual < kGood ? 0 : reach / 2;
    }
    return residual;
  }

  SteadyMotion linearise(const std::vector<std::string>& names, int family) {
    const int n = flow_.dim();
    const Matrix orbit = range_of(flow_.orbit(symmetries_, g_, xi_), 1e-9, 1);
    const Matrix whole = derivative();  // of W, phi, A xi - b
    Matrix bounds(flow_.held() + flow_.rows() + orbit.cols(), 2 * n);
    bounds << whole.bottomRows(flow_.held() + flow_.rows()), orbit.transpose();
    const Matrix basis = kernel_of(bounds, 1e-11);
    const Matrix reduced = basis.transpose() * whole.topRows(2 * n) * basis;
    const dense::Eigensystem solver = dense::eigen(reduced);
    std::vector<Eigen::Index> order;
    for (Eigen::Index i = 0; i < reduced.cols(); ++i) order.push_back(i);
    const auto& values = solver.values;
    const auto magnitude = [&](Eigen::Index i) { return std::abs(values[i]); };
    std::sort(order.begin(), order.end(),
              [&](auto i, auto j) { return magnitude(i) < magnitude(j); });
    SteadyMotion out;
    if (family < 0) {
      const double size = order.empty() ? 0 : magnitude(order.back());
      while (out.family < static_cast<int>(order.size()) &&
             magnitude(order[static_cast<size_t>(out.family)]) < 1e-7 * std::max(1.0, size)) {
        ++out.family;
      }
    } else {
      out.family = std::min(family, static_cast<int>(order.size()));
    }
    order.erase(order.begin(), order.begin() + out.family);
    std::sort(order.begin(), order.end(), [&](auto i, auto j) {
      return std::pair(values[i].real(), values[i].imag()) >
             std::pair(values[j].real(), values[j].imag());
    });
    out.neutral = static_cast<int>(orbit.cols()) + out.family;
    const double size = order.empty() ? 1 : std::max(1.0, values.cwiseAbs().maxCoeff());
    for (const Eigen::Index i : order) {
      out.eigenvalues.push_back(values[i]);
      const double condition =
          solver.left.row(i).norm();  // inf or NaN of one that has no eigenvector
      out.round_off.push_back(size * std::max(1e-9, std::fmin(1e-13 * condition, 1e-6)));
      const Eigen::VectorXcd both = basis.cast<Complex>() * solver.vectors.col(i);
      // Where the mode is along the symmetries, which are divided out, as a spin that decays: its velocities.
      const bool moves = both.head(n).norm() > 1e-9 * both.norm();
      const Eigen::VectorXcd mode = moves ? both.head(n) : both.tail(n);
      out.modes.push_back(parts_of(mode, names));
    }
    return out;
  }

 private:
  Vector field() const {
    Vector z(2 * flow_.dim());
    z << xi_, flow_.acceleration(g_, xi_);
    return z;
  }
  // The best symmetry to carry it, and what is left.
  double settle() {
    carrier_ = least_norm(flow_.orbit(symmetries_, g_, xi_), field());
    const Vector left = equations(carrier_, g_, xi_);
    return left.norm() / (1 + field().norm());
  }
  // W, phi, A xi - b.
  Vector equations(const Vector& carrier, const Vector& g, const Vector& xi) const {
    const int n = flow_.dim();
    Vector out(2 * n + flow_.held() + flow_.rows());
    Vector z(2 * n);
    z << xi, flow_.acceleration(g, xi);
    out << z - flow_.orbit(symmetries_, g, xi) * carrier, flow_.holonomic(g), flow_.slip(g, xi);
    return out;
  }
  // By (delta, nu), the carrier held.
  Matrix derivative() const {
    const int n = flow_.dim();
    Matrix out = Matrix::Zero(2 * n + flow_.held() + flow_.rows(), 2 * n);
    for (int j = 0; j < 2 * n; ++j) {
      const Vector unit = Vector::Unit(n, j % n);
      const bool velocity = j >= n;
      // Accelerations are quadratic in xi, so that the step may grow with it.
      const double step = velocity ? kStep * std::max(1.0, xi_.norm()) : kStep;
      differentiate(step, [&](double e, double weight) {
        out.col(j) += weight * (velocity ? equations(carrier_, g_, xi_ + e * unit)
                                         : equations(carrier_, flow_.moved(g_, e * unit), xi_));
      });
    }
    return out;
  }
  static std::vector<ModePart> parts_of(const Eigen::VectorXcd& mode,
                                        const std::vector<std::string>& names) {
    std::vector<ModePart> out;
    const double size = mode.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < mode.size(); ++i) {
      const double part = std::abs(mode[i]) / size;
      if (part > 0.05) out.push_back({names[static_cast<size_t>(i)], part});
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const auto& a, const auto& b) { return a.size > b.size; });
    return out;
  }

  const Flow& flow_;
  Vector g_, xi_;
  Matrix symmetries_;
  Vector carrier_;
};

SteadyMotion finish(const SystemModel& model, const Geometry& geometry, Finder& finder,
                    double residual, int family) {
  std::vector<std::string> names;
  for (const Component& component : components_of(model)) names.push_back(component.name);
  SteadyMotion out;
  if (residual < kGood) out = finder.linearise(names, family);
  out.found = residual < kGood;
  out.residual = residual;
  out.velocity.assign(finder.xi().begin(), finder.xi().end());
  out.element.resize(model.group.columns.size());
  geometry.coordinates(finder.g().data(), out.element.data());
  return out;
}

}  // namespace

SteadyMotion steady_motion(const Registry& registry, const SystemModel& model, const Start& guess,
                           int family) {
  if (!model.mechanics->autonomous())
    throw ConfigError({fmt::format("{}: depends on time: it has no steady motion", model.name)});
  const auto geometry = registry.geometry(model.group.name, "exp");
  if (geometry == nullptr)
    throw ConfigError(
        {fmt::format("{}: group '{}' has no retraction exp", model.name, model.group.name)});
  const Flow flow(geometry, model.mechanics);
  Vector g(geometry->size());
  geometry->from_coordinates(
      guess.configuration.empty() ? model.group.identity : guess.configuration, g.data());
  const Finder at_guess(flow, g, to_vector(guess.velocity));
  Finder finder = at_guess;
  double residual = finder.find(true);
  if (!(residual < kGood)) {
    Finder other = at_guess;
    if (const double found = other.find(false); found < residual)
      return finish(model, *geometry, other, found, family);
  }
  return finish(model, *geometry, finder, residual, family);
}

SteadyMotion steady_motion(const Registry& registry, const Simulation& run, int family) {
  const Run built = run.build();
  const SystemModel& model = built.system();
  const std::optional<double>& speed = run.config().speed;  // without the push of a file
  return steady_motion(
      registry, model,
      speed ? model.start_at_speed(*speed, built.config().from) : built.config().start, family);
}

int SteadyMotion::growing() const {
  int count = 0;
  for (size_t i = 0; i < eigenvalues.size(); ++i) count += eigenvalues[i].real() > round_off[i];
  return count;
}

}  // namespace hamel
