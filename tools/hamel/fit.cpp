// hamel fit: parameters, starts and inputs from recordings, as text, JSON, a file and a page.
#include "fit.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
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
using pages::Page;
using pages::page_mistakes;
namespace {

using Json = nlohmann::ordered_json;

std::string status_of(const Fit& fit) {
  return fit.ok() ? "ok" : fit.converged ? "undetermined" : "failed";
}

// "mass 0.71, inertia 0.71".
std::string direction_text(const std::map<std::string, double>& direction) {
  std::string out;
  for (const auto& [name, coefficient] : direction)
    out += fmt::format("{}{} {:.2f}", out.empty() ? "" : ", ", name, coefficient);
  return out;
}

Json number_or_null(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json json_of_fit(const FitOptions& options, const Fit& fit) {
  Json parameters = Json::object(), names = Json::array(), covariance = Json::array(),
       undetermined = Json::array();
  for (const FittedNumber& one : fit.parameters) {
    parameters[one.name] = {
        {"value", one.value}, {"sigma", number_or_null(one.sigma)}, {"unit", one.unit}};
    names.push_back(one.name);
  }
  for (int i = 0; i < fit.covariance.rows; ++i) {
    Json row = Json::array();
    for (int j = 0; j < fit.covariance.columns; ++j)
      row.push_back(number_or_null(fit.covariance(i, j)));
    covariance.push_back(std::move(row));
  }
  for (const auto& direction : fit.undetermined) undetermined.push_back(direction);
  return {{"system", options.config.system},
          {"status", status_of(fit)},
          {"reason", fit.reason},
          {"parameters", parameters},
          {"names", names},
          {"covariance", covariance},
          {"chi2", fit.chi2},
          {"dof", fit.dof},
          {"sigma", fit.sigma},
          {"undetermined", undetermined},
          {"segments", fit.segments},
          {"iterations", fit.iterations},
          {"runs", fit.runs},
          {"seconds", fit.seconds},
          {"notes", fit.notes},
          {"version", version()},
          {"git", git_hash()}};
}

std::string sigma_text(const FittedNumber& one) {
  return std::isfinite(one.sigma) ? fmt::format("{:.3g}", one.sigma) : "undetermined";
}

void print_fit(const FitOptions& options, const Fit& fit) {
  say("fit of {}: {}, {} iterations, {} runs\n", options.config.system, status_of(fit),
      fit.iterations, fit.runs);
  if (!fit.reason.empty()) say("  reason       {}\n", fit.reason);
  for (const FittedNumber& one : fit.parameters)
    say("  {:<20} {:<22.12g} +- {} {}\n", one.name, one.value, sigma_text(one), one.unit);
  say("  chi2         {:.6g}, {} degrees of freedom\n", fit.chi2, fit.dof);
  for (const auto& [name, sigma] : fit.sigma)
    say("  sigma        {} = {:.4g}{}\n", name, sigma,
        options.request.sigma.contains(name) ? "" : ", estimated from the residuals");
  if (std::ranges::any_of(fit.segments, [](int n) { return n > 1; }))
    say("  segments     {}\n", fmt::join(fit.segments, ", "));
  for (const auto& direction : fit.undetermined)
    say("  undetermined the data do not see relative changes along {}\n",
        direction_text(direction));
  say("{}", note_lines(fit.notes, 15, Notes{options.verbose}));
}

Page page_of_fit(const FitOptions& options, const Fit& fit) {
  Page page("Fit of " + options.config.system,
            fmt::format("{} recordings, {} degrees of freedom", options.request.recordings.size(),
                        fit.dof));
  page.section("Numbers");
  std::vector<std::vector<Cell>> rows;
  for (const FittedNumber& one : fit.parameters)
    rows.push_back(
        {Cell(one.name), Cell(one.value), Cell(sigma_text(one)), Cell(one.guess), Cell(one.unit)});
  page.table("Fitted numbers", {"name", "value", "sigma", "guess", "unit"}, rows);
  std::vector<std::string> texts = {
      fmt::format("chi2 = {:.6g} over {} degrees of freedom.", fit.chi2, fit.dof)};
  for (const auto& direction : fit.undetermined)
    texts.push_back("Undetermined: " + direction_text(direction) + " (relative changes).");
  page.text(texts);
  std::vector<std::string> head = {""};
  std::vector<std::vector<Cell>> correlations;
  for (int i = 0; i < fit.covariance.rows; ++i) {
    const std::string& name = fit.parameters[static_cast<size_t>(i)].name;
    head.push_back(name);
    std::vector<Cell>& row = correlations.emplace_back();
    row.emplace_back(name);
    for (int j = 0; j < fit.covariance.columns; ++j)
      row.emplace_back(fit.covariance(i, j) /
                       std::sqrt(fit.covariance(i, i) * fit.covariance(j, j)));
  }
  page.table("Correlations", head, correlations);
  page.section("Data and fit");
  page.add(figures::of_fit(fit), "Data and fit");
  return page;
}

// "name=rest" into its two parts.
std::pair<std::string, std::string> named_text(const char* option, const std::string& text) {
  const size_t equal = text.find('=');
  if (equal == 0 || equal == std::string::npos || equal + 1 == text.size())
    throw ConfigError({fmt::format("{}: got '{}', expected NAME=VALUE", option, text)});
  return {text.substr(0, equal), text.substr(equal + 1)};
}

}  // namespace

// Options that a fit makes no use of: its rows are those of the data.
static const std::vector<std::string> kOfFittedRows = {
    "every", "output_step", "output_times", "events", "stop_at", "check", "no_exact", "until"};

void FitLine::define(CLI::App& app) {
  line_.define_run(app, {kOfFittedRows.begin(), kOfFittedRows.end()});
  for (const std::string& name : RobotLine::keys()) line_.own[name];
  app.add_option("DATA", data_, "recordings, CSV: a header with t and names of quantities")
      ->required();
  app.add_option("--fit", names_,
                 "numbers to fit: NAME, NAME=guess or NAME=guess:low:high of parameters, "
                 "start.omega, start.x, inputs that are constant")
      ->required()
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--sigma", sigmas_,
                 "COLUMN=VALUE: standard deviations [estimated from the residuals]")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--observe", observed_,
                 "COLUMN=FORMULA of coordinates, velocities and parameters: a marker, say "
                 "(repeatable)")
      ->allow_extra_args(false);
  app.add_option("--loss", loss_, "huber:K: outliers beyond K sigma count less [squares]");
  app.add_option("--segments", options_.request.segments,
                 "segments of each recording, whose first states are unknowns too (multiple "
                 "shooting) [by how fast a displacement grows]");
  app.add_option("-o,--output", options_.output, "write the fitted run, .toml");
  app.add_option("--report", options_.report, "write a self-contained HTML page");
  app.add_flag("--json", options_.json, "print everything as JSON");
  app.add_flag("--quiet", options_.quiet, "print nothing but errors (and --json)");
  add_verbose(app, options_.verbose);
  group_options(app, "Fit", {"--fit", "--sigma", "--observe", "--loss", "--segments"});
  group_options(app, "Motion",
                {"--config", "--set", "--input", "--configuration", "--velocity", "--momentum",
                 "--speed", "--from"});
  group_options(
      app, "Method",
      {"--scheme", "--retraction", "--s", "--step", "--rtol", "--atol", "--step-max", "--steps-max",
       "--solver", "--tolerance", "--force-at", "--compose", "--force", "--on-failure"});
  group_options(app, "Output", {"--output", "--report", "--json", "--quiet", "--verbose"});
  app.footer(
      "Without a scheme, a step and a tolerance: dop853 at rtol 1e-10.\n"
      "Exit status: 0 done, 1 not converged or a direction is undetermined, 2 bad input.\n"
      "Examples:\n"
      "  hamel fit chaplygin_sleigh sleigh.csv --fit offset,start.v1,start.omega "
      "--sigma omega=0.01,v1=0.01\n"
      "  hamel fit cart.toml a.csv b.csv --fit hitch.damping=0.5:0:5 -o fitted.toml --report "
      "fit.html\n"
      "  hamel fit chaplygin_sleigh camera.csv --fit offset --observe 'tip=x+0.5*cos(theta)' "
      "--loss huber:1.5");
}

