#include <hamel/framework/analysis/analysis.hpp>

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/mechanics/place.hpp>

namespace hamel {
namespace {

constexpr int kMostAnalysed = 100;  // n^4 operations, n^3 numbers

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// The fields X_a, and their brackets at one configuration.
class Frame {
 public:
  Frame(const Geometry& geometry, const Mechanics& mechanics, const Vector& g, const Matrix& frame)
      : geometry_(geometry), mechanics_(mechanics), place_(mechanics), g_(g), frame_(frame) {}

  /// [X_a, X_b](g).
  Vector bracket(Eigen::Index a, Eigen::Index b) {
    Vector out = ad(frame_.col(a), frame_.col(b));
    if (!mechanics_.constant_constraints()) out += derivative(b, a) - derivative(a, b);
    return out;
  }

 private:
  Vector field(Eigen::Index a, const Vector& g) {
    place_.set(mechanics_, 0, g.data());
    place_.b.setZero();
    Vector e = frame_.col(a);
    place_.admissible(place_.inertia * e, e);  // the I-orthogonal projection onto ker A(g)
    return e;
  }
  // dX_a(g) X_b(g), by sixth-order central differences.
  Vector derivative(Eigen::Index a, Eigen::Index b) {
    constexpr double weights[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
    const double unit = 0.01 / frame_.col(b).norm();
    Vector out = Vector::Zero(frame_.rows()), moved(g_.size());
    for (int k = -3; k <= 3; ++k) {
      if (k == 0) continue;
      const Vector step = k * unit * frame_.col(b);
      geometry_.tau(step.data(), moved.data());
      geometry_.compose(g_.data(), moved.data(), moved.data());
      out += (k > 0 ? 1 : -1) * weights[std::abs(k) - 1] / unit * field(a, moved);
    }
    return out;
  }
  Vector ad(const Vector& x, const Vector& y) const {  // <mu, ad_x y> = <ad_x^T mu, y>
    Vector out(x.size()), mu = Vector::Zero(x.size()), row(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      mu[i] = 1;
      geometry_.ad_transpose(x.data(), mu.data(), row.data());
      out[i] = row.dot(y);
      mu[i] = 0;
    }
    return out;
  }

  const Geometry& geometry_;
  const Mechanics& mechanics_;
  Place<> place_;
  Vector g_;
  Matrix frame_;
};

std::string combination(const Vector& weights, const std::vector<std::string>& names) {
  std::string out;
  const double largest = weights.lpNorm<Eigen::Infinity>();
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    const double w = weights[i] / largest;
    if (std::abs(w) < 1e-6) continue;
    const std::string size =
        std::abs(std::abs(w) - 1) < 1e-6 ? "" : fmt::format("{:.6g} ", std::abs(w));
    out += fmt::format("{}{}{}", out.empty() ? (w < 0 ? "-" : "") : (w < 0 ? " - " : " + "), size,
                       names[static_cast<size_t>(i)]);
  }
  return out;
}

// Reduced row echelon form of the rows, so that each quantity has as few terms as possible.
Matrix simplest(Matrix rows) {
  Eigen::Index lead = 0;
  for (Eigen::Index j = 0; j < rows.cols() && lead < rows.rows(); ++j) {
    Eigen::Index pivot = 0;
    const double size = rows.col(j).tail(rows.rows() - lead).cwiseAbs().maxCoeff(&pivot);
    if (size < 1e-6) continue;
    rows.row(lead).swap(rows.row(lead + pivot));
    rows.row(lead) /= rows(lead, j);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      if (i != lead) rows.row(i) -= rows(i, j) * rows.row(lead);
    }
    ++lead;
  }
  return rows;
}

void find_conserved(const Registry& registry, const std::string& system,
                    const Parameters& parameters, const Result& first, const Geometry& geometry,
                    Analysis& out) {
  const auto n = static_cast<Eigen::Index>(out.n);
  std::vector<std::string> names = {"E"};
  for (int i = 1; i <= out.n; ++i) names.push_back(fmt::format("J{}", i));
  for (int i = 1; i <= out.n; ++i) names.push_back(fmt::format("xi{}", i));
  const auto width = static_cast<Eigen::Index>(names.size());
  Matrix values(0, width), changes(0, width);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int motion = 0; motion < 4; ++motion) {
    Config config = first.config;
    config.parameters = parameters;
    if (motion > 0) {
      for (double& v : config.start.velocity) v += 0.3 * normal(random);
    }
    Simulation simulation(registry, system);
    const Result run = simulation.config(config).run();
    if (!run.status.ok) continue;
    const size_t columns = run.system.group.columns.size();
    Matrix rows(static_cast<Eigen::Index>(run.trajectory.rows()), width);
    Vector g(geometry.size()), inverse(geometry.size()), spatial(n);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const auto row = run.trajectory.row(static_cast<size_t>(i));
      geometry.from_coordinates(row.subspan(1, columns), g.data());
      geometry.inverse(g.data(), inverse.data());
      const double* momentum = row.data() + run.trajectory.index("mu1");
      geometry.Ad_transpose(inverse.data(), momentum, spatial.data());
      rows(i, 0) = row[run.trajectory.index("energy")];
      rows.row(i).segment(1, n) = spatial.transpose();
      rows.row(i).tail(n) = Eigen::Map<const Vector>(row.data() + 1 + columns, n).transpose();
    }
    Matrix change = rows.rowwise() - rows.row(0);
    values.conservativeResize(values.rows() + rows.rows(), width);
    values.bottomRows(rows.rows()) = rows;
    changes.conservativeResize(changes.rows() + rows.rows(), width);
    changes.bottomRows(rows.rows()) = change;
  }
  if (values.rows() == 0) return;
  // The combinations that do not change, orthogonal to those that are zero on every motion.
  const Eigen::JacobiSVD<Matrix> all(values, Eigen::ComputeThinV);
  const double scale = all.singularValues()[0];
  Eigen::Index meaningful = 0;
  while (meaningful < width && all.singularValues()[meaningful] > 1e-7 * scale) ++meaningful;
  const Matrix basis = all.matrixV().leftCols(meaningful);
  const Matrix reduced = changes * basis;
  const Eigen::JacobiSVD<Matrix> svd(reduced, Eigen::ComputeThinV);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < meaningful; ++i) {
    if (svd.singularValues()[i] < 1e-7 * scale) kept.push_back(i);
  }
  Matrix found(static_cast<Eigen::Index>(kept.size()), width);
  for (size_t i = 0; i < kept.size(); ++i) {
    found.row(static_cast<Eigen::Index>(i)) = (basis * svd.matrixV().col(kept[i])).transpose();
  }
  if (found.rows() > 0) found = simplest(found);
  for (Eigen::Index i = 0; i < found.rows(); ++i) {
    const Vector weights = found.row(i).transpose();
    const double size = std::max((values * weights).cwiseAbs().maxCoeff(), 1e-300);
    out.conserved.push_back(
        {combination(weights, names), (changes * weights).cwiseAbs().maxCoeff() / size});
  }
}

}  // namespace

