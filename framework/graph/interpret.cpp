#include <hamel/framework/graph/interpret.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace hamel::graph {
namespace {

// ---- order ----

// Instructions by operation, ready before others.
class Scheduler {
 public:
  explicit Scheduler(const Program& program) : program_(program) {
    const std::vector<Instruction>& code = program.instructions();
    missing_.assign(code.size(), 0);
    users_.resize(code.size());
    for (size_t i = 0; i < code.size(); ++i) {
      for (const int v : {code[i].a, code[i].b, code[i].c}) {
        if (v < program.first_result()) continue;
        ++missing_[i];
        users_[static_cast<size_t>(v - program.first_result())].push_back(i);
      }
      if (missing_[i] == 0) make_ready(i);
    }
  }
  // The longest run that can begin; false at the end.
  bool next(std::vector<size_t>& run) {
    const auto longest =
        std::max_element(ready_.begin(), ready_.end(),
                         [](const auto& a, const auto& b) { return a.size() < b.size(); });
    run.clear();
    if (longest->empty()) return false;
    // Instructions of the same operation that become ready meanwhile join the run.
    for (size_t k = 0; k < longest->size(); ++k) {
      const size_t i = (*longest)[k];
      run.push_back(i);
      for (const size_t user : users_[i]) {
        if (--missing_[user] == 0) make_ready(user);
      }
    }
    longest->clear();
    return true;
  }

 private:
  void make_ready(size_t i) {
    ready_[static_cast<size_t>(program_.instructions()[i].op)].push_back(i);
  }
  const Program& program_;
  std::vector<int> missing_;  // operands that are not computed yet, of each instruction
  std::vector<std::vector<size_t>> users_;
  std::array<std::vector<size_t>, static_cast<size_t>(Op::cos_beyond) + 1> ready_;
};

// ---- runs ----

double mask(bool condition) { return std::bit_cast<double>(condition ? ~std::uint64_t{0} : 0); }
std::uint64_t bits(double mask) { return std::bit_cast<std::uint64_t>(mask); }

template <int W, class F>
inline void each(const Interpreter::Run& run, const std::array<unsigned, 3>* operands,
                 double* values, F f) {
  double* __restrict to = values + run.to * W;
  for (size_t i = run.begin; i < run.end; ++i, to += W) {
    const double *a = values + operands[i][0] * W, *b = values + operands[i][1] * W,
                 *c = values + operands[i][2] * W;
    double result[W];
    for (int j = 0; j < W; ++j) result[j] = f(a[j], b[j], c[j]);
    for (int j = 0; j < W; ++j) to[j] = result[j];
  }
}

// Functions of the C library.
template <int W>
void call(const Interpreter::Run& run, const std::array<unsigned, 3>* operands, double* values) {
  const Op op = run.op;
  each<W>(run, operands, values, [op](double a, double b, double) {
    if (is_beyond(op) && std::abs(b) <= kLargestAngle) return a;
    return evaluate(op, a, b);
  });
}

template <int W>
inline void compute(const Interpreter::Run& run, const std::array<unsigned, 3>* operands,
                    double* values) {
  const auto each_of = [&](auto f) { each<W>(run, operands, values, f); };
  switch (run.op) {
    case Op::add: return each_of([](double a, double b, double) { return a + b; });
    case Op::subtract: return each_of([](double a, double b, double) { return a - b; });
    case Op::multiply: return each_of([](double a, double b, double) { return a * b; });
    case Op::divide: return each_of([](double a, double b, double) { return a / b; });
    case Op::min: return each_of([](double a, double b, double) { return b < a ? b : a; });
    case Op::max: return each_of([](double a, double b, double) { return a < b ? b : a; });
    case Op::negate: return each_of([](double a, double, double) { return -a; });
    case Op::abs: return each_of([](double a, double, double) { return std::abs(a); });
    case Op::sqrt: return each_of([](double a, double, double) { return std::sqrt(a); });
    case Op::round: return each_of([](double a, double, double) { return std::rint(a); });
    case Op::less: return each_of([](double a, double b, double) { return mask(a < b); });
    case Op::less_equal: return each_of([](double a, double b, double) { return mask(a <= b); });
    case Op::equal: return each_of([](double a, double b, double) { return mask(a == b); });
    case Op::both:
      return each_of(
          [](double a, double b, double) { return std::bit_cast<double>(bits(a) & bits(b)); });
    case Op::either:
      return each_of(
          [](double a, double b, double) { return std::bit_cast<double>(bits(a) | bits(b)); });
    case Op::opposite:
      return each_of([](double a, double, double) { return std::bit_cast<double>(~bits(a)); });
    case Op::select:
      return each_of([](double a, double b, double c) { return bits(a) != 0 ? b : c; });
    default: return call<W>(run, operands, values);
  }
}

template <int W>
inline void interpret(const Interpreter::Plan& plan, const double* x, double* y, double* values) {
  std::copy_n(x, plan.inputs * W, values);
  double* constants = values + plan.inputs * W;
  for (size_t i = 0; i < plan.constants.size(); ++i) {
    for (int j = 0; j < W; ++j) constants[i * W + static_cast<size_t>(j)] = plan.constants[i];
  }
  for (const Interpreter::Run& run : plan.runs) compute<W>(run, plan.operands.data(), values);
  for (size_t k = 0; k < plan.results.size(); ++k) {
    std::copy_n(values + plan.results[k] * W, W, y + k * W);
  }
}

[[gnu::flatten]] void interpret_1(const Interpreter::Plan& plan, const double* x, double* y,
                                  double* s) {
  interpret<1>(plan, x, y, s);
}
[[gnu::flatten]] void interpret_4(const Interpreter::Plan& plan, const double* x, double* y,
                                  double* s) {
  interpret<4>(plan, x, y, s);
}
[[gnu::flatten]] void interpret_8(const Interpreter::Plan& plan, const double* x, double* y,
                                  double* s) {
  interpret<8>(plan, x, y, s);
}

#ifdef __x86_64__
// AVX2 without FMA: the same bits.
[[gnu::flatten, gnu::target("avx2")]] void interpret_4_avx2(const Interpreter::Plan& plan,
                                                            const double* x, double* y, double* s) {
  interpret<4>(plan, x, y, s);
}
[[gnu::flatten, gnu::target("avx2")]] void interpret_8_avx2(const Interpreter::Plan& plan,
                                                            const double* x, double* y, double* s) {
  interpret<8>(plan, x, y, s);
}
bool has_avx2() {
  static const bool found = __builtin_cpu_supports("avx2");
  return found;
}
#else
constexpr auto interpret_4_avx2 = interpret_4, interpret_8_avx2 = interpret_8;
bool has_avx2() { return false; }
#endif

}  // namespace

