#include <hamel/framework/graph/nilpotent.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace hamel::graph {
namespace {

constexpr int kMostUnits = 16;
using Series = std::array<double, kMostUnits + 1>;  // f^(j)(a)/j!

bool is_known(Op op) { return op <= Op::log || op == Op::sin || op == Op::cos; }

// Series of x^p, p not an integer above 0.
Series power_series(double a, double p, int units) {
  Series out{};
  out[0] = std::pow(a, p);
  for (int j = 1; j <= units; ++j)
    out[static_cast<size_t>(j)] = out[static_cast<size_t>(j - 1)] * (p - j + 1) / (j * a);
  return out;
}

Series series_of(Op op, double a, int units) {
  Series out{};
  switch (op) {
    case Op::divide: return power_series(a, -1, units);
    case Op::sqrt: return power_series(a, 0.5, units);
    case Op::log:
      out[0] = std::log(a);
      for (int j = 1; j <= units; ++j)
        out[static_cast<size_t>(j)] = (j % 2 == 1 ? 1 : -1) / (j * std::pow(a, j));
      return out;
    default: break;
  }
  const double s = std::sin(a), c = std::cos(a), e = std::exp(a);
  const std::array<double, 4> turns = op == Op::sin   ? std::array{s, c, -s, -c}
                                      : op == Op::cos ? std::array{c, -s, -c, s}
                                                      : std::array{e, e, e, e};
  double factorial = 1;
  for (size_t j = 0; j <= static_cast<size_t>(units); ++j) {
    out[j] = turns[j % 4] / factorial;
    factorial *= static_cast<double>(j + 1);
  }
  return out;
}

// out = sum series_j n^j, n the nilpotent part of a: Horner.
void compose(int units, const Series& series, const double* a, double* out) {
  const size_t size = size_t{1} << units;
  std::vector<double> n(a, a + size), sum(size), next(size);
  n[0] = 0;
  sum[0] = series[static_cast<size_t>(units)];
  for (int j = units - 1; j >= 0; --j) {
    std::ranges::fill(next, 0.0);
    add_product(units, sum.data(), n.data(), next.data());
    next[0] += series[static_cast<size_t>(j)];
    sum.swap(next);
  }
  std::ranges::copy(sum, out);
}

// out = op(a, b); out is 0.
void apply(Op op, int units, const double* a, const double* b, double* out) {
  const size_t size = size_t{1} << units;
  switch (op) {
    case Op::add: std::transform(a, a + size, b, out, std::plus<>()); return;
    case Op::subtract: std::transform(a, a + size, b, out, std::minus<>()); return;
    case Op::multiply: add_product(units, a, b, out); return;
    case Op::divide: {
      std::vector<double> inverse(size);
      compose(units, series_of(op, *b, units), b, inverse.data());
      add_product(units, a, inverse.data(), out);
      return;
    }
    case Op::negate: std::transform(a, a + size, out, std::negate<>()); return;
    case Op::abs:
      if (*a < 0) std::transform(a, a + size, out, std::negate<>());
      else std::copy_n(a, size, out);
      return;
    case Op::min: std::copy_n(*b < *a ? b : a, size, out); return;
    case Op::max: std::copy_n(*a < *b ? b : a, size, out); return;
    case Op::round: *out = std::rint(*a); return;
    case Op::less: *out = *a < *b; return;
    case Op::less_equal: *out = *a <= *b; return;
    case Op::equal: *out = *a == *b; return;
    case Op::both: *out = *a != 0 && *b != 0; return;
    case Op::either: *out = *a != 0 || *b != 0; return;
    case Op::opposite: *out = *a == 0; return;
    default: compose(units, series_of(op, *a, units), a, out);
  }
}

}  // namespace

void add_product(int units, const double* a, const double* b, double* out) {
  if (units == 0) {
    *out += *a * *b;
    return;
  }
  const size_t half = size_t{1} << (units - 1);
  add_product(units - 1, a, b, out);
  add_product(units - 1, a, b + half, out + half);
  add_product(units - 1, a + half, b, out + half);
}

NilpotentEvaluation::NilpotentEvaluation(const Recording& recording,
                                         const std::vector<Number>& outputs)
    : recording_(recording), outputs_(outputs), slots_(recording.nodes().size(), -1) {
  const std::vector<Node>& nodes = recording.nodes();
  const auto need = [&](int node) {
    if (node >= 0) slots_[static_cast<size_t>(node)] = 0;
  };
  for (const Number& x : outputs) need(x.constant() ? -1 : x.node());
  for (size_t i = nodes.size(); i-- > 0;) {
    if (slots_[i] < 0 || operand_count(nodes[i].op) == 0) continue;
    possible_ = possible_ && is_known(nodes[i].op);
    need(nodes[i].a);
    need(nodes[i].b);
    need(nodes[i].c);
  }
  for (int& slot : slots_)
    if (slot >= 0) slot = static_cast<int>(slot_count_++);
}

std::vector<double> NilpotentEvaluation::operator()(int units, std::span<const double> inputs,
                                                    double noise) {
  const std::vector<Node>& nodes = recording_.nodes();
  const size_t size = size_t{1} << units;
  values_.assign(slot_count_ * size, 0.0);
  std::vector<double> noisy_a(size), noisy_b(size);
  const auto value = [&](int node) {
    return values_.data() + static_cast<size_t>(slots_[static_cast<size_t>(node)]) * size;
  };
  const auto operand = [&](int node, std::vector<double>& noisy) -> const double* {
    const double* exact = value(node);
    if (noise == 0) return exact;
    for (size_t i = 0; i < size; ++i) {
      seed_ = seed_ * 1664525u + 1013904223u;
      noisy[i] = exact[i] * (1 + noise * ((seed_ >> 8) * 0x1p-23 - 1));
    }
    return noisy.data();
  };
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (slots_[i] < 0) continue;
    const Node& node = nodes[i];
    double* const out = value(static_cast<int>(i));
    if (node.op == Op::constant) {
      out[0] = node.value;
      continue;
    }
    if (node.op == Op::input) {
      const size_t first = static_cast<size_t>(node.a) * size;
      if (first + size <= inputs.size())
        std::copy_n(inputs.begin() + static_cast<long>(first), size, out);
      continue;
    }
    if (node.op == Op::select) {
      std::copy_n(value(*value(node.a) != 0 ? node.b : node.c), size, out);
      continue;
    }
    const double* const a = operand(node.a, noisy_a);
    const double* const b = node.b < 0 ? nullptr : operand(node.b, noisy_b);
    apply(node.op, units, a, b, out);
  }
  std::vector<double> results(outputs_.size() * size, 0.0);
  for (size_t k = 0; k < outputs_.size(); ++k) {
    if (outputs_[k].constant()) results[k * size] = outputs_[k].value();
    else
      std::copy_n(value(outputs_[k].node()), size, results.begin() + static_cast<long>(k * size));
  }
  return results;
}

}  // namespace hamel::graph
