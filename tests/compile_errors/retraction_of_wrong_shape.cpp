// expect: static assertion failed: this type does not satisfy hamel::Retraction
#include <hamel/hamel.hpp>

struct MyMap : hamel::Cayley<hamel::SO3> {
#ifdef MISTAKE  // 3 x 3 on so3
  static hamel::Mat<2, 2> dtau_right_inverse(const hamel::Vec<3>&) { return {}; }
#endif
};

void use(hamel::Registry& registry) { hamel::add_retraction<MyMap>(registry); }
