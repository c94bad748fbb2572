#include <hamel/systems/n_trailer.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/graph/system_formulas.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/so2.hpp>

namespace hamel {
namespace {

constexpr int kMost = 60;
constexpr int kOmega = 0, kV = 1, kAlpha = 2;  // w_j is column kAlpha + j, j >= 1

template <class T>
using PlaneOf = Eigen::Matrix<T, 2, 1>;
using Plane = PlaneOf<double>;

// n_i and e_i of the car (0) and the trailers.
template <class T>
struct HeadingsOf {
  std::array<PlaneOf<T>, kMost + 1> n;
  const PlaneOf<T>& along(int i) const { return n[static_cast<size_t>(i)]; }
  PlaneOf<T> across(int i) const { return {-along(i)[1], along(i)[0]}; }
};
struct Headings : HeadingsOf<double> {
  explicit Headings(const double* g, int count) {
    n[0] = {1, 0};
    g += Packing<SE2>::size;
    for (int i = 1; i <= count; ++i, g += Packing<SO2>::size) {
      const auto alpha = Packing<SO2>::load(g);
      n[static_cast<size_t>(i)] = {alpha.c, alpha.s};
    }
  }
};

class Train final : public Mechanics, public graph::HasSystemFormulas {
 public:
  explicit Train(const NTrailer& system)
      : n_(system.count()), lengths_(1, 0.0), masses_{system.mass}, moments_{system.moment} {
    for (const double length : system.each_length()) {
      lengths_.push_back(length);
      masses_.push_back(system.trailer_mass);
      moments_.push_back(system.trailer_moment);
    }
    behind_ = masses_;
    for (int i = n_; i > 0; --i) at(behind_, i - 1) += at(behind_, i);
  }
  int dim() const override { return n_ + 3; }
  int constraint_count() const override { return n_ + 1; }
  bool constant_inertia() const override { return false; }

  void inertia(const double* g, Matrix out) const override {
    zero(out);
    fill_inertia(Headings(g, n_), out);
  }

  void constraints(double /*t*/, const double* g, Matrix a, Vector b) const override {
    zero(a);
    b.setZero();
    fill_rows(Headings(g, n_), a);
  }

  graph::SystemFormulas system_formulas(std::span<const graph::Number> variables) const override {
    using graph::Number;
    using NumberMatrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
    HeadingsOf<Number> h;
    h.n[0] = {Number(1), Number(0)};
    for (size_t i = 1; i <= static_cast<size_t>(n_);
         ++i)  // behind the angle and the place of the car
      h.n[i] = {cos(variables[2 + i]), sin(variables[2 + i])};
    NumberMatrix inertia = NumberMatrix::Zero(dim(), dim()),
                 a = NumberMatrix::Zero(constraint_count(), dim());
    fill_inertia(h, inertia);
    fill_rows(h, a);
    const auto rows_of = [](const NumberMatrix& m) {
      std::vector<std::vector<Number>> out;
      for (Eigen::Index i = 0; i < m.rows(); ++i)
        out.emplace_back(m.row(i).begin(), m.row(i).end());
      return out;
    };
    graph::SystemFormulas out;
    out.inertia = rows_of(inertia);
    out.rows = rows_of(a);
    return out;
  }

  /// The rows are e_i . u_i, u_i = u_{i-1} - L_i w_i e_i.
  void constraint_values(double /*t*/, const double* g, ConstVector xi, Vector out) const override {
    const Headings h(g, n_);
    Plane u(xi[kV], xi[kV + 1]);
    out[0] = h.across(0).dot(u);
    for (int i = 1; i <= n_; ++i) {
      u -= at(lengths_, i) * turning(xi, i) * h.across(i);
      out[i] = h.across(i).dot(u);
    }
  }

  void force(double /*t*/, const double* g, ConstVector xi, Vector out) const override {
    inertial_force(g, xi, out);
  }
  bool force_depends_on_velocity() const override { return false; }  // f = 0
  /// dl/dalpha_j = L_j w_j n_j . P_j.
  void inertial_force(const double* g, ConstVector xi, Vector out) const override {
    const Headings h(g, n_);
    out.setZero();
    each_momentum(h, xi, [&](int j, const Plane& momentum) {
      if (j > 0) out[kAlpha + j] = at(lengths_, j) * turning(xi, j) * h.along(j).dot(momentum);
    });
  }
  /// dl/dalpha_j' = J_j w_j - L_j e_j . P_j, and the momentum of the car with all of them.
  void momentum(const double* g, ConstVector xi, Vector out, Vector inertial_force) const override {
    const Headings h(g, n_);
    inertial_force.setZero();
    out[kOmega] = 0;
    each_momentum(h, xi, [&](int j, const Plane& momentum) {
      if (j == 0) {
        out.segment<2>(kV) = momentum;
        out[kOmega] += moments_[0] * xi[kOmega];
        return;
      }
      const double w = turning(xi, j), length = at(lengths_, j);
      out[kAlpha + j] = at(moments_, j) * w - length * h.across(j).dot(momentum);
      out[kOmega] += out[kAlpha + j];
      inertial_force[kAlpha + j] = length * w * h.along(j).dot(momentum);
    });
  }

