#include <hamel/framework/analysis/linearisation_slopes.hpp>

#include <cmath>
#include <vector>

#include <hamel/framework/mechanics/inputs.hpp>

namespace hamel::reduced {
namespace {

constexpr double kRoundOff = 1e-15;  // of what is evaluated at one place

}  // namespace

Slopes column_slopes(const SteadyEquations& equations, const CoordinateRates& rates,
                     const SteadyPoint& at, const Matrix& directions, const Vector& sizes) {
  const Flow& flow = equations.flow();
  const int n = equations.dim(), columns = equations.geometry().columns();
  Slopes out{.value = Matrix::Zero(columns + n, directions.cols()), .error = {}};
  out.error = out.value;
  Vector coordinates(columns);
  equations.geometry().coordinates(at.g.data(), coordinates.data());
  for (Eigen::Index j = 0; j < directions.cols(); ++j) {
    const Vector direction = directions.col(j), shift = direction.head(n);
    out.value.col(j).tail(n) = direction.tail(n);
    if (rates.along(coordinates.data(), shift.data(), out.value.col(j).data())) {
      out.error.col(j).head(columns) = kRoundOff * out.value.col(j).head(columns).cwiseAbs();
      continue;
    }
    // Step as large as a unit: columns are functions of the element, smooth at the scale of angles.
    const double part = shift.cwiseQuotient(sizes.head(n)).lpNorm<Eigen::Infinity>();
    if (!(part > 0)) continue;
    const auto moved = [&](double e) {
      Vector there(columns);
      equations.geometry().coordinates(flow.moved(at.g, e * shift).data(), there.data());
      return there;
    };
    const Derivative d =
        CentralDifferences(moved, steps_of_scale(1 / part, flow.steps(at.g, shift).grain))
            .derivative(1);
    out.value.col(j).head(columns) = d.value;
    out.error.col(j).head(columns) = d.error;
  }
  return out;
}

Slopes exact_input_slopes(const SteadyEquations& equations, const SteadyPoint& at,
                          const Vector& sizes) {
  const Flow& flow = equations.flow();
  const RecordedMotion& recorded = *flow.recorded();
  const int n = equations.dim(), k = flow.constraint_count(), count = recorded.inputs();
  Matrix directions = Matrix::Zero(2 * n + count, count);
  directions.bottomRows(count).setIdentity();
  const auto slopes_at = [&](const Vector& g, const Vector& xi) {
    const std::vector<MotionValues> terms = recorded.along(g, xi, directions);
    Matrix out(n + k, count);
    out.topRows(n) = recorded.acceleration_slopes(g, xi, terms);
    for (int j = 0; j < count; ++j)
      out.col(j).tail(k) =
          terms[static_cast<size_t>(j)].rows * xi - terms[static_cast<size_t>(j)].drift;
    return out;
  };
  Vector along(2 * n);
  for (int i = 0; i < 2 * n; ++i) along[i] = sizes[i] * std::sin(12.9898 * (i + 1));
  const Vector noise = noise_of(
      [&](double e) -> Vector {
        return slopes_at(flow.moved(at.g, e * along.head(n)), at.xi + e * along.tail(n)).reshaped();
      },
      0x1p-30);
  const Matrix value = slopes_at(at.g, at.xi);
  return {.value = value,
          .error = noise.reshaped(n + k, count).cwiseMax(kRoundOff * value.cwiseAbs())};
}

Slopes differenced_input_slopes(const SteadyEquations& equations,
                                const std::shared_ptr<const Geometry>& geometry,
                                const SystemModel& model, const SteadyPoint& at) {
  const std::vector<InputTable> zeros(model.inputs.size(), InputTable{{}, {0}, false});
  const auto inputs = std::make_shared<Inputs>(model.inputs, zeros);
  const Flow driven(geometry, model.drive(inputs), equations.flow().scales(), nullptr);
  const Vector extents = driven.extents(at.g);
  const Eigen::Index rows = driven.dim() + driven.constraint_count(),
                     count = std::ssize(model.inputs);
  Slopes out{.value = Matrix(rows, count), .error = Matrix(rows, count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto values = [&](double u) {
      inputs->set(static_cast<size_t>(i), u);
      Vector value(rows);
      value << driven.acceleration(at.g, at.xi, extents), driven.slip(at.g, at.xi);
      return value;
    };
    StepRange steps = steps_of_any_scale();
    steps.noise = noise_of(values, 1e-6);
    const Derivative d = CentralDifferences(values, steps).derivative(1);
    inputs->set(static_cast<size_t>(i), 0);
    out.value.col(i) = d.value;
    out.error.col(i) = d.error;
  }
  return out;
}

}  // namespace hamel::reduced