FitOptions FitLine::resolve(const CLI::App& app) {
  options_.config = line_.resolve(app).config;
  FitRequest& request = options_.request;
  std::vector<std::string> mistakes;
  const auto collect = [&](const std::function<void()>& read) {
    try {
      read();
    } catch (const ConfigError& error) {
      mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
    }
  };
  for (const std::string& text : names_)
    collect([&] { request.names.push_back(parse_fit_name(text)); });
  for (const std::string& text : sigmas_) {
    collect([&] {
      const auto [name, value] = named_text("--sigma", text);
      read_text("--sigma: " + name, value, request.sigma[name]);
    });
  }
  for (const std::string& text : observed_)
    collect([&] { request.observe.insert(named_text("--observe", text)); });
  collect([&] {
    if (loss_.empty() || loss_ == "squares") return;
    if (!loss_.starts_with("huber:"))
      throw ConfigError({fmt::format("--loss: got '{}', expected squares or huber:K", loss_)});
    request.huber = 0;
    read_text("--loss: huber", loss_.substr(6), *request.huber);
  });
  for (const std::string& path : data_)
    collect([&] { request.recordings.push_back(read_recording(path)); });
  if (!mistakes.empty()) throw ConfigError(mistakes);
  return options_;
}

int fit(const FitOptions& options) {
  if (!options.report.empty()) {
    if (const auto mistakes = page_mistakes(options.report); !mistakes.empty())
      throw ConfigError(mistakes);
  }
  if (!options.output.empty() && !options.output.ends_with(".toml"))
    throw ConfigError({fmt::format("--output: got '{}', expected .toml", options.output)});
  if (!options.output.empty()) {
    if (const std::string why = unwritable(options.output); !why.empty()) throw ConfigError({why});
  }
  Simulation simulation(registry(), options.config.system);
  simulation.config(options.config);
  Fit fit;
  {
    const Elapsed elapsed("fit");
    fit = hamel::fit(simulation, options.request, {}, &stop_when_asked());
  }
  if (!options.output.empty() && fit.converged) write_file(options.output, fit.run.to_toml());
  if (!options.report.empty()) page_of_fit(options, fit).write(options.report);
  if (options.json) say_json(json_of_fit(options, fit));
  else if (!options.quiet) print_fit(options, fit);
  return fit.ok() ? 0 : 1;
}

}  // namespace hamel::tools
