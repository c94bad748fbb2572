// A retraction of your own on SO(3), used by name; its order is measured.
#include <cmath>
#include <iostream>

#include <hamel/framework/check/retraction_laws.hpp>
#include <hamel/hamel.hpp>

// The modified Rodrigues map: turn by f = 4 atan(theta/4) about omega, theta = |omega|.
struct Rodrigues4 : hamel::RadialSO3<Rodrigues4> {
  static std::string name() { return "rodrigues4"; }
  static std::string formula() { return "turn by 4 atan(|omega|/4) about omega"; }
  // phi(x) = f/theta and two derivatives by x = theta^2. With u = x/16: phi = atan(sqrt u)/sqrt u,
  // 2 u phi' = 1/(1+u) - phi by u; a series where that would cancel.
  template <class T>
  static hamel::RadialProfile<T> profile(const T& x) {
    const T u = x / 16.0;
    T phi(0.0), d(0.0), d2(0.0);
    if (u < 0.1) {  // sum (-u)^k/(2k + 1)
      for (int k = 24; k >= 0; --k) {
        const double a = (k % 2 == 0 ? 1.0 : -1.0) / (2 * k + 1);
        phi = phi * u + a;
        if (k >= 1) d = d * u + k * a;
        if (k >= 2) d2 = d2 * u + k * (k - 1) * a;
      }
    } else {
      const T r = 1.0 / (1.0 + u);
      phi = hamel::atanc(u);
      d = 0.5 * (r - phi) / u;
      d2 = -(0.5 * r * r + 1.5 * d) / u;
    }
    return {phi, d / 16.0, d2 / 256.0};
  }
  /// theta of an angle f.
  template <class T>
  static T radius(const T& f) {
    using std::tan;
    return 4.0 * tan(T(0.25 * f));
  }
  template <class T>
  static bool in_domain(const hamel::VecT<T, 3>& xi) {
    return xi.dot(xi) < 16.0;  // f < pi
  }
  static std::string domain() { return "|omega| < 4"; }
};

int main() {
  bool good = true;
  for (const auto& law : hamel::check_retraction<Rodrigues4>()) {
    std::cout << law << "\n";
    good = good && law.passed();
  }
  hamel::add_retraction<Rodrigues4>(hamel::registry());

  const auto error = [](double step) {
    return hamel::simulate("suslov")
        .set("inertia", {2, 0.3, 0.5, 3, 0.4, 4})
        .start({.velocity = {1, 0.5, 0}})
        .retraction("rodrigues4")
        .step(step)
        .until(10)
        .run()
        .exact_error_final;
  };
  const double coarse = error(0.02), fine = error(0.01), order = std::log2(coarse / fine);
  std::cout << "error " << coarse << " at h = 0.02, " << fine << " at h = 0.01: order " << order
            << "\n";
  if (!(good && std::abs(order - 2) < 0.05)) std::cerr << "own_retraction: expected order 2\n";
  return good && std::abs(order - 2) < 0.05 ? 0 : 1;
}
