// Defaults of Mechanics, from I(g), A(t, g), b(t, g) and the force alone.
//
// A system is shared by threads and has no work space: each thread keeps its own, so that nothing
// is allocated behind the first call.
#include <hamel/framework/mechanics/mechanics.hpp>

#include <optional>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/mechanics/differenced_rates.hpp>

namespace hamel {
namespace {

// A system on its group, as DifferencedRates takes it.
struct OnGroup {
  using Element = Eigen::VectorXd;
  using Vector = Eigen::VectorXd;
  using Multipliers = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;
  using ConstraintMatrix = Eigen::MatrixXd;

  const Geometry& geometry;
  const Mechanics& mechanics;

  int dim() const { return mechanics.dim(); }
  int constraint_count() const { return mechanics.constraint_count(); }
  bool constant_inertia() const { return mechanics.constant_inertia(); }
  bool constant_constraints() const { return mechanics.constant_constraints(); }
  bool autonomous() const { return mechanics.autonomous(); }
  Element element() const { return Element::Zero(geometry.size()); }
  void tau(const Vector& xi, Element& out) const { geometry.tau(xi.data(), out.data()); }
  void compose(const Element& g, const Element& h, Element& out) const {
    geometry.compose(g.data(), h.data(), out.data());
  }
  void inertia(const Element& g, Matrix& out) const { mechanics.inertia(g.data(), out); }
  void constraints(double t, const Element& g, Matrix& a, Multipliers& b) const {
    mechanics.constraints(t, g.data(), a, b);
  }
};

}  // namespace

void Mechanics::momentum_of_inertia(const double* g, ConstVector xi, Vector out,
                                    Vector inertial_force) const {
  static thread_local Eigen::MatrixXd i;
  i.resize(dim(), dim());
  inertia(g, i);
  out.noalias() = i.lazyProduct(xi);
  this->inertial_force(g, xi, inertial_force);
}

void Mechanics::values_of_constraints(double t, const double* g, ConstVector xi, Vector out) const {
  static thread_local Eigen::MatrixXd a;
  static thread_local Eigen::VectorXd b;
  a.resize(constraint_count(), dim());
  b.resize(constraint_count());
  constraints(t, g, a, b);
  out.noalias() = a.lazyProduct(xi);
  out -= b;
}

void Mechanics::force_without_inertial(double t, const double* g, ConstVector xi,
                                       Vector out) const {
  force(t, g, xi, out);
  if (constant_inertia()) return;
  static thread_local Eigen::VectorXd inertial;
  inertial.resize(dim());
  inertial_force(g, xi, inertial);
  out -= inertial;
}

void Mechanics::rates_by_differences(const Geometry& geometry, double t, const double* g,
                                     ConstVector xi, Vector rows, Vector momentum) const {
  struct Work {
    Work(const OnGroup& here)
        : differences(here),
          at(here.element()),
          along(here.dim()),
          momentum(here.dim()),
          rows(here.constraint_count()) {}
    DifferencedRates<OnGroup> differences;
    Eigen::VectorXd at, along, momentum, rows;
  };
  static thread_local std::optional<Work> kept;
  const OnGroup here{geometry, *this};
  if (!kept || kept->at.size() != geometry.size() || kept->along.size() != dim() ||
      kept->rows.size() != constraint_count())
    kept.emplace(here);
  Work& work = *kept;
  work.at = Eigen::Map<const Eigen::VectorXd>(g, geometry.size());
  work.along = xi;
  work.differences(here, t, work.at, work.along, work.rows, work.momentum);
  rows = work.rows;
  momentum = work.momentum;
}

void Mechanics::motion_of_parts(const Geometry& geometry, double t, const double* g, ConstVector xi,
                                Matrix inertia, Matrix a, Vector b, Vector rows,
                                Vector change) const {
  if (!constant_inertia()) this->inertia(g, inertia);
  if (constraint_count() > 0 && !constant_constraints()) constraints(t, g, a, b);
  static thread_local Eigen::VectorXd mu, rate;
  mu.resize(dim());
  rate.resize(dim());
  rate.setZero();
  rows.setZero();
  if (!constant_inertia() || !constant_constraints()) rates(geometry, t, g, xi, rows, rate);
  force(t, g, xi, change);
  if (!constant_inertia()) change -= rate;
  if (inertia.outerStride() == inertia.rows()) multiply(inertia, xi, mu);
  else mu.noalias() = inertia.lazyProduct(xi);
  geometry.ad_transpose(xi.data(), mu.data(), rate.data());
  change += rate;
}

}  // namespace hamel
