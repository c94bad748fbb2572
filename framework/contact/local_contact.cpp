// All solutions of one contact: open, sticking, and sliding in every direction that (1) admits.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/LU>

#include <hamel/framework/contact/contact_problem.hpp>

namespace hamel {
namespace {

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

// Real roots of a polynomial of degree up to 4, lowest coefficient first, the last one not small:
// between those of its derivative. Those themselves where the polynomial is next to 0 there, as
// roots that are nearly one.
class RealRoots {
 public:
  template <std::size_t n>
  explicit RealRoots(const std::array<double, n>& p) {
    if constexpr (n == 2) {
      add(-p[0] / p[1]);
    } else {
      std::array<double, n - 1> rate;
      for (std::size_t i = 1; i < n; ++i) rate[i - 1] = static_cast<double>(i) * p[i];
      const RealRoots turns(rate);
      double size = 0, most = 0;
      for (const double x : p) size = std::max(size, std::abs(x));
      most = 1 + size / std::abs(p[n - 1]);  // Cauchy: all are within
      double left = -most, at_left = value(p, left);
      for (int i = 0; i <= turns.count(); ++i) {
        const bool last = i == turns.count();
        const double right = last ? most : std::clamp(turns[i], -most, most),
                     at_right = value(p, right);
        const double terms = std::pow(std::max(1., std::abs(right)), n - 1);
        if (at_left * at_right < 0) add(between(p, rate, left, right, at_left));
        if (!last && std::abs(at_right) <= kNextTo * size * terms) add(right);
        left = right;
        at_left = at_right;
      }
    }
  }
  int count() const { return count_; }
  double operator[](int i) const { return all_[static_cast<std::size_t>(i)]; }

 private:
  static constexpr double kNextTo = 1e-10;

  template <std::size_t n>
  static double value(const std::array<double, n>& p, double x) {
    double out = p[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) out = out * x + p[i];
    return out;
  }
  // Newton, and half of what is left where it leads out of it.
  template <std::size_t n, std::size_t m>
  static double between(const std::array<double, n>& p, const std::array<double, m>& rate,
                        double left, double right, double at_left) {
    double x = (left + right) / 2;
    for (int k = 0; k < 100; ++k) {
      const double at = value(p, x);
      if (at == 0) break;
      ((at < 0) == (at_left < 0) ? left : right) = x;
      double next = x - at / value(rate, x);
      if (!(next > left && next < right)) next = (left + right) / 2;
      const double moved = std::abs(next - x);
      x = next;
      if (moved <= 1e-12 * (1 + std::abs(x))) break;
    }
    return x;
  }
  void add(double x) {
    if (count_ < static_cast<int>(all_.size())) all_[static_cast<std::size_t>(count_++)] = x;
  }

  std::array<double, 10> all_;
  int count_ = 0;
};

// The directions where f = 0: f (1 + t^2)^2 is a quartic in t = tan((theta - theta_0)/2), whose
// highest coefficient is f(theta_0 + pi): theta_0 is where that is the largest of eight. Its real
// roots are polished on f.
class SlideDirections {
 public:
  explicit SlideDirections(const SlideEquation& f) : f_(f), scale_(f.scale()) {
    if (!(scale_ > 0)) return;
    constexpr double half = std::numbers::sqrt2 / 2;
    constexpr std::array<std::array<double, 2>, 8> ways = {{{1, 0},
                                                            {half, half},
                                                            {0, 1},
                                                            {-half, half},
                                                            {-1, 0},
                                                            {-half, -half},
                                                            {0, -1},
                                                            {half, -half}}};
    std::size_t far = 0;
    double most = -1;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const double size = std::abs(f.value(ways[i][0], ways[i][1]));
      if (size > most) far = i;
      most = std::max(most, size);
    }
    // In the axes of theta_0, opposite to that one.
    const double c = -ways[far][0], s = -ways[far][1];
    const double l0 = f.linear[0] * c + f.linear[1] * s, l1 = f.linear[1] * c - f.linear[0] * s;
    const double q11 = f.q11 * c * c + f.q12 * c * s + f.q22 * s * s;
    const double q22 = f.q11 * s * s - f.q12 * c * s + f.q22 * c * c;
    const double q12 = 2 * (f.q22 - f.q11) * c * s + f.q12 * (c * c - s * s);
    const RealRoots roots(std::array<double, 5>{l0 + q11, 2 * (l1 + q12), 4 * q22 - 2 * q11,
                                                2 * (l1 - q12), q11 - l0});
    const double first = std::atan2(s, c);
    for (int i = 0; i < roots.count(); ++i) polish(first + 2 * std::atan(roots[i]));
  }
  int count() const { return count_; }
  Eigen::Vector2d operator[](int i) const { return all_[static_cast<std::size_t>(i)]; }

 private:
  void polish(double angle) {
    double c = 1, s = 0, value = 0;
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
  std::array<Eigen::Vector2d, 10> all_;
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
    if (stick() && only_sticks()) return;
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
  // gamma = 0 with P in the cone. True where it is within.
  bool stick() {
    if (c_scale_ == 0) {
      out_.add({ContactAnswer::sticks}, p_scale_);
      return false;
    }
    Eigen::Matrix3d g = g_;  // padded by 0
    for (int i = n_; i < 3; ++i) g(i, i) = 1;
    const Eigen::FullPivLU<Eigen::Matrix3d> factors(g);
    if (!factors.isInvertible()) return false;
    const Eigen::Vector3d p = factors.solve(-c_);
    if (block_.normal && p[0] < 0) return false;
    const double most = block_.normal ? block_.friction * p[0] : block_.bound,
                 pt = tangential(p).norm();
    if (pt <= most * (1 + kClosed)) out_.add({ContactAnswer::sticks, p}, p_scale_);
    return pt < most * (1 - kSame);
  }
  // Is a solution P* that sticks the only one? With G = G^T > 0 another one, P = P* + D, slides:
  // D^T G D = s d . D_t > 0, s > 0 its slip along d, so that D_n < 0 and d . D_t <= mu |D_n|.
  // Across d there is no slip: (l |D_e|) <= (|G_nt| + mu o) |D_n|, l the least eigenvalue of G_tt
  // and o half their difference. gamma_n = 0 requires G_nn |D_n| <= |G_nt| |D_t|, and P = 0 G_nn <=
  // mu |G_nt|.
  bool only_sticks() const {
    if (!block_.normal || block_.tangential == 0) return false;
    const double gnn = g_(0, 0), mu = block_.friction, size = g_.cwiseAbs().maxCoeff();
    if (!((g_ - g_.transpose()).cwiseAbs().maxCoeff() <= kClosed * size)) return false;
    const double across = block_.tangential == 2 ? g_(2, 2) : g_(1, 1), both = g_(1, 2);
    const double mean = (g_(1, 1) + across) / 2;
    const double half = std::hypot((g_(1, 1) - across) / 2, both), least = mean - half;
    if (!(gnn > 0 && least > 0 && g_.topLeftCorner(n_, n_).determinant() > 0)) return false;
    const double coupled = tangential(g_.row(0)).norm();
    return coupled * (mu + (coupled + mu * half) / least) < (1 - kSame) * gnn;
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
