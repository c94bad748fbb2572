#include <hamel/framework/graph/nilpotent.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <hamel/framework/graph/taylor_series.hpp>

namespace hamel::graph {
namespace {

// Operations on numbers with units, with their work space.
class Operations {
 public:
  explicit Operations(int units)
      : units_(units),
        size_(size_t{1} << units),
        part_(size_),
        sum_(size_),
        next_(size_),
        inverse_(size_) {}

  // out = op(a, b); out is 0. plain: of a number without nilpotent part.
  void operator()(Op op, const double* a, bool plain_a, const double* b, bool plain_b,
                  double* out) {
    switch (op) {
      case Op::add: std::transform(a, a + size_, b, out, std::plus<>()); return;
      case Op::subtract: std::transform(a, a + size_, b, out, std::minus<>()); return;
      case Op::multiply:
        if (plain_a) scale(*a, b, out);
        else if (plain_b) scale(*b, a, out);
        else add_product(units_, a, b, out);
        return;
      case Op::divide:
        if (plain_b) std::transform(a, a + size_, out, [b](double x) { return x / *b; });
        else divide(a, b, out);
        return;
      case Op::negate: scale(-1, a, out); return;
      case Op::abs: scale(*a < 0 ? -1 : 1, a, out); return;
      case Op::min: std::copy_n(*b < *a ? b : a, size_, out); return;
      case Op::max: std::copy_n(*a < *b ? b : a, size_, out); return;
      case Op::round: *out = std::rint(*a); return;
      case Op::less: *out = *a < *b; return;
      case Op::less_equal: *out = *a <= *b; return;
      case Op::equal: *out = *a == *b; return;
      case Op::both: *out = *a != 0 && *b != 0; return;
      case Op::either: *out = *a != 0 || *b != 0; return;
      case Op::opposite: *out = *a == 0; return;
      case Op::atan2: turn(a, b, out); return;
      case Op::pow: power(a, b, plain_b, out); return;
      default: compose(series_of(op, *a, units_), a, out);
    }
  }

 private:
  void scale(double factor, const double* x, double* out) const {
    std::transform(x, x + size_, out, [factor](double y) { return factor * y; });
  }
  // out = sum series_j n^j, n the nilpotent part of a: Horner.
  void compose(const Series& series, const double* a, double* out) {
    std::copy_n(a, size_, part_.begin());
    part_[0] = 0;
    std::ranges::fill(sum_, 0.0);
    sum_[0] = series[static_cast<size_t>(units_)];
    for (int j = units_ - 1; j >= 0; --j) {
      std::ranges::fill(next_, 0.0);
      add_product(units_, sum_.data(), part_.data(), next_.data());
      next_[0] += series[static_cast<size_t>(j)];
      sum_.swap(next_);
    }
    std::ranges::copy(sum_, out);
  }
  void divide(const double* a, const double* b, double* out) {
    compose(inverse_series(*b, units_), b, inverse_.data());
    add_product(units_, a, inverse_.data(), out);
  }
  // The angle from (x0, y0) to (x, y) has the tangent (x0 y - y0 x)/(x0 x + y0 y).
  void turn(const double* y, const double* x, double* out) {
    std::vector<double> across(size_), along(size_), tangent(size_);
    for (size_t i = 1; i < size_; ++i) across[i] = *x * y[i] - *y * x[i];
    for (size_t i = 0; i < size_; ++i) along[i] = *x * x[i] + *y * y[i];
    divide(across.data(), along.data(), tangent.data());
    compose(series_of(Op::atan, 0, units_), tangent.data(), out);
    *out = std::atan2(*y, *x);
  }
  // exp(b log a), or the series of a constant exponent.
  void power(const double* a, const double* b, bool plain_b, double* out) {
    if (plain_b) return compose(power_series(*a, *b, units_), a, out);
    std::vector<double> log(size_), exponent(size_);
    compose(log_series(*a, units_), a, log.data());
    add_product(units_, log.data(), b, exponent.data());
    compose(series_of(Op::exp, exponent[0], units_), exponent.data(), out);
  }

