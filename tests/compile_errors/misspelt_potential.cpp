// expect: static assertion failed: this system has a function 'potencial', which is never called,
// and no 'potential'
#include <hamel/hamel.hpp>

struct Top {
  using Group = hamel::SO3;
  static std::string name() { return "top"; }
  hamel::Mat<3, 3> inertia() const { return hamel::Mat<3, 3>::Identity(); }
#ifdef MISTAKE  // it would never be called, and the body would be weightless
  auto potencial(const auto& g) const { return 9.81 * g(2, 2); }
#else
  auto potential(const auto& g) const { return 9.81 * g(2, 2); }
#endif
};

void use(hamel::Registry& registry) { hamel::add_system<Top>(registry); }
