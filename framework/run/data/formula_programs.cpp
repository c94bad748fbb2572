#include <hamel/framework/run/data/formula_programs.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/framework/graph/number.hpp>

namespace hamel {

namespace {

using Numbers = std::vector<graph::Number>;

// Formulas recorded over the variables of a system.
class RecordedFormulas {
 public:
  RecordedFormulas(const DataFormulas& formulas, size_t coordinates, size_t dim)
      : f_(formulas), dim_(dim) {
    const size_t count = coordinates + 1 + f_.inputs + dim;
    for (size_t i = 0; i < count; ++i)
      variables_.push_back(recording_.input("v" + std::to_string(i)));
    coordinates_.assign(variables_.begin(),
                        variables_.begin() + static_cast<std::ptrdiff_t>(coordinates));
  }

  Numbers outputs(Evaluation e) {
    switch (e) {
      case Evaluation::inertia: return entries(f_.inertia);
      case Evaluation::constraints: return constraints();
      case Evaluation::holonomic: return entries(f_.holonomic);
      case Evaluation::potential: return entries(f_.potential);
      case Evaluation::applied_force: return entries(f_.force);
      case Evaluation::force: return force();
      case Evaluation::inertial_force: return slopes(kinetic_energy());
      case Evaluation::rates: return rates();
    }
    return {};
  }
  graph::Code code(const Numbers& outputs) const {
    graph::Program::Outputs named;
    for (const graph::Number& y : outputs) named.emplace_back("y", y);
    return graph::Code(std::make_shared<const graph::Program>(recording_, named));
  }

 private:
  Numbers entries(const FormulaMatrix& matrix) const {
    Numbers out;
    for (const FormulaMatrix::Entry& e : matrix.entries) out.push_back(e.value.record(variables_));
    return out;
  }
  Numbers slopes(const graph::Number& value) const {
    return graph::gradient({value}, {1}, coordinates_);
  }
  graph::Number velocity(Eigen::Index i) const {
    return variables_[variables_.size() - dim_ + static_cast<size_t>(i)];
  }
  // Its terms that depend on the configuration.
  graph::Number kinetic_energy() const {
    graph::Number sum = 0;
    for (const FormulaMatrix::Entry& e : f_.inertia.entries)
      sum += 0.5 * velocity(e.row) * velocity(e.column) * e.value.record(variables_);
    return sum;
  }
  Numbers constraints() const {
    Numbers out = entries(f_.rows);
    append(out, entries(f_.drift));
    append(out, state_rows());
    size_t entry = 0;
    const Numbers values = entries(f_.holonomic);
    for (Eigen::Index i = 0; i < f_.holonomic.constant.rows(); ++i) {
      const bool is_formula = entry < values.size() && f_.holonomic.entries[entry].row == i;
      append(out, slopes(is_formula ? values[entry++] : graph::Number(0)));
    }
    return out;
  }
  Numbers state_rows() const {
    const auto first = variables_.end() - static_cast<std::ptrdiff_t>(dim_);
    const Numbers velocities(first, variables_.end());
    Numbers at_rest(variables_.begin(), first), out;
    at_rest.resize(variables_.size(), graph::Number(0));
    size_t entry = 0;
    for (Eigen::Index i = 0; i < f_.states.constant.rows(); ++i) {
      const bool is_formula = entry < f_.states.entries.size() && f_.states.entries[entry].row == i;
      if (!is_formula) {
        out.resize(out.size() + dim_, graph::Number(0));
        out.emplace_back(f_.states.constant(i, 0));
        continue;
      }
      const Expression& rate = f_.states.entries[entry++].value;
      append(out, graph::gradient({rate.record(variables_)}, {1}, velocities));
      out.push_back(rate.record(at_rest));
    }
    return out;
  }
  Numbers force() const {
    Numbers out = entries(f_.force);
    if (f_.potential.is_constant() && f_.inertia.is_constant()) return out;
    graph::Number lagrangian = kinetic_energy();
    for (const graph::Number& v : entries(f_.potential)) lagrangian -= v;
    append(out, slopes(lagrangian));
    return out;
  }
  Numbers rates() {
    Numbers rates;
    for (size_t i = 0; i < variables_.size(); ++i)
      rates.push_back(recording_.input("rate" + std::to_string(i)));
    Numbers out(static_cast<size_t>(f_.own_rows()) + dim_);
    const auto add = [&](const FormulaMatrix& matrix, Eigen::Index first, double sign,
                         bool times_velocity) {
      const Numbers changes = graph::along(entries(matrix), variables_, rates);
      for (size_t k = 0; k < changes.size(); ++k) {
        const FormulaMatrix::Entry& e = matrix.entries[k];
        out[static_cast<size_t>(first + e.row)] +=
            sign * changes[k] * (times_velocity ? velocity(e.column) : 1);
      }
    };
    add(f_.rows, 0, -1, true);
    add(f_.drift, 0, 1, false);
    add(f_.states, f_.rows.constant.rows(), 1, false);
    add(f_.inertia, f_.own_rows(), 1, true);
    return out;
  }
  static void append(Numbers& to, const Numbers& from) {
    to.insert(to.end(), from.begin(), from.end());
  }

  graph::Recording recording_;
  const DataFormulas& f_;
  size_t dim_;
  Numbers variables_, coordinates_;
};

}  // namespace

FormulaPrograms::FormulaPrograms(DataFormulas formulas, size_t coordinates, size_t dim)
    : formulas_(std::move(formulas)), coordinates_(coordinates), dim_(dim) {}

const graph::Code& FormulaPrograms::code(Evaluation e) const {
  Entry& entry = codes_[static_cast<size_t>(e)];
  std::call_once(entry.once, [&] { entry.code = record(e); });
  return *entry.code;
}

graph::Code FormulaPrograms::record(Evaluation e) const {
  RecordedFormulas recorded(formulas_, coordinates_, dim_);
  return recorded.code(recorded.outputs(e));
}

}  // namespace hamel
