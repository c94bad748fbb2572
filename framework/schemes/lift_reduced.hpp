// The step of lift on a left-invariant problem: m unknowns, (M17), in the Hamel form where that
// exists. Part of lift.hpp.
#pragma once

#include <limits>

#include <hamel/framework/schemes/hamel_form.hpp>
#include <hamel/framework/schemes/lift.hpp>

namespace hamel {

/// y in R^m, contracted where the Hamel form exists.
template <class P>
class Lift::Reduced {
  using Form = HamelForm<P>;
  using Tau = typename P::Tau;
  using G = typename P::Group;
  using Element = typename P::Element;
  using T = typename P::Scalar;
  using Vector = typename P::Vector;
  static constexpr int n = P::n;

 public:
  using Problem = P;
  using Unknown = typename P::State;
  using Jacobian = typename P::StateMatrix;
  using Node = hamel::Node<P>;

  Reduced(const P& problem, double s)
      : problem_(problem),
        s_(s),
        one_sided_(s == 0 || Tau::one_parameter || (s == 1 && Tau::symmetric)),
        mirrored_(s == 0.5 && Tau::symmetric),
        form_(problem, [this](const Vector& xi, const Vector& p) { return end_momentum(xi, p); }) {
    if constexpr (Form::exists()) contracted_ = Form::exists(s);
  }

  /// That of bodies in lanes: each(member, out) joins a member of One, the step of one body.
  template <class One, class Each>
  Reduced(std::type_identity<One>, const Each& each)
      : problem_(each.of(&One::problem_)),
        s_(each.first().s_),
        one_sided_(each.first().one_sided_),
        mirrored_(each.first().mirrored_),
        contracted_(each.first().contracted_),
        form_(UsedForm::template joined<typename One::UsedForm>(each.of(&One::form_))) {}

  /// Is the step of this s offered to bodies in lanes? In the Hamel form where there is one.
  static bool in_lanes(double s) { return !Form::exists() || Form::exists(s); }

  /// Small enough to be inlined whole?
  static constexpr bool inlined = Form::exists();
  static constexpr int size() { return P::m; }
  void begin(const Node& node, double h) {
    from_ = &node;
    if (h != h_) [[unlikely]]
      set_step(h);
  }
  void guess(Unknown& y) const { y = from_->x; }
  /// (|mu_bar| + |I xi/h|)^2, both of one length in the Hamel frame.
  T scale_squared() const { return 4 * from_->x.squaredNorm(); }

  /// F(y) = E^T mu0 - mu_bar.
  [[gnu::always_inline]] void residual(const Unknown& y, Unknown& f) const {
    if constexpr (Form::exists()) {
      if (contracted()) [[likely]] {
        f = form_.start_momentum(y) - from_->x;
        return;
      }
    }
    full_residual(y, f);
  }

  /// F and dF/dy. Over lanes only in the Hamel form.
  static constexpr bool linearised = Form::has_derivative() || std::is_same_v<T, double>;
  void linearise(const Unknown& y, Unknown& f, Jacobian& j) const
      requires(HasJacobians<P>&& linearised) {
    residual(y, f);
    if constexpr (Form::has_derivative()) {
      if (contracted()) return form_.derivative(y, j);
    }
    if constexpr (std::is_same_v<T, double>) full_derivative(y, j);
  }

  [[gnu::always_inline]] bool finish(const Unknown& y, Node& next) const {
    const Vector step = xi(y);
    if (!Tau::in_domain(step)) return false;
    finish_state(y, next);
    move(step, next);
    return true;
  }
  /// Its two halves, for xi in the domain. The first shares its terms with the residual at y.
  [[gnu::always_inline]] void finish_state(const Unknown& y, Node& next) const {
    if constexpr (Form::exists()) {
      if (contracted()) [[likely]] {
        next.x = form_.end_momentum(y);
        return;
      }
    }
    full_finish(y, xi(y), next.x);
  }
  [[gnu::always_inline]] void finish_element(const Unknown& y, Node& next) const {
    move(xi(y), next);
  }

