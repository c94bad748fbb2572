#include <hamel/framework/graph/system_formulas.hpp>

#include <utility>

namespace hamel::graph {
namespace {

std::map<std::string, FormulasOfParameters>& formulas_of_types() {
  static std::map<std::string, FormulasOfParameters> all;
  return all;
}

}  // namespace

void add_system_formulas(const std::string& key, FormulasOfParameters formulas) {
  formulas_of_types()[key] = std::move(formulas);
}

const FormulasOfParameters* find_system_formulas(const std::string& key) {
  const auto found = formulas_of_types().find(key);
  return found == formulas_of_types().end() ? nullptr : &found->second;
}

}  // namespace hamel::graph
