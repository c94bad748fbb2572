#include <hamel/framework/graph/elimination.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace hamel::graph {
namespace {

constexpr double kLeastPivot = 0.05;  // of the largest entry of its row
constexpr double kLastingPivot = 0.3;
constexpr double kSmallestPivot = 1e-6;  // where there has to be one

double value_of_condition(Op op, double a, double b) {
  switch (op) {
    case Op::less: return a < b;
    case Op::less_equal: return a <= b;
    case Op::equal: return a == b;
    case Op::both: return a != 0 && b != 0;
    case Op::either: return a != 0 || b != 0;
    default: return a == 0;  // opposite
  }
}

class Elimination {
 public:
  Elimination(std::vector<std::vector<Number>>& a, std::vector<Number>& c,
              std::vector<Sample>& samples)
      : Elimination(a, c, samples, std::vector<bool>(a.front().size(), true)) {}
  Elimination(std::vector<std::vector<Number>>& a, std::vector<Number>& c,
              std::vector<Sample>& samples, std::vector<bool> allowed)
      : a_(a),
        c_(c),
        samples_(samples),
        allowed_(std::move(allowed)),
        row_done_(a.size()),
        column_done_(a.front().size()) {}

  // The pivots in the order in which they were taken, at most so many.
  std::vector<Pivot> run(std::vector<Number>& pivots, size_t most, size_t least = 0) {
    std::vector<Pivot> out;
    while (out.size() < most) {
      std::optional<Pivot> best = lasting_ ? cheapest(kLastingPivot) : std::nullopt;
      if (!best) best = cheapest(kLeastPivot);
      if (!best && out.size() < least) best = cheapest(kSmallestPivot);
      if (!best) break;
      take(*best, pivots);
      out.push_back(*best);
    }
    return out;
  }
  // Larger pivots first, which last longer along a motion.
  void prefer_lasting() { lasting_ = true; }
  // A pivot that was chosen before.
  void take(const Pivot& pivot, std::vector<Number>& pivots) {
    const auto [row, column] = pivot;
    if (!a_[row][column].constant()) pivots.push_back(a_[row][column]);
    take(row, column);
  }
  bool is_left(size_t row) const { return !row_done_[row]; }

 private:
  // Largest |entry| of a row that is left, over the samples.
  double largest(size_t row) {
    double out = 0;
    for (size_t j = 0; j < a_[row].size(); ++j) {
      if (column_done_[j] || a_[row][j].is(0)) continue;
      for (Sample& sample : samples_) out = std::max(out, std::abs(sample.value(a_[row][j])));
    }
    return out;
  }
  double least(const Number& x) {
    double out = std::numeric_limits<double>::infinity();
    for (Sample& sample : samples_) out = std::min(out, std::abs(sample.value(x)));
    return out;
  }
  size_t count_in_row(size_t row) const {
    size_t out = 0;
    for (size_t j = 0; j < a_[row].size(); ++j) out += !column_done_[j] && !a_[row][j].is(0);
    return out;
  }
  size_t count_in_column(size_t column) const {
    size_t out = 0;
    for (size_t i = 0; i < a_.size(); ++i) out += !row_done_[i] && !a_[i][column].is(0);
    return out;
  }
  std::optional<Pivot> cheapest(double least_part) {
    std::optional<Pivot> out;
    double least_cost = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < a_.size(); ++i) {
      if (row_done_[i]) continue;
      const double size = largest(i);
      const auto in_row = static_cast<double>(count_in_row(i));
      for (size_t j = 0; j < a_[i].size(); ++j) {
        const Number& x = a_[i][j];
        if (column_done_[j] || !allowed_[j] || x.is(0)) continue;
        const double value = least(x);
        if (!(value >= least_part * size) || !(value > 0)) continue;
        const auto in_column = static_cast<double>(count_in_column(j));
        const double fill = (in_row - 1) * (in_column - 1) + (x.constant() ? 0 : 3);
        const double cost = fill + (x.is(1) || x.is(-1) ? 0 : 1) - 0.5 * value / size;
        if (!(cost < least_cost)) continue;
        least_cost = cost;
        out = {i, j};
      }
    }
    return out;
  }
  // Row i by its pivot; less in all other rows that are left.
  void take(size_t i, size_t j) {
    row_done_[i] = column_done_[j] = true;
    const Number scale = 1 / a_[i][j];
    for (size_t k = 0; k < a_[i].size(); ++k)
      if (!column_done_[k]) a_[i][k] = a_[i][k] * scale;
    c_[i] = c_[i] * scale;
    for (size_t r = 0; r < a_.size(); ++r) {
      if (row_done_[r] || a_[r][j].is(0)) continue;
      const Number factor = a_[r][j];
      for (size_t k = 0; k < a_[r].size(); ++k)
        if (!column_done_[k]) a_[r][k] = a_[r][k] - factor * a_[i][k];
      c_[r] = c_[r] - factor * c_[i];
    }
  }

  std::vector<std::vector<Number>>& a_;
  std::vector<Number>& c_;
  std::vector<Sample>& samples_;
  std::vector<bool> allowed_;
  bool lasting_ = false;
  std::vector<bool> row_done_, column_done_;
};

