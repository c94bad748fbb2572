// Terms and factors of formulas: what cancels, and what is constant.
#include <algorithm>
#include <cmath>

#include <hamel/framework/graph/formula_text.hpp>

namespace hamel::graph {

bool FormulaText::is_sum(int i) const {
  const Op op = node(i).op;
  return op == Op::add || op == Op::subtract;
}
bool FormulaText::is_product(int i) const {
  const Op op = node(i).op;
  return op == Op::multiply || op == Op::divide || op == Op::negate;
}

void FormulaText::collect_terms(int i, double sign, bool top,
                                std::vector<std::pair<double, int>>& out) const {
  const Node& n = node(i);
  if ((!top && named(i)) || (!is_sum(i) && n.op != Op::negate)) {
    out.emplace_back(sign, i);
    return;
  }
  collect_terms(n.a, n.op == Op::negate ? -sign : sign, false, out);
  if (n.op != Op::negate) collect_terms(n.b, n.op == Op::subtract ? -sign : sign, false, out);
}

void FormulaText::collect_factors(int i, int power, bool top, Factors& out) const {
  const Node& n = node(i);
  if (known(i)) {
    out.coefficient *= std::pow(*known(i), power);
  } else if (n.op == Op::constant) {
    out.coefficient *= std::pow(n.value, power);
  } else if (!top && named(i)) {
    out.add(i, power);
  } else if (!is_product(i)) {
    const std::vector<Factors> terms = is_sum(i) ? joined_terms(i) : std::vector<Factors>(2);
    if (terms.size() > 1) return out.add(i, power);
    out.coefficient *= terms.empty() ? 0 : std::pow(terms[0].coefficient, power);
    if (terms.empty()) return;
    for (const auto& [base, of_base] : terms[0].powers) out.add(base, power * of_base);
  } else if (n.op == Op::negate) {
    if (power % 2 != 0) out.coefficient = -out.coefficient;
    collect_factors(n.a, power, false, out);
  } else {
    collect_factors(n.a, power, false, out);
    collect_factors(n.b, n.op == Op::divide ? -power : power, false, out);
  }
}

// A term, or its coefficient at the one that has the same factors.
void FormulaText::add_term(std::vector<Factors>& terms, const Factors& term) {
  const auto other =
      std::ranges::find_if(terms, [&](const Factors& f) { return f.has_powers_of(term); });
  if (other == terms.end()) terms.push_back(term);
  else other->coefficient += term.coefficient;
}

void FormulaText::Factors::add(int node, int power) {
  const auto other = std::ranges::find(powers, node, &std::pair<int, int>::first);
  if (other == powers.end()) powers.emplace_back(node, power);
  else other->second += power;
}

bool FormulaText::Factors::has_powers_of(const Factors& other) const {
  return powers.size() == other.powers.size() &&
         std::is_permutation(powers.begin(), powers.end(), other.powers.begin());
}

// Terms with the same factors are one; constants are the last.
std::vector<FormulaText::Factors> FormulaText::joined_terms(int i) const {
  std::vector<std::pair<double, int>> terms;
  collect_terms(i, 1, true, terms);
  std::vector<Factors> joined;
  for (const auto& [sign, term] : terms) {
    Factors factors;
    factors.coefficient = sign;
    collect_factors(term, 1, false, factors);
    join_roots(factors);
    add_term(joined, factors);
  }
  while (join_squares(joined)) continue;
  std::erase_if(joined, [](const Factors& f) { return f.coefficient == 0; });
  std::stable_partition(joined.begin(), joined.end(),
                        [](const Factors& f) { return !f.powers.empty(); });
  return joined;
}

// sqrt(x)^2 is x.
void FormulaText::join_roots(Factors& factors) const {
  Factors out{factors.coefficient, {}};
  for (const auto& [base, power] : factors.powers) {
    const bool root = node(base).op == Op::sqrt && !named(base) && power % 2 == 0;
    if (root) collect_factors(node(base).a, power / 2, false, out);
    else if (power != 0) out.add(base, power);
  }
  factors = out;
}

bool FormulaText::is_square_of(const std::pair<int, int>& power, Op op, int& angle) const {
  angle = node(power.first).a;
  return power.second == 2 && node(power.first).op == op;
}

// f sin(x)^2 + f cos(x)^2 is f; true where there were such terms.
bool FormulaText::join_squares(std::vector<Factors>& terms) const {
  for (size_t i = 0; i < terms.size(); ++i) {
    for (size_t k = 0; k < terms[i].powers.size(); ++k) {
      int angle = -1, other_angle = -1;
      if (!is_square_of(terms[i].powers[k], Op::sin, angle)) continue;
      Factors rest = terms[i];
      rest.powers.erase(rest.powers.begin() + static_cast<std::ptrdiff_t>(k));
      const auto other = std::ranges::find_if(terms, [&](Factors f) {
        const auto cosine = std::ranges::find_if(f.powers, [&](const auto& power) {
          return is_square_of(power, Op::cos, other_angle) && other_angle == angle;
        });
        if (cosine == f.powers.end() || f.coefficient != rest.coefficient) return false;
        f.powers.erase(cosine);
        return f.has_powers_of(rest);
      });
      if (other == terms.end()) continue;
      const auto first = terms.begin() + static_cast<std::ptrdiff_t>(i);
      terms.erase(std::max(first, other));
      terms.erase(std::min(first, other));
      add_term(terms, rest);
      return true;
    }
  }
  return false;
}

// The number that its terms and factors leave of a node.
std::optional<double> FormulaText::constant_value(int i) const {
  if (is_sum(i)) {
    const std::vector<Factors> terms = joined_terms(i);
    if (terms.empty()) return 0;
    if (terms.size() == 1 && terms[0].powers.empty()) return terms[0].coefficient;
  } else if (is_product(i)) {
    Factors factors;
    collect_factors(i, 1, true, factors);
    join_roots(factors);
    if (factors.coefficient == 0) return 0;
    if (factors.powers.empty()) return factors.coefficient;
  } else if (node(i).op == Op::sqrt && known(node(i).a)) {
    return std::sqrt(*known(node(i).a));
  }
  return std::nullopt;
}

// In the order of nodes: each is known to those that it is part of, and needs no name.
void FormulaText::find_constants() {
  known_.resize(uses_.size());
  for (size_t i = 0; i < uses_.size(); ++i)
    if (uses_[i] > 0) known_[i] = constant_value(static_cast<int>(i));
  std::erase_if(order_, [this](int i) { return known(i).has_value(); });
  for (size_t i = 0; i < uses_.size(); ++i)
    if (known_[i]) names_[i].clear();
}

}  // namespace hamel::graph
