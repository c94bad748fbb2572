#include <hamel/framework/analysis/section.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/mechanics/components.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/data/event_formula.hpp>
#include <hamel/framework/run/run/events.hpp>
#include <hamel/framework/run/run/plan/plan.hpp>

namespace hamel {
namespace {

constexpr long kMostQuiet = 1'000'000;  // steps without a crossing
constexpr double kUsualTolerance = 1e-10;
constexpr double kForEver = 1e9;  // steps, or seconds

// The function of the event, to tell in which direction it was crossed.
std::optional<Event> event_named(const SystemModel& system, const std::string& name,
                                 std::vector<std::string>& mistakes) {
  for (Event& event : events_of(system))
    if (event.name == name) return std::move(event);
  return event_of_formula(system, name, mistakes);
}

class Points {
 public:
  explicit Points(const SystemModel& system) {
    table.columns = {{"start", "1", "number of the start", std::vector<long long>()},
                     {"n", "1", "number of the crossing", std::vector<long long>()},
                     {"t", "s", "time of the crossing", std::vector<double>()}};
    const std::vector<Component> components = components_of(system);
    std::vector<std::string> units = units_of_element(system.group);
    units.resize(system.group.columns.size());
    for (size_t k = 0; k < units.size(); ++k)
      table.columns.push_back(
          {system.group.columns[k], units[k], "column of the element", std::vector<double>()});
    for (const Component& component : components)
      table.columns.push_back(
          {component.name, component.unit, "nodal body velocity", std::vector<double>()});
    const QuantityNames names(system);
    for (const OtherName& other : system.other_names)
      table.other_names.emplace(other.name, names.all()[other.place]);
    table.columns.push_back({"energy", "J", "at the crossing", std::vector<double>()});
    add_formulas(system);
  }
  void add(long long start, long long n, double t, const std::vector<double>& coordinates,
           const std::vector<double>& velocity, double energy) {
    std::get<std::vector<long long>>(table.columns[0].values).push_back(start);
    std::get<std::vector<long long>>(table.columns[1].values).push_back(n);
    size_t column = 2;
    const auto next = [&](double x) {
      std::get<std::vector<double>>(table.columns[column++].values).push_back(x);
    };
    next(t);
    for (const double x : coordinates) next(x);
    for (const double x : velocity) next(x);
    next(energy);
    for (const auto& value : values_) next(value(t, coordinates, velocity));
  }
  Table table;

 private:
  // Columns of sensors and outputs that are functions of a state.
  void add_formulas(const SystemModel& system) {
    const StateVariables variables(system, QuantityNames(system).variables());
    const auto add_column = [&](const std::string& name, const std::string& unit,
                                const std::string& meaning) {
      const std::vector<std::string>& names = variables.names();
      if (std::ranges::find(names, name) == names.end()) return;
      table.columns.push_back({name, unit, meaning, std::vector<double>()});
      values_.push_back(variables.value(Expression(name, names)));
    };
    for (const Sensor& sensor : system.sensors)
      for (size_t i = 0; i < sensor.columns.size(); ++i)
        add_column(sensor.columns[i], sensor.units[i], sensor.meaning);
    for (const OutputFormula& output : system.outputs)
      add_column(output.name, output.unit,
                 output.meaning.empty() ? output.formula : output.meaning);
  }
  std::vector<StateVariables::Value> values_;
};

class Sections {
 public:
  Sections(const Simulation& simulation, const SectionRequest& request)
      : simulation_(simulation), request_(request) {
    Config config = simulation.config();
    if (config.leaves_method()) config.rtol = kUsualTolerance;
    config.events = {request.event};
    config.stop_at.clear();
    config.output_times.clear();
    config.output_step.reset();
    config.every = std::numeric_limits<long>::max();  // no rows
    const double step = config.step.value_or(1);
    const double longest = request.longest ? *request.longest : kForEver * std::abs(step);
    config.until = config.from + std::copysign(longest, step);
    simulation_.config(std::move(config));
    check();
  }
  const SystemModel& system() { return *system_; }
  const std::vector<Start>& starts() const { return starts_; }

