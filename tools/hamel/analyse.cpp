// hamel describe --analyse: what a system is, read off its equations.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/analysis/analysis.hpp>
#include <hamel/framework/io/note_lines.hpp>
#include <hamel/systems/by_name.hpp>

#include "commands.hpp"
#include "words/screen.hpp"

namespace hamel::tools {
namespace {

using Json = nlohmann::ordered_json;

Json rows_of(const Eigen::MatrixXd& m) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < m.cols(); ++j) row.push_back(m(i, j));
    out.push_back(row);
  }
  return out;
}

void print_rows(const Eigen::MatrixXd& m) {
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    say("    ");
    for (Eigen::Index j = 0; j < m.cols(); ++j) say(" {:>10.5g}", m(i, j) + 0.0);
    say("\n");
  }
}

// Is it nonholonomic? In a sentence.
std::string verdict(const Analysis& a) {
  if (a.rows == 0) return "no constraint";
  if (a.holonomic_rows == a.rows) return "holonomic: every row is the differential of a function";
  std::string growth;
  for (int d : a.growth.dimensions) growth += fmt::format("{}{}", growth.empty() ? "" : ", ", d);
  const std::string drift = a.growth.with_drift ? " (the drift among them)" : "";
  const int reached = a.growth.dimensions.back(), possible = a.n - a.holonomic_rows;
  const std::string left = a.holonomic_rows > 0 ? " that the holonomic rows leave" : "";
  if (!a.growth.decided()) {
    const std::string nearby =
        a.growth.nearby < 0 ? "" : fmt::format("; nearby they span {}", a.growth.nearby);
    return fmt::format(
        "{}: brackets of up to {} fields{} span {} of {} directions{} (growth {}){}; {}",
        a.integrable() ? "nonholonomic" : "not decided", a.growth.looked_at, drift, reached,
        possible, left, growth, nearby,
        a.growth.near_zero   ? "others are too small to distinguish from zero"
        : a.growth.round_off ? "stopped: deeper ones drown in round-off"
                             : "stopped there");
  }
  if (*a.integrable()) {
    return fmt::format(
        "integrable: {} is closed under brackets (dimension {}); the constraint is {}",
        a.growth.with_drift ? "d with the drift" : "d", a.m,
        a.growth.with_drift ? "holonomic, with time in it, in disguise" : "holonomic in disguise");
  }
  if (reached == possible) {
    return fmt::format("nonholonomic: brackets of {} fields{} span all {} directions{} (growth {})",
                       a.growth.dimensions.size(), drift, reached, left, growth);
  }
  return fmt::format(
      "nonholonomic, but brackets of fields{} reach only {} of {} directions{} (growth {}): {} of "
      "the rows, or of "
      "their "
      "combinations, can be integrated",
      drift, reached, possible, left, growth, possible - reached);
}

}  // namespace

int analyse(const DescribeOptions& options) {
  const Analysis a = [&] {
    const Elapsed elapsed(options.name + " is analysed");
    return hamel::analyse(registry(), options.name, options.parameters);
  }();
  if (options.json) {
    Json structure = Json::array(), conserved = Json::array();
    for (const auto& c : a.structure) structure.push_back(rows_of(c));
    for (const auto& c : a.conserved) {
      conserved.push_back({{"expression", c.expression}, {"change", c.change}});
    }
    const auto integrable = a.integrable();
    const Json json = {{"system", options.name},
                       {"dimension", a.n},
                       {"rows", a.rows},
                       {"rank", a.rank},
                       {"holonomic_rows", a.holonomic_rows},
                       {"directions", a.m},
                       {"left_invariant", a.left_invariant},
                       {"affine", a.growth.with_drift},
                       {"growth", a.growth.dimensions},
                       {"growth_nearby", a.growth.nearby < 0 ? Json() : Json(a.growth.nearby)},
                       {"growth_decided", a.growth.decided()},
                       {"bracket_depth", a.growth.looked_at},
                       {"integrable", integrable ? Json(*integrable) : Json()},
                       {"verdict", verdict(a)},
                       {"frame", rows_of(a.frame)},
                       {"structure_constants", structure},
                       {"conserved", conserved},
                       {"notes", a.notes}};
    say_json(json);
    return 0;
  }
  say("{}: n = {}, {} row{} of rank {}{}{}, {} direction{}; {}\n", options.name, a.n, a.rows,
      a.rows == 1 ? "" : "s", a.rank,
      a.holonomic_rows > 0 ? fmt::format(" ({} holonomic)", a.holonomic_rows) : "",
      a.rank < a.rows ? ", some redundant" : "", a.m, a.m == 1 ? "" : "s",
      a.left_invariant      ? "left-invariant"
      : a.growth.with_drift ? "rows with a drift or with time in them, not left-invariant"
                            : "not left-invariant");
  say("  {}\n", verdict(a));
  if (a.m > 0) {
    say("  Hamel frame at the start (columns, I-orthonormal)\n");
    print_rows(a.frame);
  }
  for (size_t d = 0; d < a.structure.size(); ++d) {
    say("  structure constants along direction {}: [X_i, X_j]\n", d + 1);
    print_rows(a.structure[d]);
  }
  say("  kept along eight motions of up to 20 s (E energy, J spatial momentum, velocities by "
      "name)\n");
  if (a.conserved.empty()) say("     nothing among their linear combinations\n");
  for (const auto& c : a.conserved) say("     {}   (change {:.1e})\n", c.expression, c.change);
  say("{}", note_lines(a.notes, 9, Notes{options.verbose}));
  return 0;
}

}  // namespace hamel::tools
