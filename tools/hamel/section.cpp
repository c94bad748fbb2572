// hamel section: the states in which motions cross an event, as a table and as a page.
#include "section.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/io/note_lines.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/pages/page.hpp>
#include <hamel/systems/by_name.hpp>

#include "lines/help.hpp"
#include "words/interrupt.hpp"
#include "words/screen.hpp"

namespace hamel::tools {

using pages::Cell;
using pages::Figure;
using pages::Page;
using pages::page_mistakes;
namespace {

using Json = nlohmann::ordered_json;

Page page_of(const SectionOptions& options, const Section& section) {
  Page page(
      "Section of " + options.config.system,
      fmt::format("the states where {}, {} points", options.request.event, section.points.rows()));
  page.section("Points");
  const std::vector<Figure> points = figures::of_section(section, options.axes);
  page.add(points, "Points");
  if (points.empty())
    page.text({"No two columns vary over the points: the motions are periodic, or at rest."});
  page.section("Motions");
  std::vector<std::vector<Cell>> rows;
  for (size_t i = 0; i < section.orbits.size(); ++i) {
    const SectionOrbit& o = section.orbits[i];
    rows.push_back({Cell(static_cast<double>(i + 1)), Cell(static_cast<double>(o.found)),
                    Cell(o.time), Cell(o.energy), Cell(o.energy_change),
                    Cell(o.reason.empty() ? "all found" : o.reason)});
  }
  page.table("Starts", {"start", "points", "t [s]", "energy [J]", "its change [J]", "end"}, rows);
  return page;
}

Json json_of(const SectionOptions& options, const Section& section) {
  Json starts = Json::array();
  for (const SectionOrbit& o : section.orbits) {
    starts.push_back({{"configuration", o.start.configuration},
                      {"velocity", o.start.velocity},
                      {"energy", o.energy},
                      {"energy_change", o.energy_change},
                      {"found", o.found},
                      {"time", o.time},
                      {"reason", o.reason}});
  }
  Json columns = Json::array(), units = Json::array(), rows = Json::array();
  for (const TableColumn& column : section.points.columns) {
    columns.push_back(column.name);
    units.push_back(column.unit);
  }
  for (size_t i = 0; i < section.points.rows(); ++i) {
    Json row = Json::array();
    for (const TableColumn& column : section.points.columns)
      std::visit([&](const auto& values) { row.push_back(values[i]); }, column.values);
    rows.push_back(std::move(row));
  }
  return {{"system", options.config.system},
          {"event", options.request.event},
          {"direction", options.request.direction},
          {"status", section.complete ? "ok" : "failed"},
          {"points", section.points.rows()},
          {"starts", starts},
          {"columns", columns},
          {"units", units},
          {"rows", rows},
          {"version", version()},
          {"git", git_hash()}};
}

void print(const SectionOptions& options, const Section& section) {
  say("{}: {} points where {}\n", options.config.system, section.points.rows(),
      options.request.event);
  constexpr size_t kMost = 20;
  for (size_t i = 0; i < std::min(kMost, section.orbits.size()); ++i) {
    const SectionOrbit& o = section.orbits[i];
    say("  start {:<4} {} points to t = {:.6g} s, energy {:.6g} J, changed by {:.1e} J{}\n", i + 1,
        o.found, o.time, o.energy, o.energy_change, o.reason.empty() ? "" : "; " + o.reason);
  }
  if (section.orbits.size() > kMost) say("  and {} more\n", section.orbits.size() - kMost);
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const SectionOrbit& o : section.orbits) {
    least = std::min(least, o.energy);
    most = std::max(most, o.energy);
  }
  if (most - least > 1e-6 * std::max(std::abs(least), std::abs(most)))
    say("{}", note_lines(
                  {fmt::format("the starts have energies from {:.6g} to {:.6g} J: not one surface; "
                               "--energy E gives all the same",
                               least, most)},
                  13, Notes{options.verbose}));
}

}  // namespace

// Options that a section makes no use of; until is how long it waits.
static const std::vector<std::string> kOfRows = {"every",   "output_step", "output_times", "events",
                                                 "stop_at", "check",       "no_exact",     "until"};

