#include <hamel/framework/inverse/fit_problem.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/quantities.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/run/record/state_columns.hpp>

namespace hamel {
namespace {

// Columns of the file of a run that are no function of a state, or say how good the run was.
bool is_of_runs_only(const SystemModel& system, const std::string& name) {
  if (std::ranges::any_of(kMeasuredColumns, [&](const Quantity& q) { return name == q.name; }))
    return name != kEnergy.name;
  const QuantityNames names(system);
  const StateVariables variables(system, names.variables());
  if (names.find(name) || std::ranges::count(variables.names(), name) > 0) return false;
  const StateColumns all(system, {.holonomic = true,
                                  .work = true,
                                  .reactions = true,
                                  .reaction_power = true,
                                  .exact = true,
                                  .acceleration = true,
                                  .modes = true,
                                  .paths = true});
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all.name(i) == name) return true;
  return false;
}

std::string place_of(const Recording& recording, size_t row) {
  if (row < recording.lines.size())
    return fmt::format("{}:{}", recording.name, recording.lines[row]);
  return fmt::format("{}: row {}", recording.name, row + 1);
}

Simulation simulation_of(const Simulation& simulation, const FitRequest& request) {
  Config config = simulation.config();
  if (config.leaves_method()) config.rtol = 1e-10;
  double last = config.from;
  for (const Recording& one : request.recordings)
    if (!one.t.empty()) last = std::max(last, one.t.back());
  if (last > config.from) config.until = last;
  config.output_times.clear();
  config.output_step.reset();
  config.check = false;
  Simulation out = simulation;
  return out.config(std::move(config));
}

std::vector<std::string> names_of(const FitRequest& request) {
  std::vector<std::string> out;
  for (const FitName& one : request.names) out.push_back(one.name);
  return out;
}

}  // namespace

FitProblem::FitProblem(const Simulation& simulation, const FitRequest& request)
    : simulation_(simulation_of(simulation, request)), request_(request) {
  std::vector<std::string> mistakes;
  if (request.names.empty()) mistakes.emplace_back("fit: expected names of numbers to fit");
  if (request.recordings.empty()) mistakes.emplace_back("fit: expected a recording");
  if (!mistakes.empty()) throw ConfigError(mistakes);
  system_ = simulation_.system();
  variables_ = std::make_unique<MotionVariables>("fit", simulation_, names_of(request));
  make_unknowns(mistakes);
  resolve_columns(mistakes);
  check_times(mistakes);
  for (const auto& [name, sigma] : request.sigma) {
    if (std::ranges::find(columns_, name) == columns_.end())
      mistakes.push_back("sigma: " + unknown_name("column of the data", name, columns_));
    if (!(sigma > 0) || !std::isfinite(sigma))
      mistakes.push_back(fmt::format("sigma: {}: got {}, expected a number above 0", name, sigma));
  }
  if (request.segments) {
    size_t rows = request.recordings.front().t.size();  // of the shortest
    for (const Recording& one : request.recordings) rows = std::min(rows, one.t.size());
    if (*request.segments < 1 || static_cast<size_t>(*request.segments) > rows)
      mistakes.push_back(
          fmt::format("segments: got {}, expected a whole number from 1 to {}, the "
                      "rows of the data",
                      *request.segments, rows));
  }
  if (request.huber && !(*request.huber > 0))
    mistakes.push_back(
        fmt::format("loss: huber: got {}, expected a number above 0", *request.huber));
  if (mistakes.empty() && data() < static_cast<Eigen::Index>(unknowns_.size()))
    mistakes.push_back(
        fmt::format("fit: {} data cannot determine {} numbers", data(), unknowns_.size()));
  if (!mistakes.empty()) throw ConfigError(mistakes);
}

void FitProblem::make_unknowns(std::vector<std::string>& mistakes) {
  const auto recordings = static_cast<int>(request_.recordings.size());
  for (int r = 0; r < recordings; ++r) {
    for (size_t i = 0; i < request_.names.size(); ++i) {
      const MotionVariable& variable = variables_->all()[i];
      if (r > 0 && variable.of_system()) continue;
      const FitName& given = request_.names[i];
      FitUnknown one{variable.name,
                     i,
                     variable.of_system() ? -1 : r,
                     given.guess.value_or(variable.value),
                     given.low,
                     given.high};
      if (r > 0) one.name += fmt::format("@{}", r + 1);
      if (r == 0 && !std::isfinite(one.guess))
        mistakes.push_back(fmt::format("fit: {}: expected a finite guess", one.name));
      if (r == 0 && !(one.low < one.guess && one.guess < one.high))
        mistakes.push_back(
            fmt::format("fit: {}: got {}:{}:{}, expected guess:low:high with the "
                        "guess between the bounds",
                        one.name, one.guess, one.low, one.high));
      unknowns_.push_back(one);
    }
  }
}

