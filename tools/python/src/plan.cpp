// Plans: hamel.plan.
#include <hamel/framework/inverse/motion_plan.hpp>

#include "long_call.hpp"

namespace hamel::python {
namespace {

const char* words(PlanStatus status) {
  if (status == PlanStatus::ok) return "ok";
  return status == PlanStatus::out_of_reach ? "out_of_reach" : "failed";
}

Plan plan(nb::handle file) {
  const PlanRequest request = read_plan(text("file", file));
  return long_call(nb::none(), [&](std::atomic<bool>& stop, const std::function<void(double)>&) {
    return make_plan(registry(), request, {}, &stop);
  });
}

std::map<std::string, std::vector<double>> by_name(
    const std::vector<std::pair<std::string, std::vector<double>>>& columns) {
  return {columns.begin(), columns.end()};
}

}  // namespace

void bind_plan(nb::module_& m) {
  nb::class_<Plan>(m, "Plan",
                   "Inputs that take a system to a goal at the least cost; true where the goal is "
                   "reached.")
      .def("__bool__", [](const Plan& p) { return p.status == PlanStatus::ok; })
      .def_prop_ro(
          "status", [](const Plan& p) { return words(p.status); },
          "'ok', 'out_of_reach' or 'failed'")
      .def_ro("reason", &Plan::reason, "'' where the goal is reached")
      .def_ro("objective", &Plan::objective)
      .def_ro("until", &Plan::until, "s")
      .def_ro("step", &Plan::step, "s")
      .def_ro("steps", &Plan::steps)
      .def_ro("defect_max", &Plan::defect_max)
      .def_ro("iterations", &Plan::iterations)
      .def_ro("t", &Plan::t, "times of the states, s")
      .def_prop_ro(
          "inputs", [](const Plan& p) { return by_name(p.inputs); }, "a value for each step")
      .def_prop_ro(
          "states", [](const Plan& p) { return by_name(p.states); }, "a value for each time")
      .def_ro("missed", &Plan::missed, "goals out of reach, by how much")
      .def("csv", &Plan::csv, "The inputs as a table that --input reads, held.")
      .def(
          "feedback",
          [](const Plan& p, long step, const std::vector<double>& configuration,
             const std::vector<double>& velocity) {
            const std::vector<double> u = p.feedback(step, configuration, velocity);
            std::map<std::string, double> out;
            for (std::size_t i = 0; i < u.size(); ++i) out[p.inputs[i].first] = u[i];
            return out;
          },
          "step"_a, "configuration"_a, "velocity"_a,
          "The inputs of a step (from 0), corrected for a state beside the plan's by its gains.")
      .def("gains", &Plan::gains, "The gains along the plan as a table (hamel plan --track).")
      .def("__repr__", [](const Plan& p) {
        return std::string("<hamel.Plan: ") + words(p.status) + ", " + std::to_string(p.steps) +
               " steps>";
      });
  m.def("plan", &plan, "file"_a, nb::sig("def plan(file: str | os.PathLike[str]) -> Plan"),
        "The plan of a file (hamel plan). Ctrl-C ends it, with KeyboardInterrupt.");
}

}  // namespace hamel::python