void SectionLine::define(CLI::App& app) {
  line_.define_run(app, {kOfRows.begin(), kOfRows.end()});
  for (const char* name : {"event", "direction", "count", "starts", "energy", "report", "axes",
                           "output", "json", "quiet", "verbose"})
    line_.own[name];
  for (const std::string& name : RobotLine::keys()) line_.own[name];
  app.add_option("--event", options_.request.event,
                 "the event that is crossed: a name (hamel describe SYSTEM) or a formula, as for "
                 "--events of hamel run");
  app.add_option("--direction", options_.request.direction,
                 "1: crossings where its function grows, -1: where it falls [0: both]");
  number_option(app, "--count", options_.request.count, "points of each start");
  app.add_option("--starts", options_.starts,
                 "a CSV file of starts: the columns of the element and of the velocity, as -o "
                 "writes them");
  number_option(app, "--energy", options_.request.energy,
                "every start gets this energy, in J, by a factor of its velocity");
  number_option(app, "--until", options_.request.longest, "give a start up after so many seconds");
  app.add_option("-o,--output", options_.output, "write the points, .csv or .h5");
  app.add_option("--report", options_.report, "write a self-contained HTML page");
  app.add_option("--axes", options_.axes, "columns of the page's axes, A,B [the first that vary]");
  app.add_flag("--json", options_.json, "print everything as JSON");
  app.add_flag("--quiet", options_.quiet, "print nothing but errors (and --json)");
  add_verbose(app, options_.verbose);
  group_options(app, "Section", {"--event", "--direction", "--count", "--starts", "--energy"});
  group_options(app, "Motion",
                {"--config", "--set", "--input", "--configuration", "--velocity", "--momentum",
                 "--speed", "--from", "--until"});
  group_options(
      app, "Method",
      {"--scheme", "--retraction", "--s", "--step", "--rtol", "--atol", "--step-max", "--steps-max",
       "--solver", "--tolerance", "--force-at", "--compose", "--force", "--on-failure"});
  group_options(app, "Output",
                {"--output", "--report", "--axes", "--json", "--quiet", "--verbose"});
  app.footer(
      "Without a scheme, a step and a tolerance: dop853 at rtol 1e-10.\n"
      "Exit status: 0 done, 1 points are missing (those found are written), 2 bad input.\n"
      "Examples:\n"
      "  hamel section suslov_in_potential --set inertia=2,0,0,3,0,4 --event 'omega1=0' --count "
      "400\n"
      "  hamel section routh_sphere --event 'R33=0.5' --count 200 -o sphere.csv\n"
      "  hamel section rattleback --event reversed --direction 1 --count 10 --json");
}

// Takes from the file the settings of the section itself, unless the line gives them.
void SectionLine::take_from_file(const CLI::App& app) {
  SectionRequest& request = options_.request;
  long direction = request.direction;
  line_.take(app, "event", request.event);
  line_.take(app, "direction", direction);
  request.direction = static_cast<int>(std::clamp(direction, -2L, 2L));
  line_.take(app, "count", request.count);
  line_.take(app, "energy", request.energy);
  line_.take(app, "starts", options_.starts);
  line_.take(app, "output", options_.output);
  line_.take(app, "report", options_.report);
  line_.take(app, "axes", options_.axes);
  line_.take(app, "json", options_.json);
  line_.take(app, "quiet", options_.quiet);
  line_.take(app, "verbose", options_.verbose);
}

SectionOptions SectionLine::resolve(const CLI::App& app) {
  options_.config = line_.resolve(app).config;
  take_from_file(app);
  std::vector<std::string> missing;
  for (const char* name : {"event", "count"}) {
    if (app.count(fmt::format("--{}", name)) == 0 && line_.own[name].values.empty())
      missing.push_back(fmt::format("--{0} is required, or {0} in the file of --config", name));
  }
  if (!missing.empty()) throw ConfigError(missing);
  if (const Config usual; !line_.config_file.empty()) {
    std::vector<std::string> mistakes;
    for (const std::string& name : kOfRows) {
      if (name != "until" && options_.config.text(name) != usual.text(name))
        mistakes.push_back(fmt::format(
            "{}: {}: got {}, expected none: a section has no rows and ends with its points",
            line_.config_file, name, options_.config.text(name)));
    }
    if (!mistakes.empty()) throw ConfigError(mistakes);
    if (!options_.request.longest && options_.config.until != usual.until)
      options_.request.longest = std::abs(options_.config.until - options_.config.from);
  }
  return options_;
}

int section(const SectionOptions& given) {
  SectionOptions options = given;
  if (!options.report.empty()) {
    if (const auto mistakes = page_mistakes(options.report); !mistakes.empty())
      throw ConfigError(mistakes);
  }
  const bool hdf5 = options.output.ends_with(".h5");
  if (!options.output.empty() && !hdf5 && !options.output.ends_with(".csv"))
    throw ConfigError({fmt::format("--output: got '{}', expected .csv or .h5", options.output)});
  if (!options.output.empty()) {
    if (const std::string why = unwritable(options.output); !why.empty()) throw ConfigError({why});
  }
  Simulation simulation(registry(), options.config.system);
  simulation.config(options.config);
  if (!options.starts.empty())
    options.request.starts = read_starts(options.starts, registry(), options.config);
  Section section;
  {
    Progress progress("section", options.quiet);
    section = hamel::section(
        simulation, options.request, [&](double fraction) { progress(fraction); },
        &stop_when_asked());
  }
  if (hdf5) section.points.write_hdf5(options.output, {{"event", options.request.event}});
  else if (!options.output.empty()) write_file(options.output, section.points.csv());
  if (!options.report.empty()) page_of(options, section).write(options.report);
  if (options.json) say_json(json_of(options, section));
  else if (!options.quiet) print(options, section);
  return section.complete ? 0 : 1;
}

}  // namespace hamel::tools