 private:
  [[gnu::always_inline]] void move(const Vector& step, Node& next) const {
    Element increment;
    if (one_sided_) {
      increment = Tau::tau(step);
    } else if (mirrored_) {
      increment = of_halves(step);
    } else {
      increment =
          G::compose(G::inverse(Tau::tau(Vector(-s_ * step))), Tau::tau(Vector((1 - s_) * step)));
    }
    next.t = from_->t + h_;
    next.g = G::compose(from_->g, increment);
  }
  bool contracted() const {
    if constexpr (requires { T::width; }) return true;  // in_lanes
    else return contracted_;
  }
  // tau(xi/2)^2.
  static Element of_halves(const Vector& step) {
    if constexpr (requires { Tau::tau_of_halves(step); }) {
      return Tau::tau_of_halves(step);
    } else {
      const Element half = Tau::tau(Vector(0.5 * step));
      return G::compose(half, half);
    }
  }
  void set_step(double h) {
    h_ = h;
    step_frame_ = h * problem_.frame();
    if constexpr (Form::exists()) form_.scale(h);
  }
  Vector xi(const Unknown& y) const { return step_frame_.lazyProduct(y); }
  Vector momentum(const Unknown& y) const {
    Vector p;
    problem_.momentum({}, y, p);
    return p;
  }
  // mu0 = Ad_{f0}^T m, m = C^-1 p.
  Vector end_momentum(const Vector& step, const Vector& p) const {
    if (one_sided_) return Tau::dtau_right_inverse_transpose(step, p);
    return G::Ad_transpose(Tau::tau(Vector(-s_ * step)),
                           base_momentum<Tau, T>(s_, step, p, Vector::Zero()));
  }
  // Out of line, so that the contracted loop stays small.
  [[gnu::noinline]] void full_residual(const Unknown& y, Unknown& f) const {
    f = problem_.reduce(end_momentum(xi(y), momentum(y))) - from_->x;
  }
  [[gnu::noinline]] void full_finish(const Unknown& y, const Vector& step, Unknown& next) const {
    const Vector p = momentum(y);
    if (one_sided_) {
      next = problem_.reduce(Tau::dtau_left_inverse_transpose(step, p));
    } else {
      next = problem_.reduce(G::Ad_transpose(Tau::tau(Vector((1 - s_) * step)),
                                             base_momentum<Tau, T>(s_, step, p, Vector::Zero())));
    }
  }

  // dF/dy by the matrices of the group.
  [[gnu::noinline, gnu::cold]] void full_derivative(const Unknown& y, Jacobian& j) const {
    const Vec<n> p = momentum(y), step = xi(y);
    if (one_sided_) {
      j = h_ * problem_.reduce_both(Tau::dtau_right_inverse_transpose_derivative(step, p)) +
          problem_.reduce_momentum(Tau::dtau_right_inverse(step).transpose());
      return;
    }
    // dm = C^-1 (I E dy - dC m),  dmu0 = Ad_{f0}^T dm + K(mu0) dL_{z0} dz0.
    const At<Tau> z0(-s_ * step), z1((1 - s_) * step);
    const Mat<n, n> c = (s_ * z0.right + (1 - s_) * z1.right).transpose();
    const Mat<n, n> c_inverse = inverse_of(c);
    const Vec<n> m = c_inverse * p;
    const Mat<n, n> dc_m = (1 - s_) * (1 - s_) * z1.right_transpose_derivative(m) -
                           s_ * s_ * z0.right_transpose_derivative(m);
    const Mat<n, n> pull = G::Ad(z0.f).transpose() * c_inverse;
    j = problem_.reduce_momentum(pull) -
        h_ * problem_.reduce_both(pull * dc_m + s_ * z0.pull_derivative(z0.pull(m)));
  }

  struct NoForm {
    NoForm() = default;
    template <class EndMomentum>
    NoForm(const P& /*problem*/, const EndMomentum& /*mu0*/) {}
    template <class One, class Each>
    static NoForm joined(const Each& /*each*/) {
      return {};
    }
  };
  using UsedForm = std::conditional_t<Form::exists(), Form, NoForm>;
  template <class>
  friend class Reduced;

  P problem_;
  typename P::Frame step_frame_;  // h E
  double s_, h_ = std::numeric_limits<double>::quiet_NaN();
  bool one_sided_, mirrored_, contracted_ = false;
  const Node* from_ = nullptr;
  [[no_unique_address]] UsedForm form_;
};

}  // namespace hamel
