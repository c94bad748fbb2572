#include <hamel/framework/lie/geometry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace hamel {
namespace {
constexpr int kLargestFactor = 16;

// The numbers of a factor on which a map is 1.
template <class Factor>
void copy(const double* from, const Factor& factor, double* to) {
  for (int i = factor.at; i < factor.at + factor.dim; ++i) to[i] = from[i];
}
}  // namespace

ProductGeometry::ProductGeometry(std::vector<std::shared_ptr<const Geometry>> factors) {
  for (auto& geometry : factors) {
    if (geometry->dim() > kLargestFactor) {
      throw std::invalid_argument(fmt::format("a factor of dimension {}, expected at most {}",
                                              geometry->dim(), kLargestFactor));
    }
    factors_.push_back({geometry, dim_, geometry->dim(), geometry->adds(), size_, columns_});
    dim_ += geometry->dim();
    size_ += geometry->size();
    columns_ += geometry->columns();
  }
}

bool ProductGeometry::symmetric() const {
  return std::all_of(factors_.begin(), factors_.end(),
                     [](const Factor& f) { return f.geometry->symmetric(); });
}
bool ProductGeometry::one_parameter() const {
  return std::all_of(factors_.begin(), factors_.end(),
                     [](const Factor& f) { return f.geometry->one_parameter(); });
}
bool ProductGeometry::commuting() const {
  return std::all_of(factors_.begin(), factors_.end(),
                     [](const Factor& f) { return f.geometry->commuting(); });
}
bool ProductGeometry::adds() const {
  return std::all_of(factors_.begin(), factors_.end(), [](const Factor& f) { return f.adds; });
}
std::string ProductGeometry::domain() const {
  std::string out;
  for (size_t i = 0; i < factors_.size(); ++i) {
    out += fmt::format("{}{}: {}", i == 0 ? "" : "; ", i + 1, factors_[i].geometry->domain());
  }
  return out;
}
void ProductGeometry::compose(const double* g, const double* h, double* out) const {
  for (const Factor& f : factors_) {
    f.geometry->compose(g + f.element, h + f.element, out + f.element);
  }
}
void ProductGeometry::inverse(const double* g, double* out) const {
  for (const Factor& f : factors_) f.geometry->inverse(g + f.element, out + f.element);
}
void ProductGeometry::normalise(double* g) const {
  for (const Factor& f : factors_) f.geometry->normalise(g + f.element);
}
double ProductGeometry::defect(const double* g) const {
  double largest = 0;
  for (const Factor& f : factors_) {
    const double defect = f.geometry->defect(g + f.element);
    if (!(defect <= largest)) largest = defect;
  }
  return largest;
}
double ProductGeometry::rotation_angle(const double* g) const {
  double largest = std::numeric_limits<double>::quiet_NaN();
  for (const Factor& f : factors_) {
    largest = std::fmax(largest, f.geometry->rotation_angle(g + f.element));
  }
  return largest;
}

void ProductGeometry::Ad_transpose(const double* g, const double* mu, double* out) const {
  for (const Factor& f : factors_) {
    if (f.adds) copy(mu, f, out);
    else f.geometry->Ad_transpose(g + f.element, mu + f.at, out + f.at);
  }
}
void ProductGeometry::ad_transpose(const double* xi, const double* mu, double* out) const {
  for (const Factor& f : factors_) f.geometry->ad_transpose(xi + f.at, mu + f.at, out + f.at);
}
void ProductGeometry::Ad(const double* g, const double* xi, double* out) const {
  for (const Factor& f : factors_) {
    if (f.adds) copy(xi, f, out);
    else f.geometry->Ad(g + f.element, xi + f.at, out + f.at);
  }
}
void ProductGeometry::tau(const double* xi, double* out) const {
  for (const Factor& f : factors_) f.geometry->tau(xi + f.at, out + f.element);
}
bool ProductGeometry::tau_inverse(const double* g, double* out) const {
  return std::all_of(factors_.begin(), factors_.end(), [&](const Factor& f) {
    return f.geometry->tau_inverse(g + f.element, out + f.at);
  });
}
void ProductGeometry::dtau_right(const double* xi, double* matrix) const {
  std::fill_n(matrix, dim_ * dim_, 0.0);
  double block[kLargestFactor * kLargestFactor];
  for (const Factor& f : factors_) {
    const int n = f.dim;
    f.geometry->dtau_right(xi + f.at, block);
    double* to = matrix + f.at * (dim_ + 1);
    for (int j = 0; j < n; ++j) std::copy_n(block + j * n, n, to + j * dim_);
  }
}
void ProductGeometry::dtau_right_transpose(const double* xi, const double* m, double* out) const {
  for (const Factor& f : factors_) {
    if (f.adds) copy(m, f, out);
    else f.geometry->dtau_right_transpose(xi + f.at, m + f.at, out + f.at);
  }
}
void ProductGeometry::dtau_right_inverse_transpose(const double* xi, const double* p,
                                                   double* out) const {
  for (const Factor& f : factors_) {
    if (f.adds) copy(p, f, out);
    else f.geometry->dtau_right_inverse_transpose(xi + f.at, p + f.at, out + f.at);
  }
}
void ProductGeometry::dtau_left_inverse(const double* xi, const double* eta, double* out) const {
  for (const Factor& f : factors_) {
    if (f.adds) copy(eta, f, out);
    else f.geometry->dtau_left_inverse(xi + f.at, eta + f.at, out + f.at);
  }
}
void ProductGeometry::mixed_momentum(double s, const double* xi, const double* p, const double* nu,
                                     double* q) const {
  for (const Factor& f : factors_) {
    if (f.adds) {
      for (int i = f.at; i < f.at + f.dim; ++i) q[i] = p[i] - (1 - s) * nu[i];
    } else {
      f.geometry->mixed_momentum(s, xi + f.at, p + f.at, nu + f.at, q + f.at);
    }
  }
}
bool ProductGeometry::in_domain(const double* xi) const {
  return std::all_of(factors_.begin(), factors_.end(),
                     [&](const Factor& f) { return f.geometry->in_domain(xi + f.at); });
}
int ProductGeometry::columns() const { return columns_; }
void ProductGeometry::coordinates(const double* g, double* out) const {
  for (const Factor& f : factors_) f.geometry->coordinates(g + f.element, out + f.column);
}
void ProductGeometry::from_coordinates(std::span<const double> values, double* out) const {
  if (values.size() != static_cast<size_t>(columns_)) {
    throw std::invalid_argument(fmt::format("{} values, expected {}", values.size(), columns_));
  }
  for (const Factor& f : factors_) {
    f.geometry->from_coordinates(
        values.subspan(static_cast<size_t>(f.column), static_cast<size_t>(f.geometry->columns())),
        out + f.element);
  }
}

void ProductGeometry::nearest(std::span<const double> values, double* out) const {
  for (const Factor& f : factors_) {
    f.geometry->nearest(
        values.subspan(static_cast<size_t>(f.column), static_cast<size_t>(f.geometry->columns())),
        out + f.element);
  }
}

ProductGeometry::~ProductGeometry() = default;

bool ProductGeometry::recover_step(const double* delta, double s, double* xi) const {
  for (const Factor& f : factors_)
    if (!f.geometry->recover_step(delta + f.element, s, xi + f.at)) return false;
  return true;
}

}  // namespace hamel