// A column of a recording as a quantity of the motion; a mistake, or "".
std::string FitProblem::resolve_column(Series& series, size_t c) {
  const std::string& name = series.recording->columns[c];
  const auto formula = request_.observe.find(name);
  const bool defined = formula != request_.observe.end();
  if (!defined && is_of_runs_only(*system_, name)) {
    left_out_.push_back(name);
    return "";
  }
  const QuantityNames quantities(*system_);
  const std::vector<std::string> more = StateVariables(*system_, quantities.variables()).names();
  if (!defined && name != kEnergy.name && !quantities.find(name) &&
      std::ranges::find(more, name) == more.end()) {
    std::vector<std::string> all = quantities.all();
    all.insert(all.end(), more.begin() + 1 + static_cast<std::ptrdiff_t>(all.size()), more.end());
    for (const auto& [column, unused] : request_.observe) all.push_back(column);
    return fmt::format("{}: column {}: {}", series.recording->name, c + 2,
                       unknown_name("quantity", name, all));
  }
  try {
    series.observed.add(*system_,
                        defined ? fmt::format("observe: {}", name)
                                : fmt::format("{}: {}", series.recording->name, name),
                        defined ? formula->second : name);
  } catch (const ConfigError& error) {
    return error.mistakes().front();
  }
  series.columns.push_back(c);
  const auto at = std::ranges::find(columns_, name);
  series.names.push_back(static_cast<size_t>(at - columns_.begin()));
  if (at == columns_.end()) columns_.push_back(name);
  return "";
}

void FitProblem::resolve_columns(std::vector<std::string>& mistakes) {
  for (const Recording& recording : request_.recordings) {
    Series& series = series_.emplace_back();
    series.recording = &recording;
    for (size_t c = 0; c < recording.columns.size(); ++c)
      if (const std::string wrong = resolve_column(series, c); !wrong.empty())
        mistakes.push_back(wrong);
    if (series.columns.empty() && mistakes.empty())
      mistakes.push_back(fmt::format("{}: no column is a quantity of the motion", recording.name));
    for (size_t row = 0; row < recording.t.size(); ++row)
      for (size_t k = 0; k < series.columns.size(); ++k)
        if (std::isfinite(recording.values[series.columns[k]][row]))
          column_of_.push_back(series.names[k]);
  }
  for (const auto& [name, formula] : request_.observe)
    if (std::ranges::find(columns_, name) == columns_.end() && mistakes.empty())
      mistakes.push_back("observe: " + unknown_name("column of the data", name, columns_));
}

void FitProblem::check_times(std::vector<std::string>& mistakes) const {
  const double from = simulation_.config().from;
  for (const Recording& recording : request_.recordings) {
    for (size_t row = 0; row < recording.t.size(); ++row) {
      const bool grows = row == 0 || recording.t[row] > recording.t[row - 1];
      if (recording.t[row] >= from && grows) continue;
      mistakes.push_back(
          grows ? fmt::format("{}: column t: got {}, before the start of the run at {}",
                              place_of(recording, row), recording.t[row], from)
                : fmt::format("{}: column t: got {}, expected more than of the row before",
                              place_of(recording, row), recording.t[row]));
      break;
    }
  }
  if (simulation_.config().step.value_or(1) < 0)
    mistakes.emplace_back("step: a fit runs forwards: expected a number above 0");
}

Eigen::VectorXd FitProblem::values_of(const Eigen::VectorXd& x, int recording) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(variables_->size()));
  for (size_t i = 0; i < unknowns_.size(); ++i)
    if (unknowns_[i].recording < 0 || unknowns_[i].recording == recording)
      out[static_cast<Eigen::Index>(unknowns_[i].variable)] = x[static_cast<Eigen::Index>(i)];
  return out;
}

std::vector<Table> FitProblem::tables(const Eigen::VectorXd& residuals,
                                      const std::vector<double>& sigma) const {
  std::vector<Table> out;
  Eigen::Index next = 0;
  for (const Series& series : series_) {
    Table& table = out.emplace_back();
    table.columns.push_back({"t", "s", "time", series.recording->t});
    for (size_t c = 0; c < series.columns.size(); ++c) {
      const std::string& name = columns_[series.names[c]];
      const std::string& unit = series.observed.unit(c);
      const std::vector<double>& data = series.recording->values[series.columns[c]];
      table.columns.push_back({name, unit, "datum", data});
      table.columns.push_back(
          {name + ".fit", unit, "of the fitted motion",
           std::vector<double>(data.size(), std::numeric_limits<double>::quiet_NaN())});
      table.columns.push_back(
          {name + ".residual", "1", "(fit - datum) / sigma",
           std::vector<double>(data.size(), std::numeric_limits<double>::quiet_NaN())});
    }
    for (size_t k = 0; k < series.recording->t.size(); ++k) {
      for (size_t c = 0; c < series.columns.size(); ++c) {
        const double datum = series.recording->values[series.columns[c]][k];
        if (!std::isfinite(datum)) continue;
        const double off = residuals[next++];
        std::get<std::vector<double>>(table.columns[2 + 3 * c].values)[k] = datum + off;
        std::get<std::vector<double>>(table.columns[3 + 3 * c].values)[k] =
            off / sigma[series.names[c]];
      }
    }
  }
  return out;
}

}  // namespace hamel
