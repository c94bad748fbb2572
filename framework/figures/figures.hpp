// The figures of each kind of result, in the order of its page: one list for the report page, the
// files of `hamel report --figure` and Python.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/figures/figure.hpp>
#include <hamel/framework/io/export.hpp>

namespace hamel {
struct EnsembleResult;
class Registry;
struct Result;
struct Fit;
struct Section;
struct SteadySweep;
struct StudyResult;
struct SystemModel;
}  // namespace hamel

namespace hamel::figures {

/// Bodies that move, the path in the plane, the body axes on the sphere; inputs, velocities and
/// shape by unit, reactions by part, energy balance, momenta; errors with the floor of round-off.
/// What the run does not have is left out; none of a run without rows.
HAMEL_API std::vector<Figure> of_run(const Registry& registry, const Result& result);

/// The part of of_run that shows the motion.
std::vector<Figure> motion_of_run(const Registry& registry, const Result& result);

/// A run, and its name beside others.
struct NamedRun {
  std::string name;
  const Result* result;
};
/// Errors, velocities and coordinates of several runs: a curve for each run.
HAMEL_API std::vector<Figure> of_runs(const std::vector<NamedRun>& runs);

/// Work-precision diagrams, errors over step and tolerance, growth with a parameter, heat maps.
HAMEL_API std::vector<Figure> of_study(const StudyResult& result);

/// Kept numbers over the varied ones, in pairs, their distributions, their moments in time.
HAMEL_API std::vector<Figure> of_ensemble(const EnsembleResult& result);

/// Real (growth) and imaginary parts (frequency) of the eigenvalues along sweep.parameter.
HAMEL_API std::vector<Figure> of_sweep(const SteadySweep& sweep);

/// Points of a section in the plane of two columns "A,B"; "": of the first two that vary most.
/// ConfigError for columns that it does not have; none where no two columns vary.
HAMEL_API std::vector<Figure> of_fit(const hamel::Fit& fit);
HAMEL_API std::vector<Figure> of_section(const Section& section, const std::string& axes = "");

/// A JSON object: the names of the figures, and each as the block of a report page
/// (tools/report/README.md).
HAMEL_API std::string to_json(const std::vector<Figure>& figures);

/// Unit of a parameter of a system or of an option of a run; "" where it has none.
HAMEL_API std::string unit_of(const std::string& name, const SystemModel& system);

/// Gives each figure a name, from its title where it has none, with -no2, -no3, ... for further
/// ones of the same name.
void name_apart(std::vector<Figure>& figures);
/// Figures that stand in no section stand in this one.
void put_in_section(const char* section, std::vector<Figure>& figures);

}  // namespace hamel::figures
