// Parts of the figures of a run, and the numbers that they share with its verdict.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <hamel/framework/figures/figure.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/record/result.hpp>

namespace hamel::figures {

/// Forces or moving constraints do.
bool does_work(const Result& result);

/// The inputs that drove it, by unit; nothing where all inputs are constant.
void add_inputs(std::vector<Figure>& out, const Result& result, const std::vector<Mark>& marks);

/// Body velocity and shape by unit, reactions with the sign of contacts, the energy balance where
/// work is done, body momentum. A component has one colour in all of them. `marks` are drawn in
/// each.
void add_physics(std::vector<Figure>& out, const Registry& registry, const Result& result,
                 const std::vector<Mark>& marks);

/// Errors, energy, constraints and group, each with the floor of round-off.
void add_accuracy(std::vector<Figure>& out, const Result& result);

/// Curves over time.
Figure over_time(std::string title, Axis y, std::vector<Curve> curves, std::string name = "",
                 std::string note = "", std::vector<Mark> marks = {});

/// Rows at about equal distances, the last among them.
std::vector<size_t> thin_rows(const Result& result, size_t points);
/// The coordinates of the element in a row.
std::span<const double> element(const Result& result, size_t row);

/// Column of a run against time, thinned.
Curve curve(const Result& result, const std::string& name, const std::string& column);

/// Magnitude of a column against time, for a logarithmic axis: the largest over windows.
Curve magnitude(const Result& result, const std::string& name, const std::string& column);

/// Description of the windows; "" where every recorded state is shown. Where the run has more
/// rows than are at hand this is stated, and the largest of all of each of these columns, as far
/// as a run measures it.
std::string windows_note(const Result& result, const std::vector<std::string>& columns);

/// Round-off in coordinates as large as those of this run.
double round_off(const Result& result);

/// Round-off of an error, a column of the run.
double floor_of(const Result& result, const std::string& column);

/// How a figure shows a measured column over time: title, axis and the note below it.
struct ErrorFigure {
  const char *column, *name, *title, *label, *note;
};
/// ErrorFigure of a column of Measurements; energy errors are relative to the start, or those of
/// the balance.
ErrorFigure error_figure(const std::string& column, bool balance = false);

}  // namespace hamel::figures
