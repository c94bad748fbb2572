// Figures of a fit: data and fitted motion, and what is left between them.
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/inverse/fit.hpp>

namespace hamel::figures {

std::vector<Figure> of_fit(const hamel::Fit& fit) {
  std::vector<Figure> out;
  for (size_t r = 0; r < fit.residuals.size(); ++r) {
    const Table& table = fit.residuals[r];
    const std::string behind =
        fit.residuals.size() > 1 ? fmt::format(", recording {}", r + 1) : std::string();
    const auto values = [&](size_t column) {
      return std::get<std::vector<double>>(table.columns[column].values);
    };
    Plot left{.x = {"t", "s"}, .y = {"(fit - datum) / sigma"}};
    for (size_t c = 1; c + 2 < table.columns.size(); c += 3) {
      const TableColumn& column = table.columns[c];
      Plot plot{.x = {"t", "s"}, .y = {column.name, column.unit}};
      plot.curves.push_back(
          {.name = "data", .unit = column.unit, .x = values(0), .y = values(c), .dots = true});
      plot.curves.push_back(
          {.name = "fit", .unit = column.unit, .x = values(0), .y = values(c + 1)});
      out.push_back({.title = fmt::format("{}: data and fit{}", column.name, behind),
                     .drawing = std::move(plot),
                     .section = "Data and fit"});
      left.curves.push_back(
          {.name = column.name, .x = values(0), .y = values(c + 2), .dots = true});
    }
    out.push_back({.title = "Residuals" + behind,
                   .drawing = std::move(left),
                   .note = "Two of three lie within 1 where sigma is right and the fit good.",
                   .section = "Data and fit"});
  }
  return out;
}

}  // namespace hamel::figures
