#include <hamel/framework/graph/machine_x86.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace hamel::graph {

std::string machine_code_refusal() {
#if defined(__x86_64__) && defined(__linux__)
  static const bool has_avx = __builtin_cpu_supports("avx");
  return has_avx ? "" : "the processor has no AVX";
#else
  return "it is written for x86-64 under Linux";
#endif
}

std::unique_ptr<const MachineCode> MachineCode::make(const Program& program, int width) {
  if (!machine_code_refusal().empty()) return nullptr;
  const int lanes = std::min(width, 4);
  std::unique_ptr<const MachineCode> code(new MachineCode(emit(program, lanes, width), width));
  return code->memory_.data() ? std::move(code) : nullptr;
}

MachineCode::MachineCode(EmittedCode code, int width)
    : code_(std::move(code)),
      memory_(code_.bytes),
      width_(static_cast<size_t>(width)),
      lanes_(std::min<size_t>(width_, 4)) {
  if (memory_.data() && width_ == 1 && code_.segments.size() == 1 &&
      code_.segments.front().calls.empty())
    whole_ = at(code_.segments.front().begin);
}

MachineCode::Function MachineCode::at(std::size_t byte) const {
  return reinterpret_cast<Function>(reinterpret_cast<std::uintptr_t>(memory_.data() + byte));
}

bool MachineCode::run(const double* x, double* y, double* work) const {
  if (whole_) {
    whole_(x, y, work, code_.table.data());
    return !code_.has_angles || *work <= kLargestAngle;
  }
  for (size_t first = 0; first < width_; first += lanes_) {
    // No addresses behind null, of programs without inputs or outputs.
    if (!run_lanes(x ? x + first : x, y ? y + first : y, work)) return false;
  }
  return true;
}

bool MachineCode::run_lanes(const double* x, double* y, double* work) const {
  const double* const bases[] = {x, work, code_.table.data()};
  const auto place = [&](const LaneAddress& a) {
    return bases[static_cast<size_t>(a.base)] + a.offset;
  };
  for (const Segment& segment : code_.segments) {
    at(segment.begin)(x, y, work, code_.table.data());
    for (const LibraryCall& call : segment.calls) {
      const double *a = place(call.a), *b = place(call.b);
      double* const to = work + call.to;
      for (size_t j = 0; j < lanes_; ++j) to[j] = evaluate(call.op, a[j], b[j]);
    }
  }
  if (!code_.has_angles) return true;
  bool within = true;  // false where it is not a number, too
  for (size_t j = 0; j < lanes_; ++j) within = within && work[j] <= kLargestAngle;
  return within;
}

}  // namespace hamel::graph
