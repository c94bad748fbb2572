#include <hamel/framework/general/step.hpp>

#include <cmath>
#include <limits>

namespace hamel {

void GeneralStep::linearise(const Unknown& x, Unknown& f, Jacobian& j) const {
  const double size = x.lpNorm<Eigen::Infinity>();
  const double step = std::cbrt(std::numeric_limits<double>::epsilon()) * (size > 0 ? size : 1.0);
  shifted_ = x;
  shifted_f_.resize(x.size());
  f.resize(x.size());
  j.resize(x.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    shifted_[i] = x[i] + step;
    const double above = shifted_[i];
    residual(shifted_, shifted_f_);
    shifted_[i] = x[i] - step;
    residual(shifted_, f);
    j.col(i) = (shifted_f_ - f) / (above - shifted_[i]);
    shifted_[i] = x[i];
  }
  residual(x, f);
}

}  // namespace hamel