  // False where it was stopped.
  bool follow(const Start& start, long long number, Points& points, SectionOrbit& orbit,
              const std::function<void()>& crossed, const std::atomic<bool>* stop) {
    Run run = simulation_.start(start).build();
    const Snapshot& begin = run.state();
    orbit.start = {.configuration = begin.coordinates, .velocity = begin.velocity, .momentum = {}};
    orbit.energy = begin.energy;
    size_t seen = 0;
    long quiet = 0;
    while (orbit.found < request_.count) {
      if (stop != nullptr && stop->load()) return false;
      remember(run);
      const Status status = run.step();
      if (!status.ok) orbit.reason = status.reason;
      else if (++quiet > kMostQuiet)
        orbit.reason = fmt::format("no crossing in {} steps", kMostQuiet);
      else if (request_.longest && std::abs(run.time() - first_) >= *request_.longest)
        orbit.reason = fmt::format("{} s have passed", *request_.longest);
      for (; seen < run.events().size() && orbit.found < request_.count; ++seen) {
        if (run.events()[seen].name != request_.event) continue;  // of a contact
        quiet = 0;
        if (!in_direction(run.state())) continue;
        add(run.events()[seen], number, points, orbit);
        crossed();
      }
      if (!orbit.reason.empty()) break;
    }
    orbit.time = run.time();
    return true;
  }

 private:
  void check() {
    if (request_.count < 1)
      throw ConfigError({fmt::format("count: got {}, expected 1 or more", request_.count)});
    if (std::abs(request_.direction) > 1)
      throw ConfigError(
          {fmt::format("direction: got {}, expected 1, -1 or 0", request_.direction)});
    if (request_.longest && !(*request_.longest > 0))
      throw ConfigError(
          {fmt::format("until: got {}, expected seconds above 0", *request_.longest)});
    starts_ = request_.starts;
    if (starts_.empty()) starts_.push_back(simulation_.config().start);
    for (size_t i = 0; i < starts_.size(); ++i) {
      try {
        Run run = simulation_.start(starts_[i]).build();
        if (i == 0) keep(run);
        if (request_.energy) scale(starts_[i], run);
      } catch (const ConfigError& error) {
        if (request_.starts.empty()) throw;
        throw ConfigError({fmt::format("start {}: {}", i + 1, error.mistakes().front())});
      }
    }
  }
  // Keeps the system of the run of the first start.
  void keep(const Run& run) {
    system_ = std::make_shared<const SystemModel>(run.system());
    first_ = run.config().from;
    std::vector<std::string> mistakes;
    event_ = event_named(*system_, request_.event, mistakes);
    if (!mistakes.empty()) throw ConfigError(mistakes);
    if (event_ && event_->direction * request_.direction < 0) {
      throw ConfigError({fmt::format("direction: {} has the direction {}, not {}", request_.event,
                                     event_->direction, request_.direction)});
    }
  }
  // Kinetic energy is quadratic in the velocity: E = V + lambda^2 T.
  void scale(Start& start, Run& run) {
    start.configuration = run.state().coordinates;
    start.velocity = run.state().velocity;
    start.momentum.clear();
    const double now = run.state().energy;
    Start resting = start;
    std::fill(resting.velocity.begin(), resting.velocity.end(), 0.0);
    run.restart(resting);
    const double potential = run.state().energy, kinetic = now - potential;
    const double square = (*request_.energy - potential) / kinetic;
    if (!(square > 0) || !std::isfinite(square)) {
      throw ConfigError({fmt::format(
          "energy: got {} J, but this start has the potential energy {} J and the kinetic energy "
          "{} J",
          *request_.energy, potential, kinetic)});
    }
    for (double& x : start.velocity) x *= std::sqrt(square);
    run.restart(start);
    const double reached = run.state().energy, size = std::abs(*request_.energy) + kinetic;
    if (!(std::abs(reached - *request_.energy) <= 1e-9 * size)) {
      throw ConfigError(
          {fmt::format("energy: got {} J, but the constraints move this start to {} J",
                       *request_.energy, reached)});
    }
  }
  bool selects() const { return request_.direction != 0 && event_ && event_->direction == 0; }
  // Where the step begins.
  void remember(Run& run) {
    if (!selects()) return;
    const Snapshot& now = run.state();
    before_ = event_->value(now.time, now.coordinates, now.velocity);
  }
  // An event crosses once in a step at most: where this begins its function has the other sign, or
  // is 0 where the run begins on the section. Behind the step an impact may have turned it round.
  bool in_direction(const Snapshot& after) {
    if (!selects()) return true;
    if (before_ != 0) return request_.direction * before_ < 0;
    return request_.direction * event_->value(after.time, after.coordinates, after.velocity) > 0;
  }
  void add(const EventMet& met, long long number, Points& points, SectionOrbit& orbit) {
    if (energy_ == nullptr) energy_ = std::make_unique<Run>(simulation_.build());
    energy_->restart({.configuration = met.coordinates, .velocity = met.velocity, .momentum = {}});
    const double energy = energy_->state().energy;
    points.add(number, ++orbit.found, met.time, met.coordinates, met.velocity, energy);
    orbit.energy_change = std::max(orbit.energy_change, std::abs(energy - orbit.energy));
  }

