// The matrices and vectors of a system by data, read from its file. Not installed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/toml_formulas.hpp>
#include <hamel/framework/run/data/formula_matrix.hpp>

namespace hamel {

/// Names allowed in the formulas of a system, beside t and its parameters.
struct DataNames {
  std::vector<std::string> coordinates, rates, inputs;  // those of states are the last
  size_t states = 0;

  /// Coordinates without states.
  std::vector<std::string> places() const {
    return {coordinates.begin(), coordinates.end() - static_cast<std::ptrdiff_t>(states)};
  }
};

inline std::vector<std::string> operator+(std::vector<std::string> a,
                                          const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class DataFormulasReader {
 public:
  DataFormulasReader(TomlReader& read, TomlFormulas& formulas, const toml::table& table,
                     const DataNames& names)
      : read_(read), formulas_(formulas), table_(table), names_(names) {}
  /// inputs: those that are variables; others are constants of `formulas`.
  DataFormulas read(const std::vector<std::string>& inputs);
  /// Names and texts of the formulas read last: "constraints[2, 1]" and its text.
  const std::vector<std::pair<std::string, std::string>>& texts() const { return texts_; }

 private:
  using Node = toml::node;
  using Names = std::vector<std::string>;
  Eigen::Index dim() const {
    return static_cast<Eigen::Index>(names_.rates.size() - names_.states);
  }
  void entry(const Node& node, const std::string& key, const Names& variables, FormulaMatrix& out,
             Eigen::Index i, Eigen::Index j);
  FormulaMatrix vector(const std::string& key, Eigen::Index size, const Names& variables);
  void rows(const Node& node, const std::string& key, const Names& variables, FormulaMatrix& out);
  void inertia(const Node& node, FormulaMatrix& out);
  void states(const Names& variables, FormulaMatrix& out);

  TomlReader& read_;
  TomlFormulas& formulas_;
  const toml::table& table_;
  const DataNames& names_;
  Names places_;
  std::vector<std::pair<std::string, std::string>> texts_;
};

}  // namespace hamel
