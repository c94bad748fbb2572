#include <hamel/framework/mechanics/coordinate_rates.hpp>

#include <algorithm>
#include <span>

#include <hamel/framework/lie/differences.hpp>

namespace hamel {
namespace {

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
    : factors_(group.factors), geometry_(std::move(geometry)) {
  const auto unknown = [](const GroupFactor& f) { return f.coordinate_rates == nullptr; };
  if (std::any_of(factors_.begin(), factors_.end(), unknown)) factors_.clear();
}

void CoordinateRates::add_pulled_back(const double* g, const double* x, const double* slope,
                                      Eigen::Ref<Eigen::VectorXd> out) const {
  if (factors_.empty()) return by_differences(g, slope, out);
  double* to = out.data();
  for (const GroupFactor& factor : factors_) {
    const auto columns = static_cast<size_t>(factor.columns);
    factor.add_pulled_back({x, columns}, {slope, columns}, {to, static_cast<size_t>(factor.dim)});
    x += factor.columns;
    slope += factor.columns;
    to += factor.dim;
  }
}

bool CoordinateRates::along(const double* x, const double* xi, double* out) const {
  for (const GroupFactor& factor : factors_) {
    const auto columns = static_cast<size_t>(factor.columns);
    factor.coordinate_rates({x, columns}, {xi, static_cast<size_t>(factor.dim)}, {out, columns});
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
