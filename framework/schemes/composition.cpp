#include <hamel/framework/schemes/composition.hpp>

#include <cmath>

namespace hamel {
namespace {

// c, ..., middle, ..., c from the first half; the middle makes the sum one.
std::vector<double> symmetric(const std::vector<double>& half) {
  double sum = 0;
  for (double c : half) sum += 2 * c;
  std::vector<double> all = half;
  all.push_back(1 - sum);
  all.insert(all.end(), half.rbegin(), half.rend());
  return all;
}

}  // namespace

const std::vector<Composition>& compositions() {
  static const std::vector<Composition> all = {
      {"none", "the plain step", 2, {1.0}},
      {"yoshida4", "Yoshida 1990, triple jump, GNI (II.4.4)", 4,
       symmetric({1 / (2 - std::cbrt(2.0))})},
      {"suzuki4", "Suzuki 1990, five stages, GNI (II.4.5)", 4,
       symmetric({1 / (4 - std::cbrt(4.0)), 1 / (4 - std::cbrt(4.0))})},
      {"yoshida6", "Yoshida 1990, solution A, seven stages, GNI (V.3.11)", 6,
       symmetric({0.78451361047755726382, 0.23557321335935813368, -1.17767998417887100695})},
      {"kahan_li6", "Kahan and Li 1997, nine stages, GNI (V.3.12)", 6,
       symmetric({0.39216144400731413928, 0.33259913678935943860, -0.70624617255763935981,
                  0.08221359629355080023})},
      {"suzuki_umeno8", "Suzuki and Umeno 1993, fifteen stages, GNI (V.3.14)", 8,
       symmetric({0.74167036435061295345, -0.40910082580003159400, 0.19075471029623837995,
                  -0.57386247111608226666, 0.29906418130365592384, 0.33462491824529818378,
                  0.31529309239676659663})},
  };
  return all;
}

}  // namespace hamel
