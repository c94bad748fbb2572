#include <hamel/framework/graph/straight_code.hpp>

#include <cstddef>

namespace hamel::graph {

StraightCode straighten(const Program& program) {
  StraightCode out{{}, {}, program.value_count(), -1};
  std::vector<int> same(
      static_cast<size_t>(program.value_count()));  // value that holds the bits of another
  for (size_t v = 0; v < same.size(); ++v) same[v] = static_cast<int>(v);
  const auto value = [&](int v) { return v < 0 ? -1 : same[static_cast<size_t>(v)]; };
  std::vector<bool> bounded(same.size(), false);

  int v = program.first_result();
  for (const Instruction& i : program.instructions()) {
    const Instruction renamed{i.op, value(i.a), value(i.b), value(i.c)};
    if (!is_beyond(i.op)) {
      out.instructions.push_back({v++, renamed});
      continue;
    }
    same[static_cast<size_t>(v++)] = renamed.a;
    if (bounded[static_cast<size_t>(renamed.b)]) continue;
    bounded[static_cast<size_t>(renamed.b)] = true;
    out.instructions.push_back({out.values, {Op::abs, renamed.b, -1, -1}});
    if (out.largest_angle >= 0) {
      out.instructions.push_back({out.values + 1, {Op::max, out.largest_angle, out.values, -1}});
      ++out.values;
    }
    out.largest_angle = out.values++;
  }
  for (const int result : program.results()) out.results.push_back(value(result));
  return out;
}

}  // namespace hamel::graph