  Simulation simulation_;
  const SectionRequest& request_;
  std::vector<Start> starts_;
  std::shared_ptr<const SystemModel> system_;
  std::optional<Event> event_;
  std::unique_ptr<Run> energy_;  // of a state
  double first_ = 0, before_ = 0;
};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) {
    while (!cell.empty() && (cell.back() == '\r' || cell.back() == ' ')) cell.pop_back();
    cell.erase(0, cell.find_first_not_of(' '));
    out.push_back(cell);
  }
  return out;
}

// A table of starts: its head names the columns.
class StartsReader {
 public:
  StartsReader(const std::string& path, const SystemModel& system)
      : path_(path), known_(system), width_(system.group.columns.size()) {}
  std::vector<Start> read(const std::string& text) {
    std::istringstream in(text);
    std::vector<Start> out;
    for (std::string line; std::getline(in, line);) {
      ++number_;
      if (line.empty() || line.front() == '#') continue;
      const std::vector<std::string> cells = cells_of(line);
      if (to_.empty()) head(cells);
      else out.push_back(start(cells));
    }
    if (out.empty()) throw ConfigError({fmt::format("{}: no start", path_)});
    return out;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw ConfigError({fmt::format("{}:{}: {}", path_, number_, what)});
  }
  void head(const std::vector<std::string>& names) {
    names_ = names;
    std::vector<bool> there(known_.all().size());
    for (const std::string& name : names) {
      to_.push_back(known_.find(name).value_or(there.size()));
      if (to_.back() == there.size()) continue;  // left out
      there[to_.back()] = true;
      placed_ = placed_ || to_.back() < width_;
    }
    for (size_t i = placed_ ? 0 : width_; i < there.size(); ++i)
      if (!there[i]) refuse(fmt::format("there is no column '{}'", known_.all()[i]));
  }
  double value(size_t i, const std::string& cell) const {
    double out = 0;
    const char* const last = cell.data() + cell.size();
    const auto [end, error] = std::from_chars(cell.data(), last, out);
    if (error != std::errc() || end != last || !std::isfinite(out))
      refuse(fmt::format("{}: got '{}', expected a finite number", names_[i], cell));
    return out;
  }
  Start start(const std::vector<std::string>& cells) const {
    if (cells.size() != to_.size())
      refuse(fmt::format("got {} cells, expected {}", cells.size(), to_.size()));
    std::vector<double> values(known_.all().size());
    for (size_t i = 0; i < cells.size(); ++i)
      if (to_[i] < values.size()) values[to_[i]] = value(i, cells[i]);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(width_);
    Start out;
    if (placed_) out.configuration.assign(values.begin(), middle);
    out.velocity.assign(middle, values.end());
    return out;
  }

  std::string path_;
  QuantityNames known_;
  size_t width_;  // columns of the element
  long number_ = 0;
  std::vector<std::string> names_;
  std::vector<size_t> to_;  // the column of each cell
  bool placed_ = false;     // are configurations given?
};

}  // namespace

Section section(const Simulation& simulation, const SectionRequest& request,
                const std::function<void(double)>& progress, const std::atomic<bool>* stop) {
  Sections sections(simulation, request);
  Points points(sections.system());
  Section out;
  const double all =
      static_cast<double>(request.count) * static_cast<double>(sections.starts().size());
  double done = 0;
  bool stopped = false;
  for (size_t i = 0; i < sections.starts().size() && !stopped; ++i) {
    SectionOrbit& orbit = out.orbits.emplace_back();
    const auto crossed = [&] {
      ++done;
      if (progress) progress(done / all);
    };
    stopped = !sections.follow(sections.starts()[i], static_cast<long long>(i + 1), points, orbit,
                               crossed, stop);
    if (stopped) orbit.reason = "interrupted";
    done = static_cast<double>(request.count) * static_cast<double>(i + 1);
  }
  out.points = std::move(points.table);
  out.complete = !stopped && std::all_of(out.orbits.begin(), out.orbits.end(),
                                         [](const SectionOrbit& o) { return o.reason.empty(); });
  return out;
}

std::vector<Start> read_starts(const std::string& path, const Registry& registry,
                               const Config& config) {
  Mistakes mistakes;
  const std::optional<PlannedSystem> planned = plan_system(registry, config, nullptr, mistakes);
  mistakes.refuse();
  if (!planned) throw ConfigError({"system: " + config.system});
  return StartsReader(path, *planned->model).read(read_text_file("starts", path));
}

}  // namespace hamel