Analysis::Analysis() = default;
Analysis::Analysis(const Analysis&) = default;
Analysis& Analysis::operator=(const Analysis&) = default;
Analysis::~Analysis() = default;

std::optional<bool> Analysis::integrable() const {
  if (rows == 0 || std::max(growth.nearby, growth.dimensions.back()) > m) return false;
  return growth.decided() ? std::optional(true) : std::nullopt;
}

Analysis analyse(const Registry& registry, const std::string& system,
                 const Parameters& parameters) {
  Simulation simulation(registry, system);
  Config config;
  config.system = system;
  config.parameters = parameters;
  config.scheme = "lift";
  config.retraction = "exp";
  config.compose = "kahan_li6";
  config.step = 0.005;
  config.until = 1;
  config.every = 10;
  const int dim = simulation.config(config).build().system().group.dim;
  if (dim > kMostAnalysed)
    throw ConfigError({fmt::format("{}: its dimension {} is above {}, the most that is analysed",
                                   system, dim, kMostAnalysed)});
  const Result run = simulation.run();
  Analysis out;
  out.notes = run.notes;
  const auto geometry = registry.geometry(run.system.group.name, "exp");
  std::shared_ptr<const Mechanics> mechanics = run.system.mechanics;
  out.left_invariant = mechanics->left_invariant();
  const Eigen::Index n = mechanics->dim(), k = mechanics->rows();
  Vector g(geometry->size()), b(k);
  geometry->from_coordinates(run.config.start.configuration, g.data());
  Matrix inertia(n, n), a(k, n);
  mechanics->inertia(g.data(), inertia);
  mechanics->constraints(0, g.data(), a, b);
  out.n = static_cast<int>(n);
  out.rows = static_cast<int>(k);
  out.rank = static_cast<int>(Eigen::ColPivHouseholderQR<Matrix>(a).setThreshold(1e-12).rank());
  out.m = out.n - out.rank;
  out.holonomic_rows = mechanics->holonomic_rows();
  out.frame = hamel_frame(inertia, a);

  out.growth = growth_of(*geometry, *mechanics, g.data());
  Frame fields(*geometry, *mechanics, g, out.frame);
  out.structure.assign(static_cast<size_t>(out.m), Matrix::Zero(out.m, out.m));
  for (Eigen::Index i = 0; i < out.m; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const Vector along = out.frame.transpose() * (inertia * fields.bracket(i, j));
      for (Eigen::Index d = 0; d < out.m; ++d) {
        out.structure[static_cast<size_t>(d)](i, j) = along[d];
        out.structure[static_cast<size_t>(d)](j, i) = -along[d];
      }
    }
  }
  find_conserved(registry, system, parameters, run, *geometry, out);
  return out;
}

}  // namespace hamel