// E and the particular velocity of eliminated rows, with the pivots in order.
void complete(const std::vector<std::vector<Number>>& a, const std::vector<Number>& c, Frame& out) {
  const size_t n = a.front().size();
  std::vector<bool> known(n, true);
  for (const auto& [row, column] : out.order) known[column] = false;
  for (size_t j = 0; j < n; ++j)
    if (known[j]) out.independent.push_back(static_cast<int>(j));
  const size_t m = out.independent.size();
  out.e.assign(n, std::vector<Number>(m));
  out.particular.assign(n, 0);
  for (size_t i = 0; i < m; ++i) out.e[static_cast<size_t>(out.independent[i])][i] = 1;
  for (size_t p = out.order.size(); p-- > 0;) {  // the last pivot's row has independent ones alone
    const auto [row, column] = out.order[p];
    out.particular[column] = c[row];
    for (size_t j = 0; j < n; ++j) {
      if (j == column || !known[j] || a[row][j].is(0)) continue;
      for (size_t i = 0; i < m; ++i) out.e[column][i] -= a[row][j] * out.e[j][i];
      out.particular[column] -= a[row][j] * out.particular[j];
    }
    known[column] = true;
  }
}

}  // namespace

double Sample::value(const Number& x) {
  if (x.constant()) return x.value();
  const std::vector<Node>& nodes = Recording::current().nodes();
  const auto at = [&](int i) { return i < 0 ? 0.0 : values_[static_cast<size_t>(i)]; };
  for (size_t i = values_.size(); i < nodes.size(); ++i) {
    const Node& node = nodes[i];
    const auto input = static_cast<size_t>(node.a);
    if (node.op == Op::input) values_.push_back(inputs_.at(input));
    else if (node.op == Op::constant) values_.push_back(node.value);
    else if (node.op == Op::select) values_.push_back(at(node.a) != 0 ? at(node.b) : at(node.c));
    else if (is_condition(node.op))
      values_.push_back(value_of_condition(node.op, at(node.a), at(node.b)));
    else values_.push_back(evaluate(node.op, at(node.a), at(node.b)));
  }
  return values_[static_cast<size_t>(x.node())];
}

Frame free_frame(size_t n) {
  Frame out{{}, std::vector(n, std::vector<Number>(n)), std::vector<Number>(n), {}, {}};
  for (size_t i = 0; i < n; ++i) {
    out.independent.push_back(static_cast<int>(i));
    out.e[i][i] = 1;
  }
  return out;
}

Frame eliminate(std::vector<std::vector<Number>> a, std::vector<Number> c,
                std::vector<Sample>& samples, bool lasting) {
  Frame out;
  Elimination elimination(a, c, samples);
  if (lasting) elimination.prefer_lasting();
  out.order = elimination.run(out.pivots, a.size());
  if (out.order.size() < a.size())
    throw std::domain_error("elimination: the rows depend on each other");
  complete(a, c, out);
  return out;
}

Frame eliminate(std::vector<std::vector<Number>> a, std::vector<Number> c,
                const std::vector<Pivot>& order) {
  Frame out;
  out.order = order;
  std::vector<Sample> none;
  Elimination elimination(a, c, none);
  for (const Pivot& pivot : order) elimination.take(pivot, out.pivots);
  complete(a, c, out);
  return out;
}

Eliminated eliminate_some(std::vector<std::vector<Number>> a, std::vector<Number> c,
                          std::vector<Sample>& samples, const std::vector<bool>& allowed,
                          size_t least, size_t most) {
  Eliminated out{std::move(a), std::move(c), {}, {}, {}};
  if (out.a.empty()) return out;
  Elimination elimination(out.a, out.c, samples, allowed);
  elimination.prefer_lasting();
  out.order = elimination.run(out.pivots, most, least);
  for (size_t i = 0; i < out.a.size(); ++i)
    if (elimination.is_left(i)) out.left.push_back(i);
  return out;
}

void Eliminated::complete(std::vector<Number>& x) const {
  std::vector<bool> known(x.size(), true);
  for (const auto& [row, column] : order) known[column] = false;
  for (size_t p = order.size(); p-- > 0;) {  // the last pivot's row has independent ones alone
    const auto [row, column] = order[p];
    Number value = c[row];
    for (size_t k = 0; k < x.size(); ++k)
      if (known[k]) value -= a[row][k] * x[k];
    x[column] = value;
    known[column] = true;
  }
}

void solve_symmetric(std::vector<std::vector<Number>> m, std::vector<Number>& r) {
  const size_t n = r.size();
  std::vector<Number> inverse(n);
  for (size_t j = 0; j < n; ++j) {
    for (size_t k = 0; k < j; ++k) {  // m_jk = L_jk D_k so far
      const Number scaled = m[j][k];
      m[j][k] *= inverse[k];
      m[j][j] -= m[j][k] * scaled;
      r[j] -= m[j][k] * r[k];
    }
    inverse[j] = 1 / m[j][j];
    for (size_t i = j + 1; i < n; ++i)
      for (size_t k = 0; k < j; ++k) m[i][j] -= m[i][k] * m[j][k];
  }
  for (size_t j = 0; j < n; ++j) r[j] *= inverse[j];
  for (size_t j = n; j-- > 0;)
    for (size_t i = j + 1; i < n; ++i) r[j] -= m[i][j] * r[i];
}

}  // namespace hamel::graph