 private:
  // Fills a matrix of zeros.
  template <class T, class M>
  void fill_inertia(const HeadingsOf<T>& h, M&& out) const {
    out(kOmega, kOmega) = moments_[0];
    out(kV, kV) = out(kV + 1, kV + 1) = behind_[0];
    for (int j = 1; j <= n_; ++j) {
      const double lever = at(lengths_, j) * at(behind_, j);
      for (int k = 1; k < j; ++k) {
        const T both = lever * at(lengths_, k) * h.along(j).dot(h.along(k));
        out(kAlpha + j, kAlpha + k) = out(kAlpha + k, kAlpha + j) = both;
      }
      out(kAlpha + j, kAlpha + j) = lever * at(lengths_, j) + at(moments_, j);
      const PlaneOf<T> push = -lever * h.across(j);
      for (int k = 0; k < 2; ++k) out(kAlpha + j, kV + k) = out(kV + k, kAlpha + j) = push[k];
    }
    // omega is in every w_j.
    for (int j = 1; j <= n_; ++j) {
      const auto column = out.col(kAlpha + j);
      out(kV, kOmega) += column[kV];
      out(kV + 1, kOmega) += column[kV + 1];
      const T sum = column.tail(n_).sum();
      out(kAlpha + j, kOmega) = out(kOmega, kAlpha + j) = sum;
      out(kOmega, kOmega) += sum;
    }
    out(kOmega, kV) = out(kV, kOmega);
    out(kOmega, kV + 1) = out(kV + 1, kOmega);
  }

  template <class T, class M>
  void fill_rows(const HeadingsOf<T>& h, M&& a) const {
    for (int i = 0; i <= n_; ++i) {
      const PlaneOf<T> e = h.across(i);
      a(i, kV) = e[0];
      a(i, kV + 1) = e[1];
      for (int j = 1; j <= i; ++j) {
        const T lever = -at(lengths_, j) * h.along(i).dot(h.along(j));
        a(i, kAlpha + j) = lever;
        a(i, kOmega) += lever;
      }
    }
  }

  static double& at(std::vector<double>& v, int i) { return v[static_cast<size_t>(i)]; }
  static double at(const std::vector<double>& v, int i) { return v[static_cast<size_t>(i)]; }
  /// Clears a matrix without gaps at once: Eigen's loop over its columns takes longer than all
  /// else.
  static void zero(Matrix m) {
    if (m.outerStride() == m.rows()) std::fill_n(m.data(), m.size(), 0.0);
    else m.setZero();
  }
  /// w_j = omega + alpha_j', j >= 1.
  static double turning(ConstVector xi, int j) { return xi[kOmega] + xi[kAlpha + j]; }
  /// f(j, P_j) from the last trailer to the car, P_j = sum of m_i u_i over i >= j.
  template <class F>
  void each_momentum(const Headings& h, ConstVector xi, F&& f) const {
    std::array<Plane, kMost + 1> u;
    u[0] = {xi[kV], xi[kV + 1]};
    for (int i = 1; i <= n_; ++i)
      u[static_cast<size_t>(i)] =
          u[static_cast<size_t>(i - 1)] - at(lengths_, i) * turning(xi, i) * h.across(i);
    Plane momentum(0, 0);
    for (int j = n_; j >= 0; --j) {
      momentum += at(masses_, j) * u[static_cast<size_t>(j)];
      f(j, momentum);
    }
  }

