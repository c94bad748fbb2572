#include <hamel/framework/mechanics/coordinate_rates.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <hamel/framework/lie/differences.hpp>

namespace hamel {
namespace {

using Rows = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
using Three = Eigen::Map<const Eigen::Vector3d>;

struct Operations {  // for differentiate_along
  const Geometry& geometry;
  void tau(const Eigen::VectorXd& xi, Eigen::VectorXd& out) const {
    geometry.tau(xi.data(), out.data());
  }
  void compose(const double* g, const Eigen::VectorXd& h, Eigen::VectorXd& out) const {
    geometry.compose(g, h.data(), out.data());
  }
};

}  // namespace

CoordinateRates::CoordinateRates(const GroupInfo& group, std::shared_ptr<const Geometry> geometry)
    : factors_(simple_factors(group)), geometry_(std::move(geometry)) {
  const auto unknown = [](const SimpleFactor& f) { return f.name == "heisenberg"; };
  if (std::any_of(factors_.begin(), factors_.end(), unknown)) factors_.clear();
}

void CoordinateRates::add_pulled_back(const double* g, const double* x, const double* slope,
                                      Eigen::Ref<Eigen::VectorXd> out) const {
  if (factors_.empty()) return by_differences(g, slope, out);
  double* to = out.data();
  for (const SimpleFactor& factor : factors_) {
    if (factor.shape) {
      for (int i = 0; i < factor.dim; ++i) to[i] += slope[i];
    } else if (factor.name == "se2") {
      const double c = std::cos(x[0]), s = std::sin(x[0]);
      to[0] += slope[0];
      to[1] += c * slope[1] + s * slope[2];
      to[2] += c * slope[2] - s * slope[1];
    } else {  // so3, se3
      const Rows rotation(x);
      const Eigen::Matrix3d b = rotation.transpose() * Rows(slope);
      to[0] += b(2, 1) - b(1, 2);
      to[1] += b(0, 2) - b(2, 0);
      to[2] += b(1, 0) - b(0, 1);
      if (factor.dim == 6)
        Eigen::Map<Eigen::Vector3d>(to + 3) += rotation.transpose() * Three(slope + 9);
    }
    x += factor.columns;
    slope += factor.columns;
    to += factor.dim;
  }
}

bool CoordinateRates::along(const double* x, const double* xi, double* out) const {
  for (const SimpleFactor& factor : factors_) {
    if (factor.shape) {
      std::copy(xi, xi + factor.dim, out);
    } else if (factor.name == "se2") {
      const double c = std::cos(x[0]), s = std::sin(x[0]);
      out[0] = xi[0];
      out[1] = c * xi[1] - s * xi[2];
      out[2] = s * xi[1] + c * xi[2];
    } else {  // so3, se3
      const Rows rotation(x);
      const Three turn(xi);
      for (int i = 0; i < 3; ++i)  // rows of R xi^
        Eigen::Map<Eigen::Vector3d>(out + 3 * i) = Eigen::Vector3d(rotation.row(i)).cross(turn);
      if (factor.dim == 6) Eigen::Map<Eigen::Vector3d>(out + 9) = rotation * Three(xi + 3);
    }
    x += factor.columns;
    out += factor.columns;
    xi += factor.dim;
  }
  return !factors_.empty();
}

void CoordinateRates::by_differences(const double* g, const double* slope,
                                     Eigen::Ref<Eigen::VectorXd> out) const {
  Eigen::VectorXd axis, step(geometry_->dim()), moved(geometry_->size()), x(geometry_->columns());
  const Eigen::Map<const Eigen::VectorXd> slopes(slope, x.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    axis = Eigen::VectorXd::Unit(out.size(), i);
    differentiate_along(Operations{*geometry_}, g, axis, step, moved, [&](double, double weight) {
      geometry_->coordinates(moved.data(), x.data());
      out[i] += weight * slopes.dot(x);
    });
  }
}

}  // namespace hamel