Interpreter::Interpreter(const Program& program)
    : plan_{program.constants(), program.inputs().size(), {}, {}, {}} {
  const size_t first = static_cast<size_t>(program.first_result());
  std::vector<unsigned> values(static_cast<size_t>(program.value_count()));  // their new numbers
  for (size_t i = 0; i < first; ++i) values[i] = static_cast<unsigned>(i);
  const auto value = [&](int v) { return v < 0 ? 0 : values[static_cast<size_t>(v)]; };

  Scheduler scheduler(program);
  for (std::vector<size_t> run; scheduler.next(run);) {
    const size_t begin = plan_.operands.size();
    for (const size_t i : run) {
      const Instruction& instruction = program.instructions()[i];
      values[first + i] = static_cast<unsigned>(first + plan_.operands.size());
      plan_.operands.push_back({value(instruction.a), value(instruction.b), value(instruction.c)});
    }
    const Op op = program.instructions()[run.front()].op;
    plan_.runs.push_back({op, begin, plan_.operands.size(), first + begin});
  }
  for (const int v : program.results()) plan_.results.push_back(value(v));
}

void Interpreter::run(int width, const double* x, double* y, double* work) const {
  if (width == 1) return interpret_1(plan_, x, y, work);
  if (width == 4) return (has_avx2() ? interpret_4_avx2 : interpret_4)(plan_, x, y, work);
  return (has_avx2() ? interpret_8_avx2 : interpret_8)(plan_, x, y, work);
}

}  // namespace hamel::graph
