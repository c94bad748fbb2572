// A group with a retraction, its type erased: what the steps of erased problems evaluate.
//
// An element is a block of numbers as its group lays it out (Packing), vectors are n numbers,
// matrices n x n column-major. Products are put together from their factors at run time
// (ProductGeometry), so that "se2*so2^30" needs no separate kernel. A virtual call costs about 2
// ns.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/lie/concepts.hpp>
#include <hamel/framework/lie/coordinates.hpp>
#include <hamel/framework/lie/group_operations.hpp>
#include <hamel/framework/lie/packing.hpp>
#include <hamel/framework/lie/trivialised.hpp>

namespace hamel {

/// Out-parameters may be the in-parameters.
class Geometry {
 public:
  virtual ~Geometry() = default;
  virtual int dim() const = 0;   // n
  virtual int size() const = 0;  // doubles in an element
  virtual bool symmetric() const = 0;
  virtual bool one_parameter() const = 0;
  virtual bool commuting() const = 0;
  /// Is tau addition? Then Ad, dR and dL are 1, and ad is 0.
  virtual bool adds() const { return false; }
  TauTraits traits() const { return {symmetric(), commuting()}; }
  virtual std::string domain() const = 0;

  // g h, g^-1, the nearest element to one with round-off, and how far g is from the group.
  virtual void compose(const double* g, const double* h, double* out) const = 0;
  virtual void inverse(const double* g, double* out) const = 0;
  virtual void normalise(double* g) const = 0;
  virtual double defect(const double* g) const = 0;
  /// How far g turns, in radians; NaN where there is no such thing.
  virtual double rotation_angle(const double* g) const = 0;
  // Ad_g^T mu, ad_xi^T mu, Ad_g xi.
  virtual void Ad_transpose(const double* g, const double* mu, double* out) const = 0;
  virtual void ad_transpose(const double* xi, const double* mu, double* out) const = 0;
  virtual void Ad(const double* g, const double* xi, double* out) const = 0;
  // tau; tau^-1 (false outside its range); the matrix dR; dR^T m; dR^-T p; dL^-1 eta; is xi in the
  // domain?
  virtual void tau(const double* xi, double* out) const = 0;
  virtual bool tau_inverse(const double* g, double* out) const = 0;
  /// xi with tau_s(xi) = delta (recover_step.hpp); false where there is none.
  virtual bool recover_step(const double* delta, double s, double* xi) const = 0;
  virtual void dtau_right(const double* xi, double* matrix) const = 0;
  virtual void dtau_right_transpose(const double* xi, const double* m, double* out) const = 0;
  virtual void dtau_right_inverse_transpose(const double* xi, const double* p,
                                            double* out) const = 0;
  virtual void dtau_left_inverse(const double* xi, const double* eta, double* out) const = 0;
  /// mixed_momentum of trivialised.hpp.
  virtual void mixed_momentum(double s, const double* xi, const double* p, const double* nu,
                              double* q) const = 0;
  virtual bool in_domain(const double* xi) const = 0;
  // CSV columns.
  virtual int columns() const = 0;
  virtual void coordinates(const double* g, double* out) const = 0;
  /// Throws std::invalid_argument when the values are no element.
  virtual void from_coordinates(std::span<const double> values, double* out) const = 0;
  /// The element nearest to values that are not one, as after a Runge-Kutta stage.
  virtual void nearest(std::span<const double> values, double* out) const = 0;
};

/// Functions called in a step are flattened: a kernel's unit is too large for the compiler to
/// inline them itself.
template <class Tau>
class TypedGeometry final : public Geometry {
  using G = typename Tau::Group;
  static constexpr int n = G::dim;
  using Pack = Packing<G>;
  static Vec<n> vec(const double* p) { return Vec<n>(p); }
  static void put(const Vec<n>& v, double* out) { Eigen::Map<Vec<n>>{out} = v; }

 public:
  int dim() const override { return n; }
  int size() const override { return Pack::size; }
  bool symmetric() const override { return Tau::symmetric; }
  bool one_parameter() const override { return Tau::one_parameter; }
  bool commuting() const override { return GroupOperations<Tau>::commuting(); }
  bool adds() const override {
    return requires { requires Tau::addition; };
  }
  std::string domain() const override { return Tau::domain(); }

