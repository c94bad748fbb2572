#include <hamel/framework/run/data/recorded_formulas.hpp>

#include <typeinfo>
#include <utility>

#include <hamel/framework/run/names/registry.hpp>

namespace hamel {
namespace {

using graph::Number;
using graph::SystemFormulas;
using Numbers = std::vector<Number>;

// Constant inertia and rows A xi = 0, without forces.
SystemFormulas formulas_of_constants(const Mechanics& mechanics, const double* g) {
  const int n = mechanics.dim(), k = mechanics.constraint_count();
  Eigen::MatrixXd inertia(n, n), a(k, n);
  Eigen::VectorXd b(k);
  mechanics.inertia(g, inertia);
  mechanics.constraints(0, g, a, b);
  SystemFormulas out;
  for (int i = 0; i < n; ++i)
    out.inertia.emplace_back(inertia.row(i).begin(), inertia.row(i).end());
  for (int i = 0; i < k; ++i) out.rows.emplace_back(a.row(i).begin(), a.row(i).end());
  return out;
}

}  // namespace

std::vector<graph::FactorShape> factor_shapes(const GroupInfo& group) {
  std::vector<graph::FactorShape> out;
  for (const GroupFactor& factor : group.factors)
    out.push_back({factor.name, factor.dim, factor.columns, factor.is_shape});
  return out;
}

RecordedFormulas recorded_formulas(const SystemModel& model, const Mechanics& mechanics,
                                   const double* g) {
  if (const auto* known = dynamic_cast<const graph::HasSystemFormulas*>(&mechanics))
    return [known](std::span<const Number> variables) { return known->system_formulas(variables); };
  if (mechanics.left_invariant())
    return [constants = formulas_of_constants(mechanics, g)](std::span<const Number>) {
      return constants;
    };
  const auto* typed = graph::find_system_formulas(problem_key(typeid(mechanics)));
  if (typed == nullptr) return {};
  Parameters parameters;
  for (const Field& field : model.fields)
    if (!field.value.empty()) parameters[field.name] = field.value;
  const std::size_t columns = model.group.columns.size(), inputs = model.inputs.size(),
                    n = static_cast<std::size_t>(mechanics.dim());
  return [typed, parameters = std::move(parameters), factors = factor_shapes(model.group), columns,
          inputs, n](std::span<const Number> variables) {
    const auto given = variables.subspan(columns + 1, variables.size() - columns - 1 - n);
    Numbers u(given.begin(), given.end());
    u.resize(inputs);  // 0 in a run that is given none
    return (*typed)(parameters, {graph::element_of(factors, variables.first(columns)),
                                 variables[columns], std::move(u)});
  };
}

}  // namespace hamel
