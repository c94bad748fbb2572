#include <hamel/framework/analysis/analysis.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/analysis/conserved.hpp>
#include <hamel/framework/analysis/recorded_rows.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/frame.hpp>

namespace hamel {
namespace {

constexpr int kMostAnalysed = 100;          // n^4 operations, n^3 numbers
constexpr double kMotionTolerance = 1e-12;  // far below the change that what is conserved may have

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// ad_x y.
Vector ad(const Geometry& geometry, const Vector& x, const Vector& y) {
  Vector out(x.size()), mu = Vector::Zero(x.size()), row(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {  // <mu, ad_x y> = <ad_x^T mu, y>
    mu[i] = 1;
    geometry.ad_transpose(x.data(), mu.data(), row.data());
    out[i] = row.dot(y);
    mu[i] = 0;
  }
  return out;
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

Analysis analyse(const Registry& registry, const std::string& system, const Parameters& parameters,
                 AnalysisOf what) {
  Simulation simulation(registry, system);
  Config config;
  config.system = system;
  config.parameters = parameters;
  config.scheme = "dop853";
  config.retraction = "exp";
  config.step = 0.005;
  config.rtol = kMotionTolerance;
  config.until = 1;
  config.output_step = 0.05;
  const Run run = simulation.config(config).build();
  const int dim = run.system().group.dim;
  if (dim > kMostAnalysed)
    throw ConfigError({fmt::format("{}: its dimension {} is above {}, the most that is analysed",
                                   system, dim, kMostAnalysed)});
  Analysis out;
  out.notes = run.notes();
  const auto geometry = registry.geometry(run.system().group.name, "exp");
  std::shared_ptr<const Mechanics> mechanics = run.system().mechanics;
  out.left_invariant = mechanics->left_invariant();
  const Eigen::Index n = mechanics->dim(), k = mechanics->constraint_count();
  Vector g(geometry->size()), b(k);
  geometry->from_coordinates(run.config().start.configuration, g.data());
  Matrix inertia(n, n), a(k, n);
  mechanics->inertia(g.data(), inertia);
  mechanics->constraints(0, g.data(), a, b);
  out.n = static_cast<int>(n);
  out.rows = static_cast<int>(k);
  out.rank = static_cast<int>(dense::rank(a, 1e-12));
  if (const auto& laws = run.system().contact_laws;
      out.rank < out.rows || std::ranges::any_of(laws, &ContactLaw::of_joint))
    if (!laws.empty())
      throw ConfigError(
          {fmt::format("{}: the rows of its contacts and joints with friction do not always hold, "
                       "{} of rank {}: "
                       "analyse it without `friction` and `stop`",
                       system, out.rows, out.rank)});
  out.m = out.n - out.rank;
  out.holonomic_rows = mechanics->holonomic_rows();
  out.frame = hamel_frame(inertia, a);

  const auto rows = recorded_rows(run.system(), *geometry, g.data());
  out.growth = growth_of(
      *geometry, *mechanics, g.data(), what == AnalysisOf::verdict ? kFewFields : kMostFields,
      natural_units(components_of(run.system()), *mechanics, g.data()), rows ? &*rows : nullptr);
  if (what == AnalysisOf::verdict) return out;
  out.structure.assign(static_cast<size_t>(out.m), Matrix::Zero(out.m, out.m));
  for (Eigen::Index i = 0; i < out.m; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const Vector along =
          out.frame.transpose() * (inertia * ad(*geometry, out.frame.col(i), out.frame.col(j)));
      for (Eigen::Index d = 0; d < out.m; ++d) {
        out.structure[static_cast<size_t>(d)](i, j) = along[d];
        out.structure[static_cast<size_t>(d)](j, i) = -along[d];
      }
    }
  }
  out.conserved = find_conserved(registry, run.config(), out.frame, *geometry, out.notes);
  return out;
}

}  // namespace hamel
