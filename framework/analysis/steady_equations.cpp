#include <hamel/framework/analysis/steady_equations.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/analysis/state_units.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/mechanics/natural_units.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/run/plan/start_names.hpp>

namespace hamel::reduced {
namespace {

constexpr double kSettled = 1e-14;    // residual that is round-off, in own units
constexpr double kNewtonRank = 1e-8;  // below it the slope is round-off: along families
Vector to_vector(const std::vector<double>& v) {
  return Eigen::Map<const Vector>(v.data(), static_cast<Eigen::Index>(v.size()));
}

std::shared_ptr<const RecordedMotion> recorded_of(const SystemModel& model,
                                                  const std::shared_ptr<const Geometry>& geometry,
                                                  const Vector& g,
                                                  const SteadyEquations* neighbour) {
  return RecordedMotion::of(model, geometry, g,
                            neighbour == nullptr ? nullptr : neighbour->flow().recorded());
}

std::shared_ptr<const Geometry> geometry_of(const Registry& registry, const SystemModel& model) {
  if (!model.mechanics->autonomous())
    throw ConfigError({fmt::format("{}: depends on time: it has no steady motion", model.name)});
  if (!model.contact_laws.empty())
    throw ConfigError(
        {fmt::format("{}: its contacts may slide: steady motions are those of the system without "
                     "friction, leave it out",
                     model.name)});
  auto geometry = registry.geometry(model.group.name, "exp");
  if (geometry == nullptr)
    throw ConfigError(
        {fmt::format("{}: group '{}' has no retraction exp", model.name, model.group.name)});
  return geometry;
}

Vector element_of(const Geometry& geometry, const SystemModel& model, const Start& start) {
  Vector out(geometry.size());
  geometry.from_coordinates(
      start.configuration.empty() ? model.group.identity : start.configuration, out.data());
  return out;
}

}  // namespace

Vector least_norm(const Matrix& a, const Vector& b, double least) {
  if (a.cols() == 0) return Vector(0);
  const double most = a.colwise().norm().maxCoeff();
  return dense::least_norm(a, b, most < 1 ? std::min(0.5, least / std::max(1e-300, most)) : least);
}

Start guess_of(const Simulation& run, const Run& built) {
  const Config& config = run.config();
  if (!config.speed || (!config.start_values.empty() && !built.system().start_with))
    return built.config().start;
  Simulation unpushed = run;
  unpushed.with(&Config::speed, std::optional<double>{}).with(&Config::start_values, {});
  if (config.start_values.empty()) {
    unpushed.start(built.system().start_at_speed(*config.speed, built.config().from));
  } else {
    std::map<std::string, double> values = values_by_name(built.system(), config.start_values);
    values["speed"] = *config.speed;
    unpushed.start(built.system().start_with(values, built.config().from, false));
  }
  return unpushed.build().config().start;
}

ModeNames::ModeNames(const SystemModel& model) {
  const std::vector<Component> components = components_of(model);
  coordinates.resize(components.size());
  for (const Component& component : components) velocities.push_back(component.name);
  for (const ShapeCoordinate& shape : shape_of(model.group))
    coordinates[static_cast<size_t>(shape.component)] = shape.name;
}

SteadyEquations::SteadyEquations(const Registry& registry, const SystemModel& model,
                                 const Start& guess, const SteadyEquations* neighbour)
    : geometry_(geometry_of(registry, model)),
      guess_g_(element_of(*geometry_, model, guess)),
      flow_(geometry_, model.mechanics,
            to_vector(own_scales(components_of(model), *model.mechanics, guess_g_.data())),
            recorded_of(model, geometry_, guess_g_, neighbour)),
      guess_xi_(to_vector(guess.velocity)),
      names_(model) {
  along_ = flow_.momentum(guess_g_, guess_xi_).normalized();
  if (neighbour != nullptr) {
    flow_.set_units(neighbour->flow_.units());
    reach_ = neighbour->reach_;
    return;
  }
  reach_.extents = flow_.extents(guess_g_);
  flow_.set_units(units());
  find_reach();
}

const Matrix& SteadyEquations::symmetries() const {
  if (!has_symmetries_) symmetries_ = flow_.symmetries(guess_g_, guess_xi_, reach_.steps);
  has_symmetries_ = true;
  return symmetries_;
}

Matrix SteadyEquations::orbit(const SteadyPoint& at) const {
  return range_of(flow_.orbit(symmetries(), at.g, at.xi), 1e-9, 1);
}

Vector SteadyEquations::field(const Vector& g, const Vector& xi, const Reach& reach) const {
  Vector z(2 * dim());
  z << xi, flow_.acceleration(g, xi, reach.extents);
  return z;
}

const StateUnits& SteadyEquations::scales() const {
  if (scales_.columns.size() == 0) scales_ = state_units({this});
  return scales_;
}

SteadyPoint SteadyEquations::carried(Vector g, Vector xi) const {
  const Vector z = field(g, xi, reach_);
  SteadyPoint out{.g = std::move(g), .xi = std::move(xi), .generator = {}};
  out.generator = symmetries() * least_norm(flow_.orbit(symmetries(), out.g, out.xi), z);
  return out;
}

SteadyPoint SteadyEquations::at(Vector g, Vector xi) const {
  SteadyPoint out = carried(std::move(g), std::move(xi));
  const Vector left = equations(out.generator, out.g, out.xi, reach_);
  const double size = 1 + out.xi.cwiseQuotient(scales().columns.tail(dim())).norm();
  out.residual = scales().rows.head(left.size()).cwiseProduct(left).norm() / size;
  return out;
}

Vector SteadyEquations::equations(const Vector& generator, const Vector& g, const Vector& xi,
                                  const Reach& reach) const {
  Vector out(2 * dim() + flow_.holonomic_rows() + flow_.constraint_count());
  out << field(g, xi, reach) - flow_.carrier(generator, g, xi), flow_.holonomic(g),
      flow_.slip(g, xi);
  return out;
}

Vector SteadyEquations::values(const SteadyPoint& at, bool held) const {
  Vector out = equations(at.generator, at.g, at.xi, reach_);
  if (!held) return out;
  out.conservativeResize(out.size() + 1);
  out[out.size() - 1] = along_.dot(at.xi - guess_xi_);
  return out;
}

Vector SteadyEquations::displaced(const SteadyPoint& at, bool held, const Vector& step,
                                  const Vector& carrier) const {
  const int n = dim();
  SteadyPoint there{.g = flow_.moved(at.g, step.head(n)),
                    .xi = at.xi + step.tail(n),
                    .generator = at.generator + carrier};
  return values(there, held);
}

Matrix SteadyEquations::carriers(const SteadyPoint& at) const {
  const Matrix orbit = this->orbit(at), all = flow_.orbit(symmetries(), at.g, at.xi);
  Matrix out(2 * dim(), orbit.cols());
  for (Eigen::Index i = 0; i < orbit.cols(); ++i)
    out.col(i) = symmetries() * least_norm(all, orbit.col(i));
  return out;
}

// W = (xi - Ad_g^-1 zeta - eta, a + ad_eta xi), and d(Ad_g^-1 zeta) = -ad_delta Ad_g^-1 zeta.
Matrix SteadyEquations::derivative(const SteadyPoint& at) const {
  if (flow_.recorded() == nullptr) return derivative_by_differences(at);
  const int n = dim();
  const Matrix slopes = flow_.slopes(at.g, at.xi);
  Matrix out(n + slopes.rows(), 2 * n);
  out.topLeftCorner(n, n) = -flow_.ad(flow_.Ad_inverse(at.g) * at.generator.head(n));
  out.topRightCorner(n, n).setIdentity();
  out.bottomRows(slopes.rows()) = slopes;
  out.block(n, n, n, n) += flow_.ad(at.generator.tail(n));
  return out;
}

Matrix SteadyEquations::derivative_by_differences(const SteadyPoint& at) const {
  const int n = dim();
  Matrix out = Matrix::Zero(2 * n + flow_.holonomic_rows() + flow_.constraint_count(), 2 * n);
  for (int j = 0; j < 2 * n; ++j) {
    const Vector along = Vector::Unit(n, j % n);
    const bool velocity = j >= n;
    differentiate(reach_.steps[j], [&](double e, double weight) {
      out.col(j) += weight * (velocity ? equations(at.generator, at.g, at.xi + e * along, reach_)
                                       : equations(at.generator, flow_.moved(at.g, e * along),
                                                   at.xi, reach_));
    });
  }
  return out;
}

Matrix SteadyEquations::slope(const SteadyPoint& at, bool held) const {
  const Matrix of_state = derivative(at);
  const Matrix orbit = this->orbit(at);
  Matrix out = Matrix::Zero(of_state.rows() + (held ? 1 : 0), of_state.cols() + orbit.cols());
  out.topLeftCorner(of_state.rows(), of_state.cols()) = of_state;
  out.topRightCorner(orbit.rows(), orbit.cols()) = -orbit;
  if (held) {
    out.block(of_state.rows(), dim(), 1, dim()) = along_.transpose();
  }
  return out;
}

Matrix SteadyEquations::slope_across(const SteadyPoint& at, bool held) const {
  const Vector& columns = scales().columns;
  Matrix slope = this->slope(at, held);
  slope = (scales().rows.head(slope.rows()).asDiagonal() * slope).eval();
  const Matrix carriers = range_of(slope.rightCols(slope.cols() - columns.size()), 1e-9);
  const Matrix own = slope.leftCols(columns.size()) * columns.asDiagonal();
  return own - carriers * (carriers.transpose() * own);
}

Vector SteadyEquations::newton_step(const SteadyPoint& at, bool held) const {
  const Vector left = values(at, held);
  return -least_norm(slope_across(at, held), scales().rows.head(left.size()).cwiseProduct(left),
                     kNewtonRank);
}

Vector SteadyEquations::find(SteadyPoint& at, bool held, int steps) const {
  const int n = dim();
  const Vector& columns = scales().columns;
  Vector moved = Vector::Zero(2 * n);
  double reach = 1;
  for (int k = 0; k < steps && at.residual > kSettled && reach > 1e-3; ++k) {
    Vector step = newton_step(at, held);
    const double most = 0.5 * (1 + at.xi.cwiseQuotient(columns.tail(n)).norm());
    step = columns.cwiseProduct(step * reach * std::min(1.0, most / std::max(1e-300, step.norm())));
    const SteadyPoint next = this->at(flow_.moved(at.g, step.head(n)), at.xi + step.tail(n));
    if (next.residual < at.residual) {
      const bool settled = at.residual < kGood && next.residual > 0.5 * at.residual;
      at = next;
      moved += step;
      reach = settled ? 0 : std::min(1.0, 2 * reach);
    } else {
      reach = at.residual < kGood ? 0 : reach / 2;
    }
  }
  return moved;
}

// Newton's method that approaches rest by halves has found no motion: its equations, of second
// order in xi, are as far from zero as they were, beside xi^2.
void SteadyEquations::measure_by_itself(SteadyPoint& at) const {
  const Vector units = scales().columns.tail(dim());
  const double size = at.xi.cwiseQuotient(units).norm(),
               first = guess_xi_.cwiseQuotient(units).norm();
  if (!(size > 0 && size < 1e-3 * first && at.residual < 1e-3 * size)) return;
  if (newton_step(at, false).tail(dim()).norm() < 0.1 * size) return;
  at.residual /= std::pow(size / first, 2);
}

SteadyPoint SteadyEquations::find_near_guess(bool& held) const {
  SteadyPoint out = guess();
  held = true;
  find(out, true);
  if (out.residual < kGood) {
    // Held is what can be chosen: of isolated steady motions nothing is.
    const Singular all = singular(out, false);
    const Matrix beside = this->beside(out, all, (all.values.array() < kNull * all.size).count());
    held = (along_.transpose() * beside.bottomRows(dim())).norm() > 1e-6;
    return out;
  }
  SteadyPoint other = guess();
  find(other, false);
  measure_by_itself(other);
  if (!(other.residual < out.residual)) return out;
  held = false;
  return other;
}

SteadyEquations::Singular SteadyEquations::singular(const SteadyPoint& at, bool held) const {
  const Matrix whole = slope(at, held);
  const dense::Svd svd = dense::svd(whole, Eigen::ComputeFullV);
  Singular out{.values = Vector::Zero(whole.cols()), .right = svd.v.topRows(2 * dim())};
  const Vector& values = svd.values;
  out.values.tail(values.size()) = values.reverse();
  out.right = out.right.rowwise().reverse().eval();
  out.size = values.size() > 0 ? values[0] : 0;
  return out;
}

Matrix SteadyEquations::beside(const SteadyPoint& at, const Singular& singular,
                               Eigen::Index count) const {
  const Matrix orbit = this->orbit(at);
  const Matrix null = singular.right.leftCols(count);
  return range_of(null - orbit * (orbit.transpose() * null), 1e-6, 1);
}

}  // namespace hamel::reduced
