// Columns by formulas of others (`[outputs]`), made ready to be computed. Not installed.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// The parameters of a system as formulas have them, mass, inertia1, but for those whose name a
/// variable has.
std::map<std::string, double> constants_in_formulas(const SystemModel& system,
                                                    const std::vector<std::string>& variables);

struct ReadyOutput {
  std::size_t output;  // of the system
  std::size_t place;   // of its value among the variables
  Expression formula;
};

/// The outputs that are formulas of these variables, of parameters and of each other, each behind
/// those it depends on; its name becomes a variable. Calls missing(output, message) for the others.
std::vector<ReadyOutput> ready_outputs(
    const SystemModel& system, std::vector<std::string>& variables,
    const std::function<void(const OutputFormula&, const std::string&)>& missing = {});

/// Mistakes of the outputs of a system that is complete but for its mechanics: names that are
/// taken, formulas of what no run has.
std::vector<std::string> output_mistakes(const SystemModel& system);

/// The columns of the path of a sensor: "tip.path"; "" where it has none.
std::string path_column(const Sensor& sensor);
/// The column of the work of friction at a contact that has a slip: "base.friction_work".
std::string friction_work_column(const ContactLaw& law);

}  // namespace hamel
