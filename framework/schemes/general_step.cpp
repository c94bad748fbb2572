#include <hamel/framework/schemes/general_step.hpp>

#include <cmath>
#include <limits>

namespace hamel {

void GeneralStep::differentiate(const Unknown& x, Unknown& f, Jacobian& j, bool in_frame) const {
  const double size = x.lpNorm<Eigen::Infinity>();
  const double step = std::cbrt(std::numeric_limits<double>::epsilon()) * (size > 0 ? size : 1.0);
  direction_.resize(x.size());
  shifted_.resize(x.size());
  shifted_f_.resize(x.size());
  f.resize(x.size());
  j.resize(x.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    direction_.setZero();
    direction_[i] = 1;
    if (in_frame) from_frame(direction_);
    const double length = step / direction_.lpNorm<Eigen::Infinity>();
    shifted_ = x + length * direction_;
    residual(shifted_, shifted_f_);
    shifted_ = x - length * direction_;
    residual(shifted_, f);
    j.col(i) = (shifted_f_ - f) / (2 * length);
  }
  residual(x, f);
}

}  // namespace hamel
