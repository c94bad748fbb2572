#include <hamel/framework/graph/taylor_series.hpp>

#include <cmath>
#include <stdexcept>

namespace hamel::graph {
namespace {

// f of f' = g, by the recurrence of g: (1 + a^2) g_j = -2 a g_{j-1} - g_{j-2} of 1/(1 + x^2),
// (1 - a^2) (j + 1) g_{j+1} = (2 j + 1) a g_j + j g_{j-1} of 1/sqrt(1 - x^2).
Series series_of_slope(Op op, double a, int order) {
  Series g{}, out{};
  const bool circle = op != Op::atan;
  g[0] = circle ? 1 / std::sqrt(1 - a * a) : 1 / (1 + a * a);
  out[0] = evaluate(op, a, 0);
  const double sign = op == Op::acos ? -1 : 1;
  for (int j = 0; j < order; ++j) {
    const auto i = static_cast<size_t>(j);
    const double before = j > 0 ? g[i - 1] : 0;
    out[i + 1] = sign * g[i] / (j + 1);
    g[i + 1] = circle ? ((2 * j + 1) * a * g[i] + j * before) / ((1 - a * a) * (j + 1))
                      : (-2 * a * g[i] - before) / (1 + a * a);
  }
  return out;
}

// y' = 1 - y^2.
Series tanh_series(double a, int order) {
  Series out{};
  out[0] = std::tanh(a);
  for (size_t j = 0; j < static_cast<size_t>(order); ++j) {
    double sum = j == 0 ? 1 : 0;
    for (size_t i = 0; i <= j; ++i) sum -= out[i] * out[j - i];
    out[j + 1] = sum / static_cast<double>(j + 1);
  }
  return out;
}

// Functions whose fourth derivative is themselves.
Series turning_series(Op op, double a, int order) {
  std::array<double, 4> derivatives{};
  switch (op) {
    case Op::exp: derivatives.fill(std::exp(a)); break;
    case Op::sin: derivatives = {std::sin(a), std::cos(a), -std::sin(a), -std::cos(a)}; break;
    case Op::cos: derivatives = {std::cos(a), -std::sin(a), -std::cos(a), std::sin(a)}; break;
    case Op::sinh: derivatives = {std::sinh(a), std::cosh(a), std::sinh(a), std::cosh(a)}; break;
    case Op::cosh: derivatives = {std::cosh(a), std::sinh(a), std::cosh(a), std::sinh(a)}; break;
    default: throw std::logic_error("graph::series_of: not a function of one number");
  }
  Series out{};
  double factorial = 1;
  for (size_t j = 0; j <= static_cast<size_t>(order); ++j) {
    out[j] = derivatives[j % 4] / factorial;
    factorial *= static_cast<double>(j + 1);
  }
  return out;
}

}  // namespace

Series power_series(double a, double p, int order) {
  Series out{};
  double binomial = 1;
  for (int j = 0; j <= order && binomial != 0; ++j) {
    out[static_cast<size_t>(j)] = binomial * std::pow(a, p - j);
    binomial *= (p - j) / (j + 1);
  }
  return out;
}

Series inverse_series(double a, int order) {
  Series out{};
  out[0] = 1 / a;
  for (size_t j = 1; j <= static_cast<size_t>(order); ++j) out[j] = -out[j - 1] / a;
  return out;
}

Series log_series(double a, int order) {
  Series out{};
  out[0] = std::log(a);
  for (int j = 1; j <= order; ++j)
    out[static_cast<size_t>(j)] = (j % 2 == 1 ? 1 : -1) / (j * std::pow(a, j));
  return out;
}

Series series_of(Op op, double a, int order) {
  switch (op) {
    case Op::sqrt: return power_series(a, 0.5, order);
    case Op::asin:
    case Op::acos:
    case Op::atan: return series_of_slope(op, a, order);
    case Op::tanh: return tanh_series(a, order);
    case Op::log: return log_series(a, order);
    default: return turning_series(op, a, order);
  }
}

}  // namespace hamel::graph
