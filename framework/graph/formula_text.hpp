// Formulas of a recording as text to read: LaTeX, C, NumPy, SymPy.
//
// Products and sums are written as such, x x as a power. A value has a name of its own where it is
// used more than once and is not short, or where the formula that it is part of would be too long;
// all others stand where they are used. Terms that cancel are left out, sin^2 + cos^2 is 1. Factors
// of a product may be in another order than recorded, so that results are those of the program up
// to round-off.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/graph/notation.hpp>
#include <hamel/framework/graph/number.hpp>

namespace hamel::graph {

class FormulaText {
 public:
  /// A complete recording, whose inputs have these names, and the values that will be written.
  /// prefix: of the names of values, k in k1.
  FormulaText(const Recording& recording, Notation notation, std::vector<std::string> inputs,
              const std::vector<Number>& values, std::string prefix);

  /// Names of values and their formulas, each of inputs and earlier names.
  std::vector<std::pair<std::string, std::string>> definitions() const;
  std::string text(const Number& x) const;

 private:
  struct Written {  // and how tightly it holds together
    std::string text;
    int level;
  };
  struct Factors {
    double coefficient = 1;
    std::vector<std::pair<int, int>> powers;  // of nodes
    void add(int node, int power);
    bool has_powers_of(const Factors& other) const;
  };
  void count_uses(const std::vector<Number>& values);
  void choose_names();
  void find_constants();
  const std::optional<double>& known(int node) const { return known_[static_cast<size_t>(node)]; }
  bool named(int node) const { return !names_[static_cast<size_t>(node)].empty(); }
  const Node& node(int i) const { return recording_.nodes()[static_cast<size_t>(i)]; }
  bool is_sum(int i) const;
  bool is_product(int i) const;
  Written written(int i) const;  // by its name, if it has one
  Written formula_of(int i) const;
  Written sum(int i) const;
  Written product(int i) const;
  Written call(int i) const;
  Written choice(int i) const;
  std::string within(int i, int level) const;  // in parentheses where it holds less together
  void collect_terms(int i, double sign, bool top, std::vector<std::pair<double, int>>& out) const;
  std::vector<Factors> joined_terms(int i) const;
  void join_roots(Factors& factors) const;
  static void add_term(std::vector<Factors>& terms, const Factors& term);
  bool is_square_of(const std::pair<int, int>& power, Op op, int& angle) const;
  bool join_squares(std::vector<Factors>& terms) const;
  std::optional<double> constant_value(int i) const;
  void collect_factors(int i, int power, bool top, Factors& out) const;
  std::string power_text(int i, int power) const;
  std::string product_text(const Factors& factors) const;

  const Recording& recording_;
  Notation notation_;
  std::vector<std::string> inputs_;
  std::string prefix_;
  std::vector<int> uses_;
  std::vector<std::string> names_;            // of nodes; "": where it is used
  std::vector<int> order_;                    // of those with names
  std::vector<std::optional<double>> known_;  // of nodes that terms leave constant
};

}  // namespace hamel::graph
