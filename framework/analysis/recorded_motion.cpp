#include <hamel/framework/analysis/recorded_motion.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <hamel/framework/analysis/motion_formulas.hpp>
#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/framework/metric/metric.hpp>

namespace hamel {
namespace {

using graph::Number;
using Numbers = std::vector<Number>;

constexpr int kMostVelocities = 40;
constexpr size_t kLanes = 8;
constexpr double kSameTerms = 1e-9;  // relative to its matrix: formulas are those of the system

Numbers inputs_of(const char* name, size_t count) {
  Numbers out;
  for (size_t i = 0; i < count; ++i)
    out.push_back(graph::Recording::current().input(name + std::to_string(i + 1)));
  return out;
}

Numbers all_of(const graph::MotionTerms& terms) {
  Numbers out;
  const auto append = [&out](const Numbers& from) {
    out.insert(out.end(), from.begin(), from.end());
  };
  for (const Numbers& row : terms.inertia) append(row);
  for (const Numbers& row : terms.rows) append(row);
  append(terms.drift);
  append(terms.row_rates);
  append(terms.change);
  return out;
}

// Rates of coordinates, velocities and inputs along (delta, nu, u).
Numbers rates_along(const graph::MotionVariables& at, const Numbers& direction) {
  const size_t n = at.velocities.size();
  const auto first = direction.begin();
  const Numbers delta(first, first + static_cast<std::ptrdiff_t>(n));
  Numbers out = graph::along(at.coordinate_rates, at.velocities, delta);
  out.insert(out.end(), first + static_cast<std::ptrdiff_t>(n), direction.end());
  return out;
}

graph::Program::Outputs outputs_of(const Numbers& values, const std::vector<size_t>& places) {
  graph::Program::Outputs out;
  for (const size_t i : places) out.emplace_back("", values[i]);
  return out;
}

bool near(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double size) {
  return a.rows() == b.rows() && (a - b).norm() <= kSameTerms * size;
}

bool agrees(const RecordedMotion& recorded, const SystemModel& model, const Geometry& geometry,
            const Eigen::VectorXd& g) {
  const Mechanics& mechanics = *model.mechanics;
  const int n = mechanics.dim(), k = mechanics.constraint_count();
  Eigen::VectorXd xi(n), b(k), rates(k), change(n);
  for (int i = 0; i < n; ++i) xi[i] = std::sin(12.9898 * (i + 1));
  Eigen::MatrixXd inertia(n, n), a(k, n);
  mechanics.inertia(g.data(), inertia);
  mechanics.constraints(0, g.data(), a, b);
  const MotionValues found = recorded.at(g, xi);
  if (!near(found.inertia, inertia, inertia.norm()) || !near(found.rows, a, a.norm()) ||
      !near(found.drift, b, b.norm() + a.norm()))
    return false;
  if (!mechanics.exact_rates()) return true;
  mechanics.motion(geometry, 0, g.data(), xi, inertia, a, b, rates, change);
  return near(found.row_rates, rates, rates.norm() + a.norm()) &&
         near(found.change, change, change.norm() + inertia.norm());
}

Metric<> metric_of(const MotionValues& terms) {
  Metric<> out(static_cast<int>(terms.inertia.rows()), static_cast<int>(terms.rows.rows()));
  out.inertia = terms.inertia;
  out.a = terms.rows;
  out.b = terms.drift;
  out.factor(true, terms.rows.rows() > 0);
  return out;
}

}  // namespace

std::shared_ptr<const RecordedMotion> RecordedMotion::of(
    const SystemModel& model, std::shared_ptr<const Geometry> geometry, const Vector& g,
    const std::shared_ptr<const RecordedMotion>& known) {
  if (geometry->dim() > kMostVelocities || !model.contact_laws.empty()) return nullptr;
  std::shared_ptr<RecordedMotion> out(new RecordedMotion);
  std::shared_ptr<const Mechanics> mechanics = model.mechanics;
  if (model.drive) {
    const std::vector<InputTable> zeros(model.inputs.size(), InputTable{{}, {0}, false});
    mechanics = model.drive(std::make_shared<Inputs>(model.inputs, zeros));
  }
  try {
    graph::Recording recording;
    std::vector<std::string> names;
    for (const InputField& input : model.inputs) names.push_back(input.name);
    const graph::MotionVariables at(group_shape(model, *geometry), model.group.columns, model.rates,
                                    names);
    const Numbers values = all_of(recorded_terms(model, *mechanics, g.data(), at));
    out->n_ = geometry->dim();
    out->k_ = mechanics->constraint_count();
    out->inputs_ = static_cast<int>(names.size());
    for (size_t i = 0; i < values.size(); ++i) {
      out->constants_.push_back(values[i].constant() ? values[i].value() : 0);
      if (values[i].constant()) continue;
      out->places_.push_back(i);
      out->results_.push_back(values[i].node());
    }
    out->nodes_ = recording.nodes();
    if (known != nullptr && known->has_formulas_of(*out)) return known;
    Numbers moving = at.coordinates;
    moving.insert(moving.end(), at.velocities.begin(), at.velocities.end());
    moving.insert(moving.end(), at.inputs.begin(), at.inputs.end());
    const Numbers direction = inputs_of("direction", 2 * at.velocities.size() + names.size());
    const Numbers slopes = graph::along(values, moving, rates_along(at, direction));
    const auto code = [&](const Numbers& of, size_t width) {
      return std::make_unique<graph::Code>(
          std::make_shared<const graph::Program>(recording, outputs_of(of, out->places_)), width);
    };
    out->terms_ = code(values, 1);
    out->slopes_ = code(slopes, kLanes);
  } catch (const std::domain_error&) {
    return nullptr;
  }
  out->geometry_ = std::move(geometry);
  return agrees(*out, model, *out->geometry_, g) ? out : nullptr;
}

bool RecordedMotion::has_formulas_of(const RecordedMotion& other) const {
  const auto same = [](const graph::Node& a, const graph::Node& b) {
    return a.op == b.op && a.a == b.a && a.b == b.b && a.c == b.c && a.value == b.value;
  };
  return inputs_ == other.inputs_ && results_ == other.results_ && places_ == other.places_ &&
         constants_ == other.constants_ && std::ranges::equal(nodes_, other.nodes_, same);
}

MotionValues RecordedMotion::values_from(const double* values, size_t stride) const {
  const bool slopes = stride > 1;
  std::vector<double> all = slopes ? std::vector<double>(constants_.size(), 0.0) : constants_;
  for (size_t i = 0; i < places_.size(); ++i) all[places_[i]] = values[i * stride];
  const double* from = all.data();
  const auto take = [&from](Eigen::Index rows, Eigen::Index columns) {
    const Matrix out = Eigen::Map<const Matrix>(from, columns, rows).transpose();
    from += rows * columns;
    return out;
  };
  MotionValues out;
  out.inertia = take(n_, n_);
  out.rows = take(k_, n_);
  out.drift = take(k_, 1);
  out.row_rates = take(k_, 1);
  out.change = take(n_, 1);
  return out;
}

MotionValues RecordedMotion::at(const Vector& g, const Vector& xi, double t) const {
  std::vector<double> in(terms_->program().inputs().size(), 0.0), work(terms_->work_size()),
      out(places_.size());
  in[0] = t;
  geometry_->coordinates(g.data(), in.data() + 1);
  std::copy_n(xi.data(), n_, in.begin() + 1 + geometry_->columns());
  (*terms_)(in.data(), out.data(), work.data());
  return values_from(out.data(), 1);
}

std::vector<MotionValues> RecordedMotion::along(const Vector& g, const Vector& xi,
                                                const Matrix& directions) const {
  std::vector<double> place(slopes_->program().inputs().size(), 0.0);
  geometry_->coordinates(g.data(), place.data() + 1);
  std::copy_n(xi.data(), n_, place.begin() + 1 + geometry_->columns());
  const size_t first = 1 + static_cast<size_t>(geometry_->columns() + n_ + inputs_);
  std::vector<double> in(kLanes * place.size()), work(slopes_->work_size()),
      out(kLanes * places_.size());
  for (size_t i = 0; i < place.size(); ++i)
    std::fill_n(in.begin() + static_cast<long>(kLanes * i), kLanes, place[i]);
  std::vector<MotionValues> slopes;
  const auto count = static_cast<size_t>(directions.cols());
  for (size_t from = 0; from < count; from += kLanes) {
    const size_t lanes = std::min(kLanes, count - from);
    for (Eigen::Index i = 0; i < directions.rows(); ++i)
      for (size_t lane = 0; lane < kLanes; ++lane)
        in[kLanes * (first + static_cast<size_t>(i)) + lane] =
            lane < lanes ? directions(i, static_cast<Eigen::Index>(from + lane)) : 0;
    (*slopes_)(in.data(), out.data(), work.data());
    for (size_t lane = 0; lane < lanes; ++lane)
      slopes.push_back(values_from(out.data() + lane, kLanes));
  }
  return slopes;
}

Eigen::VectorXd RecordedMotion::acceleration(const Vector& g, const Vector& xi, double t) const {
  const MotionValues terms = at(g, xi, t);
  Vector out(n_);
  metric_of(terms).solve(terms.change, terms.row_rates, out);
  return out;
}

Eigen::MatrixXd RecordedMotion::acceleration_slopes(const Vector& g, const Vector& xi,
                                                    const std::vector<MotionValues>& slopes) const {
  const MotionValues terms = at(g, xi);
  Metric<> metric = metric_of(terms);
  Vector a(n_), slope(n_);
  metric.solve(terms.change, terms.row_rates, a);
  const Vector lambda = metric.multipliers(terms.change, a);
  Matrix out(n_, static_cast<Eigen::Index>(slopes.size()));
  for (Eigen::Index j = 0; j < out.cols(); ++j) {
    const MotionValues& d = slopes[static_cast<size_t>(j)];
    metric.solve(d.change - d.inertia * a + d.rows.transpose() * lambda, d.row_rates - d.rows * a,
                 slope);
    out.col(j) = slope;
  }
  return out;
}

}  // namespace hamel
