// All solutions of one contact: open, sticking, and sliding in every direction that (1) admits.
#include <cmath>
#include <complex>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <hamel/framework/contact/contact_problem.hpp>

namespace hamel {
namespace {

using Complex = std::complex<double>;
// Inequalities hold to so much of the size of c or P.
constexpr double kClosed = 1e-12;
// Two solutions are one where they differ by less, relative to P.
constexpr double kSame = 1e-9;

// f(theta) = linear . d + q11 c^2 + q12 c s + q22 s^2, d = (c, s): zero where the slip that is left
// has the direction d of sliding.
struct SlideEquation {
  Eigen::Vector2d linear = Eigen::Vector2d::Zero();
  double q11 = 0, q12 = 0, q22 = 0;

  double scale() const {
    return std::max(
        {std::abs(linear[0]), std::abs(linear[1]), std::abs(q11), std::abs(q12), std::abs(q22)});
  }
  double value(double c, double s) const {
    return linear[0] * c + linear[1] * s + q11 * c * c + q12 * c * s + q22 * s * s;
  }
  double rate(double c, double s) const {
    return -linear[0] * s + linear[1] * c + 2 * (q22 - q11) * c * s + q12 * (c * c - s * s);
  }
};

// cross(d, gamma_t) of P = P_n (1, -mu d), gamma_n = 0, times G_nn - mu G_nt d, so that nothing is
// divided by what may vanish:
//   -c_n cross(d, G_tn - mu G_tt d) + cross(d, c_t) (G_nn - mu G_nt d);
// with a given bound B cross(d, c_t - B G_tt d).
SlideEquation slide_equation(const Eigen::Matrix3d& g, const Eigen::Vector3d& c,
                             const ContactBlock& block) {
  SlideEquation out;
  if (!block.normal) {
    const double b = block.bound;
    out.linear = {c[1], -c[0]};
    out.q11 = -b * g(1, 0);
    out.q12 = -b * (g(1, 1) - g(0, 0));
    out.q22 = b * g(0, 1);
    return out;
  }
  const double mu = block.friction, cn = c[0], gnn = g(0, 0);
  out.linear = {-cn * g(2, 0) + gnn * c[2], cn * g(1, 0) - gnn * c[1]};
  out.q11 = mu * (cn * g(2, 1) - c[2] * g(0, 1));
  out.q12 = mu * (cn * (g(2, 2) - g(1, 1)) - c[2] * g(0, 2) + c[1] * g(0, 1));
  out.q22 = mu * (-cn * g(1, 2) + c[1] * g(0, 2));
  return out;
}

// The directions where f = 0: a quartic in z = exp(i theta),
//   a2 z^4 + a1 z^3 + a0 z^2 + conj(a1) z + conj(a2) = 0,
// its roots next to the circle, polished on f. A small a2 sends two of them away from it.
class SlideDirections {
 public:
  explicit SlideDirections(const SlideEquation& f) : f_(f), scale_(f.scale()) {
    const Complex a2((f.q11 - f.q22) / 4, -f.q12 / 4), a1 = Complex(f.linear[0], -f.linear[1]) / 2.;
    const double a0 = (f.q11 + f.q22) / 2;
    if (!(scale_ > 0)) return;
    if (std::abs(a2) > 1e-9 * scale_) {
      Eigen::Matrix4cd companion = Eigen::Matrix4cd::Zero();
      companion.row(0) << -a1 / a2, -a0 / a2, -std::conj(a1) / a2, -std::conj(a2) / a2;
      companion.diagonal(-1).setOnes();
      const Eigen::ComplexEigenSolver<Eigen::Matrix4cd> roots(companion, false);
      for (const Complex& z : roots.eigenvalues()) polish(z);
    } else if (std::abs(a1) > 1e-15 * scale_) {
      const Complex root = std::sqrt(Complex(a0 * a0) - 4. * std::norm(a1));
      polish((-a0 + root) / (2. * a1));
      polish((-a0 - root) / (2. * a1));
    }
  }
  int count() const { return count_; }
  Eigen::Vector2d operator[](int i) const { return all_[static_cast<std::size_t>(i)]; }

 private:
  void polish(Complex z) {
    if (!(std::abs(std::log(std::abs(z))) < 0.1)) return;
    double angle = std::arg(z), c = 1, s = 0, value = 0;
    for (int k = 0; k < 12; ++k) {
      c = std::cos(angle);
      s = std::sin(angle);
      value = f_.value(c, s);
      const double rate = f_.rate(c, s);
      if (!(std::abs(value) > 1e-17 * scale_) || rate == 0) break;
      angle -= value / rate;
    }
    if (std::abs(value) <= 1e-13 * scale_) all_[static_cast<std::size_t>(count_++)] = {c, s};
  }