  int units_;
  size_t size_;
  std::vector<double> part_, sum_, next_, inverse_;
};

}  // namespace

void add_product(int units, const double* a, const double* b, double* out) {
  if (units == 0) {
    *out += *a * *b;
    return;
  }
  if (units == 2) {
    out[0] += a[0] * b[0];
    out[1] += a[0] * b[1] + a[1] * b[0];
    out[2] += a[0] * b[2] + a[2] * b[0];
    out[3] += (a[0] * b[3] + a[3] * b[0]) + (a[1] * b[2] + a[2] * b[1]);
    return;
  }
  const size_t half = size_t{1} << (units - 1);
  add_product(units - 1, a, b, out);
  add_product(units - 1, a, b + half, out + half);
  add_product(units - 1, a + half, b, out + half);
}

NilpotentEvaluation::NilpotentEvaluation(const Recording& recording, std::vector<Number> outputs)
    : recording_(&recording),
      outputs_(std::move(outputs)),
      slots_(recording.nodes().size(), -1),
      needs_(recording.inputs().size(), false) {
  const std::vector<Node>& nodes = recording.nodes();
  const auto need = [&](int node) {
    if (node >= 0) slots_[static_cast<size_t>(node)] = 0;
  };
  for (const Number& x : outputs_) need(x.constant() ? -1 : x.node());
  for (size_t i = nodes.size(); i-- > 0;) {
    if (slots_[i] < 0) continue;
    if (nodes[i].op == Op::input) needs_[static_cast<size_t>(nodes[i].a)] = true;
    if (operand_count(nodes[i].op) == 0) continue;
    need(nodes[i].a);
    need(nodes[i].b);
    need(nodes[i].c);
  }
  for (int& slot : slots_)
    if (slot >= 0) slot = static_cast<int>(slot_count_++);
}

// Takes the value of an input, or of a constant.
void NilpotentEvaluation::take(const Node& node, size_t slot, size_t size,
                               std::span<const double> inputs) {
  double* const out = values_.data() + slot * size;
  if (node.op == Op::constant) {
    out[0] = node.value;
    return;
  }
  const size_t first = static_cast<size_t>(node.a) * size;
  if (first + size > inputs.size()) return;
  std::copy_n(inputs.begin() + static_cast<long>(first), size, out);
  plain_[slot] = std::all_of(out + 1, out + size, [](double x) { return x == 0; });
}

const std::vector<double>& NilpotentEvaluation::operator()(int units,
                                                           std::span<const double> inputs,
                                                           double noise) {
  const std::vector<Node>& nodes = recording_->nodes();
  const size_t size = size_t{1} << units;
  values_.assign(slot_count_ * size, 0.0);
  plain_.assign(slot_count_, true);
  std::array<std::vector<double>, 2> noisy = {std::vector<double>(size), std::vector<double>(size)};
  Operations operations(units);
  const auto slot = [&](int node) {
    return static_cast<size_t>(slots_[static_cast<size_t>(node)]);
  };
  const auto value = [&](int node) { return values_.data() + slot(node) * size; };
  const auto operand = [&](int node, std::vector<double>& shaken) -> const double* {
    if (node < 0) return nullptr;
    return noise == 0 ? value(node) : shake(value(node), noise, shaken);
  };
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (slots_[i] < 0) continue;
    const Node& node = nodes[i];
    const auto own = static_cast<size_t>(slots_[i]);
    double* const out = values_.data() + own * size;
    if (operand_count(node.op) == 0) {
      take(node, own, size, inputs);
    } else if (node.op == Op::select) {
      const int chosen = *value(node.a) != 0 ? node.b : node.c;
      std::copy_n(value(chosen), size, out);
      plain_[own] = plain_[slot(chosen)];
    } else {
      const double *const a = operand(node.a, noisy[0]), *const b = operand(node.b, noisy[1]);
      const bool plain_a = plain_[slot(node.a)], plain_b = node.b < 0 || plain_[slot(node.b)];
      const bool condition = is_condition(node.op);
      plain_[own] = condition || (plain_a && plain_b);
      if (plain_[own] && !condition) *out = evaluate(node.op, *a, b == nullptr ? 0 : *b);
      else operations(node.op, a, plain_a, b, plain_b, out);
    }
  }
  results_.assign(outputs_.size() * size, 0.0);
  for (size_t k = 0; k < outputs_.size(); ++k) {
    double* const out = results_.data() + k * size;
    if (outputs_[k].constant()) *out = outputs_[k].value();
    else std::copy_n(value(outputs_[k].node()), size, out);
  }
  return results_;
}

const double* NilpotentEvaluation::shake(const double* x, double noise, std::vector<double>& out) {
  for (size_t i = 0; i < out.size(); ++i) out[i] = x[i] == 0 ? 0 : x[i] * (1 + noise * random());
  return out.data();
}

double NilpotentEvaluation::random() {
  seed_ = seed_ * 1664525u + 1013904223u;
  return (seed_ >> 8) * 0x1p-23 - 1;
}

}  // namespace hamel::graph
