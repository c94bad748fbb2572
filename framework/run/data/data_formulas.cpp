#include <hamel/framework/run/data/data_formulas.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace hamel {

DataFormulas DataFormulasReader::read(const Names& inputs) {
  const Names of_time = names_.coordinates + Names{"t"};
  places_ = names_.places();

  DataFormulas out;
  out.inputs = inputs.size();
  texts_.clear();
  out.inertia.constant = Eigen::MatrixXd::Identity(dim(), dim());
  if (const Node* node = table_.get("inertia")) inertia(*node, out.inertia);
  out.rows.constant.resize(0, dim());
  if (const Node* node = table_.get("constraints")) rows(*node, "constraints", of_time, out.rows);
  const Eigen::Index k = out.rows.constant.rows();
  out.drift = vector("drift", k, of_time + inputs);
  out.holonomic = vector("holonomic", -1, places_);
  out.force = vector("force", dim(), of_time + inputs + names_.rates);
  out.potential.constant = Eigen::MatrixXd::Zero(1, 1);
  if (const Node* node = table_.get("potential"))
    entry(*node, "potential", places_, out.potential, 0, 0);
  states(of_time + inputs + names_.rates, out.states);
  return out;
}

// Rates of [[state]]: formulas linear in the velocities.
void DataFormulasReader::states(const Names& variables, FormulaMatrix& out) {
  out.constant = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(names_.states), 1);
  if (names_.states == 0) return;
  const toml::array& tables = *table_.get_as<toml::array>("state");
  for (size_t i = 0; i < names_.states; ++i) {
    const Node* rate = tables[i].as_table()->get("rate");
    if (rate == nullptr) {
      read_.wrong(tables[i], "state.rate", "a formula linear in the velocities");
      continue;
    }
    entry(*rate, "state.rate", variables, out, static_cast<Eigen::Index>(i), 0);
    if (out.entries.empty() || out.entries.back().row != static_cast<Eigen::Index>(i)) continue;
    const Expression& formula = out.entries.back().value;
    if (formula.may_jump()) read_.wrong(*rate, "state.rate", "a formula that cannot jump");
    else if (formula.dependence(variables.size() - names_.rates.size(), variables.size()) ==
             Expression::Dependence::nonlinear)
      read_.wrong(*rate, "state.rate", "a formula that is linear in the velocities");
  }
}

// Entry of a matrix that has the size already.
void DataFormulasReader::entry(const Node& node, const std::string& key, const Names& variables,
                               FormulaMatrix& out, Eigen::Index i, Eigen::Index j) {
  if (node.is_number()) {
    out.constant(i, j) = formulas_.number(node, key);
    return;
  }
  const std::string where = fmt::format("{}: {}", read_.place(node), key);
  auto formula = formulas_.expression(node, key, variables);
  if (!formula) return;
  const std::string text = node.value<std::string>().value_or("");
  if (node.is_string())
    texts_.emplace_back(out.constant.size() == 1   ? key
                        : out.constant.cols() == 1 ? fmt::format("{}[{}]", key, i + 1)
                                                   : fmt::format("{}[{}, {}]", key, i + 1, j + 1),
                        text);
  if (formula->constant()) {
    out.constant(i, j) = (*formula)({});
    if (!std::isfinite(out.constant(i, j)))
      read_.wrong(node, key, fmt::format("a finite number, got {}", out.constant(i, j)));
    return;
  }
  out.constant(i, j) = 0;
  out.entries.push_back({i, j, std::move(*formula), text, where});
}
// A column of `size` entries, any number where it is negative; zeros where the file has none.
FormulaMatrix DataFormulasReader::vector(const std::string& key, Eigen::Index size,
                                         const Names& variables) {
  FormulaMatrix out;
  out.constant = Eigen::MatrixXd::Zero(std::max<Eigen::Index>(size, 0), 1);
  const Node* node = table_.get(key);
  if (node == nullptr) return out;
  const toml::array* array = node->as_array();
  const auto count = array == nullptr ? -1 : static_cast<Eigen::Index>(array->size());
  if (count < 0 || (size >= 0 && count != size)) {
    read_.wrong(*node, key,
                size < 0 ? "a list of formulas" : fmt::format("{} numbers or formulas", size));
    return out;
  }
  out.constant = Eigen::MatrixXd::Zero(count, 1);
  for (Eigen::Index i = 0; i < count; ++i)
    entry((*array)[static_cast<size_t>(i)], key, variables, out, i, 0);
  return out;
}
void DataFormulasReader::rows(const Node& node, const std::string& key, const Names& variables,
                              FormulaMatrix& out) {
  const toml::array* array = node.as_array();
  if (array == nullptr) return read_.wrong(node, key, fmt::format("rows of {} entries", dim()));
  out.constant = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(array->size()), dim());
  for (Eigen::Index i = 0; i < out.constant.rows(); ++i) {
    const Node& row = (*array)[static_cast<size_t>(i)];
    const toml::array* entries = row.as_array();
    if (entries == nullptr || static_cast<Eigen::Index>(entries->size()) != dim()) {
      read_.wrong(row, key, fmt::format("{} numbers or formulas in each row", dim()));
      continue;
    }
    for (Eigen::Index j = 0; j < dim(); ++j)
      entry((*entries)[static_cast<size_t>(j)], key, variables, out, i, j);
  }
}
// n rows, or the diagonal.
void DataFormulasReader::inertia(const Node& node, FormulaMatrix& out) {
  const toml::array* array = node.as_array();
  if (array == nullptr || static_cast<Eigen::Index>(array->size()) != dim()) {
    read_.wrong(node, "inertia", fmt::format("{} numbers or formulas, or {} rows", dim(), dim()));
  } else if (array->front().is_array()) {
    rows(node, "inertia", places_, out);
  } else {
    for (Eigen::Index i = 0; i < dim(); ++i)
      entry((*array)[static_cast<size_t>(i)], "inertia", places_, out, i, i);
  }
}

}  // namespace hamel