  int n_;
  std::vector<double> lengths_, masses_, moments_, behind_;  // behind_: M_j
};

}  // namespace

int NTrailer::count() const {
  if (!(trailers >= 1 && trailers <= kMost) || trailers != std::floor(trailers)) {
    throw std::invalid_argument(
        fmt::format("trailers: got {}, expected a whole number from 1 to {}", trailers, kMost));
  }
  return static_cast<int>(trailers);
}

std::vector<double> NTrailer::each_length() const {
  const auto n = static_cast<size_t>(count());
  if (lengths.size() == 1) return std::vector<double>(n, lengths[0]);
  if (lengths.size() == n) return lengths;
  throw std::invalid_argument(
      fmt::format("length: got {} values, expected 1 or {}", lengths.size(), n));
}

std::vector<std::string> NTrailer::shape() const {
  std::vector<std::string> out;
  for (int i = 1; i <= count(); ++i) out.push_back("hitch" + std::to_string(i));
  return out;
}

std::string NTrailer::group() const { return fmt::format("se2*so2^{}", count()); }

std::shared_ptr<const Mechanics> NTrailer::mechanics() const {
  return std::make_shared<Train>(*this);
}

Start NTrailer::circling(double radius, double speed) const {
  const double omega = speed / radius;
  Start start{.configuration = {0, 0, 0}, .velocity = {omega, speed, 0}, .momentum = {}};
  double alpha = 0, ahead = radius;
  for (const double length : each_length()) {
    const double square = ahead * ahead - length * length;
    if (!(square > 0)) {
      throw std::invalid_argument(fmt::format("radius: {} is too small for the trailers", radius));
    }
    // From one axle to the next the hitch is a tangent: the heading turns by atan(L_i / R_i).
    const double own = std::sqrt(square);
    alpha -= std::copysign(std::atan2(length, own), radius);
    start.configuration.push_back(alpha);
    start.velocity.push_back(0);
    ahead = own;
  }
  return start;
}

Start NTrailer::start() const {
  Start start{.configuration = std::vector<double>(static_cast<size_t>(3 + count()), 0.0),
              .velocity = {0.3, 1, 0},
              .momentum = {}};
  // The rates that satisfy the rows, axle after axle.
  start.configuration[3] = 0.4;
  Plane u(1, 0);
  int i = 1;
  for (const double length : each_length()) {
    const double alpha = i == 1 ? 0.4 : 0.0;
    const Plane e(-std::sin(alpha), std::cos(alpha));
    const double w = e.dot(u) / length;
    start.velocity.push_back(w - 0.3);
    u -= length * w * e;
    ++i;
  }
  return start;
}

std::vector<std::array<double, 3>> NTrailer::axles(std::span<const double> coordinates) const {
  std::vector<std::array<double, 3>> out{{coordinates[1], coordinates[2], coordinates[0]}};
  size_t i = 3;
  for (const double length : each_length()) {
    const auto [x, y, ahead] = out.back();
    const double heading = coordinates[0] + coordinates[i++];
    out.push_back({x - length * std::cos(heading), y - length * std::sin(heading), heading});
  }
  return out;
}

std::function<double(std::span<const double>, std::span<const double>)> NTrailer::energy() const {
  return [*this, lengths = each_length()](std::span<const double> g, std::span<const double> xi) {
    double energy = 0.5 * (mass * (xi[1] * xi[1] + xi[2] * xi[2]) + moment * xi[0] * xi[0]);
    Plane u(xi[1], xi[2]);
    for (size_t i = 0; i < lengths.size(); ++i) {
      const double w = xi[0] + xi[3 + i], alpha = g[3 + i];
      u -= lengths[i] * w * Plane(-std::sin(alpha), std::cos(alpha));
      energy += 0.5 * (trailer_mass * u.squaredNorm() + trailer_moment * w * w);
    }
    return energy;
  };
}

void NTrailer::draw(Drawing& drawing) const {
  drawing.from_above = drawing.has_floor = true;
  const auto lengths_now = each_length();
  for (size_t i = 0; i <= lengths_now.size(); ++i) {
    const double length = lengths_now[i == 0 ? 0 : i - 1];
    std::vector<BodyShape> shapes{
        shapes::box({0.5 * length, 0.4 * length, 0.2 * length},
                    {.at = {0, 0, 0.2 * length}, .color = i == 0 ? "accent" : "body"}),
        shapes::cylinder(0.15 * length, 0.6 * length, {.axis = {0, 1, 0}, .color = "dark"})};
    if (i > 0) {
      shapes.push_back(
          shapes::line({{0, 0, 0.2 * length}, {length, 0, 0.2 * length}}, {.color = "dark"}));
    }
    DrawnBody body{i == 0 ? "car" : fmt::format("trailer {}", i),
                   [*this, i](std::span<const double> g) {
                     const auto [x, y, heading] = axles(g)[i];
                     return planar(x, y, heading);
                   },
                   std::move(shapes)};
    if (i == 0 || i == lengths_now.size()) body.trail();
    drawing.bodies.push_back(std::move(body));
  }
}

}  // namespace hamel