  const SlideEquation& f_;
  double scale_;
  std::array<Eigen::Vector2d, 4> all_;
  int count_ = 0;
};

class OneContact {
 public:
  OneContact(const Eigen::Matrix3d& g, const Eigen::Vector3d& c, const ContactBlock& block,
             ContactSolutions& out)
      : g_(g), c_(c), block_(block), n_(block.size()), out_(out) {
    double g_scale = 0;
    for (int i = 0; i < n_; ++i) {
      c_scale_ = std::max(c_scale_, std::abs(c[i]));
      for (int j = 0; j < n_; ++j) g_scale = std::max(g_scale, std::abs(g(i, j)));
    }
    p_scale_ = g_scale > 0 ? c_scale_ / g_scale : 0;
  }
  void solve() {
    out_.clear();
    stick();
    if (block_.tangential == 1) {
      slide(Eigen::Vector2d(1, 0));
      slide(Eigen::Vector2d(-1, 0));
    } else if (block_.tangential == 2) {
      const SlideEquation f = slide_equation(g_, c_, block_);
      const SlideDirections directions(f);
      for (int i = 0; i < directions.count(); ++i) slide(directions[i]);
    }
    if (block_.normal && c_[0] >= -kClosed * c_scale_) out_.add({}, p_scale_);
  }

 private:
  // gamma = 0 with P in the cone.
  void stick() {
    if (c_scale_ == 0) return out_.add({ContactAnswer::sticks}, p_scale_);
    Eigen::Matrix3d g = g_;  // padded by 0
    for (int i = n_; i < 3; ++i) g(i, i) = 1;
    const Eigen::FullPivLU<Eigen::Matrix3d> factors(g);
    if (!factors.isInvertible()) return;
    const Eigen::Vector3d p = factors.solve(-c_);
    if (block_.normal && p[0] < 0) return;
    const double most = block_.normal ? block_.friction * p[0] : block_.bound;
    if (tangential(p).norm() <= most * (1 + kClosed))
      out_.add({ContactAnswer::sticks, p}, p_scale_);
  }
  // On the rim of the cone, with the slip that is left along d.
  void slide(const Eigen::Vector2d& d) {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    double most = block_.bound;
    if (block_.normal) {
      const double held = g_(0, 0) - block_.friction * tangential(g_.row(0)).dot(d);
      if (held == 0) return;
      p[0] = -c_[0] / held;
      if (!(p[0] > 0) || !std::isfinite(p[0])) return;
      most = block_.friction * p[0];
    }
    const int first = block_.normal ? 1 : 0;
    for (int i = 0; i < block_.tangential; ++i) p[first + i] = -most * d[i];
    const Eigen::Vector3d reached = g_ * p, left = reached + c_;
    const double size = c_scale_ + reached.lpNorm<Eigen::Infinity>();
    if (tangential(left).dot(d) >= -kClosed * size) out_.add({ContactAnswer::slides, p}, p_scale_);
  }
  // The tangential entries, padded by 0.
  Eigen::Vector2d tangential(const Eigen::Vector3d& v) const {
    const Eigen::Vector2d all =
        block_.normal ? Eigen::Vector2d(v[1], v[2]) : Eigen::Vector2d(v[0], v[1]);
    return {block_.tangential > 0 ? all[0] : 0, block_.tangential > 1 ? all[1] : 0};
  }

  const Eigen::Matrix3d& g_;
  const Eigen::Vector3d& c_;
  const ContactBlock& block_;
  int n_;
  ContactSolutions& out_;
  double c_scale_ = 0, p_scale_ = 0;
};

}  // namespace

void ContactSolutions::add(const ContactSolution& one, double scale) {
  for (int i = 0; i < count_; ++i) {
    const Eigen::Vector3d& other = (*this)[i].p;
    const double size = std::max(one.p.lpNorm<Eigen::Infinity>(), other.lpNorm<Eigen::Infinity>());
    if ((one.p - other).lpNorm<Eigen::Infinity>() <= kSame * size + kClosed * scale) return;
  }
  if (count_ < static_cast<int>(all_.size())) all_[static_cast<std::size_t>(count_++)] = one;
}

void solve_contact(const Eigen::Matrix3d& g, const Eigen::Vector3d& c, const ContactBlock& block,
                   ContactSolutions& out) {
  Eigen::Matrix3d padded = Eigen::Matrix3d::Zero();
  Eigen::Vector3d free = Eigen::Vector3d::Zero();
  for (int i = 0; i < block.size(); ++i) {
    free[i] = c[i];
    for (int j = 0; j < block.size(); ++j) padded(i, j) = g(i, j);
  }
  OneContact(padded, free, block, out).solve();
}

}  // namespace hamel
