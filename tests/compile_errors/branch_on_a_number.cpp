// expect: use of deleted function .*operator bool
// layer: graph
#include <hamel/framework/graph/number.hpp>

using hamel::graph::Number;

Number larger(const Number& a, const Number& b) {
#ifdef MISTAKE  // a recorded formula would have only one of the branches
  if (a < b) return b;
  return a;
#else
  return select(a < b, b, a);
#endif
}