  HAMEL_FLATTEN void compose(const double* g, const double* h, double* out) const override {
    Pack::store(G::compose(Pack::load(g), Pack::load(h)), out);
  }
  HAMEL_FLATTEN void inverse(const double* g, double* out) const override {
    Pack::store(G::inverse(Pack::load(g)), out);
  }
  HAMEL_FLATTEN void normalise(double* g) const override {
    Pack::store(G::normalise(Pack::load(g)), g);
  }
  double defect(const double* g) const override { return G::defect(Pack::load(g)); }
  double rotation_angle(const double* g) const override {
    return GroupOperations<Tau>::rotation_angle(Pack::load(g));
  }
  HAMEL_FLATTEN void Ad_transpose(const double* g, const double* mu, double* out) const override {
    put(G::Ad_transpose(Pack::load(g), vec(mu)), out);
  }
  void ad_transpose(const double* xi, const double* mu, double* out) const override {
    put(G::coad(vec(mu)) * vec(xi), out);
  }
  void Ad(const double* g, const double* xi, double* out) const override {
    put(G::Ad(Pack::load(g)) * vec(xi), out);
  }
  HAMEL_FLATTEN void tau(const double* xi, double* out) const override {
    Pack::store(Tau::tau(vec(xi)), out);
  }
  bool tau_inverse(const double* g, double* out) const override {
    try {
      put(Tau::tau_inverse(Pack::load(g)), out);
      return true;
    } catch (const DomainError&) {
      return false;
    }
  }
  bool recover_step(const double* delta, double s, double* xi) const override {
    Vec<n> found;
    const bool out = GroupOperations<Tau>::recover_step(Pack::load(delta), s, found);
    put(found, xi);
    return out;
  }
  void dtau_right(const double* xi, double* matrix) const override {
    Eigen::Map<Mat<n, n>>{matrix} = Tau::dtau_right(vec(xi));
  }
  void dtau_right_transpose(const double* xi, const double* m, double* out) const override {
    put(Tau::dtau_right(vec(xi)).transpose() * vec(m), out);
  }
  void dtau_right_inverse_transpose(const double* xi, const double* p, double* out) const override {
    put(Tau::dtau_right_inverse_transpose(vec(xi), vec(p)), out);
  }
  void dtau_left_inverse(const double* xi, const double* eta, double* out) const override {
    Vec<n> image;
    GroupOperations<Tau>::dtau_left_inverse(vec(xi), vec(eta), image);
    put(image, out);
  }
  HAMEL_FLATTEN void mixed_momentum(double s, const double* xi, const double* p, const double* nu,
                                    double* q) const override {
    put(hamel::mixed_momentum<Tau>(s, vec(xi), vec(p), vec(nu)), q);
  }
  bool in_domain(const double* xi) const override { return Tau::in_domain(vec(xi)); }
  int columns() const override { return static_cast<int>(coordinate_count<G>); }
  void coordinates(const double* g, double* out) const override {
    const auto values = G::coordinates(Pack::load(g));
    std::copy(values.begin(), values.end(), out);
  }
  void from_coordinates(std::span<const double> values, double* out) const override {
    Pack::store(G::from_coordinates(values), out);
  }
  void nearest(std::span<const double> values, double* out) const override {
    Pack::store(nearest_element<G>(values), out);
  }
};

/// The product of its factors' geometries, of any number chosen at run time.
class ProductGeometry final : public Geometry {
 public:
  explicit ProductGeometry(std::vector<std::shared_ptr<const Geometry>> factors);
  ~ProductGeometry() override;  // no other object may need the vtable (tools/cmake/localise)
  int dim() const override { return dim_; }
  int size() const override { return size_; }
  bool symmetric() const override;
  bool one_parameter() const override;
  bool commuting() const override;
  bool adds() const override;
  std::string domain() const override;
  void compose(const double* g, const double* h, double* out) const override;
  void inverse(const double* g, double* out) const override;
  void normalise(double* g) const override;
  double defect(const double* g) const override;
  double rotation_angle(const double* g) const override;
  void Ad_transpose(const double* g, const double* mu, double* out) const override;
  void ad_transpose(const double* xi, const double* mu, double* out) const override;
  void Ad(const double* g, const double* xi, double* out) const override;
  void tau(const double* xi, double* out) const override;
  bool tau_inverse(const double* g, double* out) const override;
  bool recover_step(const double* delta, double s, double* xi) const override;
  void dtau_right(const double* xi, double* matrix) const override;
  void dtau_right_transpose(const double* xi, const double* m, double* out) const override;
  void dtau_right_inverse_transpose(const double* xi, const double* p, double* out) const override;
  void dtau_left_inverse(const double* xi, const double* eta, double* out) const override;
  void mixed_momentum(double s, const double* xi, const double* p, const double* nu,
                      double* q) const override;
  bool in_domain(const double* xi) const override;
  int columns() const override;
  void coordinates(const double* g, double* out) const override;
  void from_coordinates(std::span<const double> values, double* out) const override;
  void nearest(std::span<const double> values, double* out) const override;

 private:
  struct Factor {
    std::shared_ptr<const Geometry> geometry;
    int at = 0;  // where its vectors start
    int dim = 0;
    bool adds = false;
    int element = 0;  // where its element starts
    int column = 0;   // where its coordinates start
  };
  std::vector<Factor> factors_;
  int dim_ = 0, size_ = 0, columns_ = 0;
};

/// A retraction with its group, the types erased. Specialised where a library has it compiled: made
/// by type it costs up to 4 s of compilation.
template <class Tau>
std::shared_ptr<const Geometry> erased_geometry() {
  return std::make_shared<TypedGeometry<Tau>>();
}

}  // namespace hamel
