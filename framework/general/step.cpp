#include <hamel/framework/general/step.hpp>

#include <cmath>
#include <limits>

namespace hamel {

void GeneralStep::linearise(const Unknown& x, Unknown& f, Jacobian& j) const {
  const double size = x.lpNorm<Eigen::Infinity>();
  const double step = std::sqrt(std::numeric_limits<double>::epsilon()) * (size > 0 ? size : 1.0);
  residual(x, f);
  shifted_ = x;
  shifted_f_.resize(x.size());
  j.resize(x.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    shifted_[i] = x[i] + step;
    residual(shifted_, shifted_f_);
    j.col(i) = (shifted_f_ - f) / (shifted_[i] - x[i]);
    shifted_[i] = x[i];
  }
}

}  // namespace hamel
