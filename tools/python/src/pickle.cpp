// The pickle of a result: plain values, the rows as bytes; the system goes by its name or text.
#include <cstring>
#include <stdexcept>

#include "bindings.hpp"

namespace hamel::python {
namespace {

using OtherNames = std::vector<std::pair<std::string, size_t>>;
using GroupState =
    std::tuple<std::string, std::string, std::string, std::string, std::vector<std::string>>;

struct Packer {  // of Measurements::serialize and invariants
  std::vector<double> numbers;
  std::vector<std::string> names;
  void operator()(double& x) { numbers.push_back(x); }
  void operator()(std::vector<InvariantDrift>& all) {
    for (InvariantDrift& one : all) {
      names.push_back(one.name);
      numbers.push_back(one.start);
      numbers.push_back(one.drift_max);
    }
  }
};

struct Unpacker {
  std::vector<double> numbers;
  std::vector<std::string> names;
  size_t at = 0;
  void operator()(double& x) { x = numbers.at(at++); }
  void operator()(std::vector<InvariantDrift>& all) {
    for (const std::string& name : names) {
      const double start = numbers.at(at++), drift = numbers.at(at++);
      all.push_back({name, start, drift});
    }
  }
};

nb::tuple pack(const Snapshot& s) {
  return nb::make_tuple(s.step, s.time, s.coordinates, s.velocity, s.momentum, s.energy,
                        s.constraint_rates, s.constraint, s.holonomic, s.group_defect, s.rotation,
                        s.time_offset, s.iterations, s.residual);
}

// The numbers of pack(Snapshot).
constexpr size_t kSnapshot = 14;

Snapshot snapshot_of(const nb::tuple& t) {
  if (t.size() != kSnapshot) throw std::invalid_argument("last: of another length");
  Snapshot s;
  const auto read = [&t, i = 0](auto& out) mutable {
    out = nb::cast<std::remove_reference_t<decltype(out)>>(t[static_cast<size_t>(i++)]);
  };
  auto next = read;
  next(s.step);
  next(s.time);
  next(s.coordinates);
  next(s.velocity);
  next(s.momentum);
  next(s.energy);
  next(s.constraint_rates);
  next(s.constraint);
  next(s.holonomic);
  next(s.group_defect);
  next(s.rotation);
  next(s.time_offset);
  next(s.iterations);
  next(s.residual);
  return s;
}

template <class Value>
Value get(const nb::dict& state, const char* key) {
  return nb::cast<Value>(state[key]);
}

}  // namespace

nb::dict pack(const StoredResult& stored) {
  const Result& result = stored.read();
  nb::dict out;
  out["record"] = stored.record_text();
  out["report"] = stored.report_text(Notes::brief);
  out["verbose_report"] = stored.report_text(Notes::whole);
  out["source"] = stored.source;
  out["config"] = result.config;
  const Status& status = result.status;
  out["status"] =
      nb::make_tuple(status.ok, status.step, status.time, status.residual, status.reason);
  out["last"] = pack(result.last);
  out["steps"] = result.steps;
  out["seconds"] =
      nb::make_tuple(result.seconds, result.recording_seconds, result.comparing_seconds);
  out["notes"] = result.notes;
  out["unused"] = result.unused;
  out["stopped_by_event"] = result.stopped_by_event;
  const SolverStats& stats = result.stats;
  out["stats"] = nb::make_tuple(stats.iterations, stats.evaluations, stats.iterations_max,
                                stats.residual_max, stats.rejected, stats.fallbacks);
  nb::list events;
  for (const EventMet& e : result.events)
    events.append(nb::make_tuple(e.name, e.time, e.coordinates, e.velocity, e.velocity_after));
  out["events"] = events;
  Packer packer;
  Measurements measured = result;
  measured.serialize(packer);
  out["measurements"] = nb::make_tuple(packer.numbers, packer.names);
  std::vector<GroupState> groups;
  for (const ColumnGroup& g : result.trajectory.groups())
    groups.emplace_back(g.name, g.unit, g.meaning, g.frame, g.columns);
  out["columns"] = groups;
  std::vector<OtherNames> other_names;
  for (const ColumnGroup& g : result.trajectory.groups()) other_names.push_back(g.other_names);
  out["other_names"] = other_names;
  out["stride"] = result.trajectory.stride();
  const auto values = result.trajectory.values();
  out["rows"] = nb::bytes(values.data(), values.size_bytes());
  return out;
}

namespace {

// Reads a pickle, as far as types go; throws whatever does not fit.
StoredResult read(const nb::dict& state) {
  Result result;
  result.config = get<Config>(state, "config");
  using StatusState = std::tuple<bool, long, double, double, std::string>;
  const auto [ok, step, time, residual, reason] = get<StatusState>(state, "status");
  result.status = {ok, step, time, residual, reason};
  result.last = snapshot_of(get<nb::tuple>(state, "last"));
  result.steps = get<long>(state, "steps");
  using Seconds = std::tuple<double, double, double>;
  std::tie(result.seconds, result.recording_seconds, result.comparing_seconds) =
      get<Seconds>(state, "seconds");
  result.notes = get<std::vector<std::string>>(state, "notes");
  result.unused = get<std::vector<std::string>>(state, "unused");
  result.stopped_by_event = get<bool>(state, "stopped_by_event");
  using StatsState = std::tuple<long, long, int, double, long, long>;
  const auto stats = get<StatsState>(state, "stats");
  result.stats = {std::get<0>(stats),
                  std::get<1>(stats),
                  std::get<2>(stats),
                  std::get<3>(stats),
                  std::get<4>(stats),
                  std::get<5>(stats),
                  {}};
  using EventState = std::tuple<std::string, double, std::vector<double>, std::vector<double>,
                                std::vector<double>>;
  for (const auto& [name, at, coordinates, velocity, after] :
       get<std::vector<EventState>>(state, "events"))
    result.events.push_back({name, at, coordinates, velocity, after});
  const auto [values, names] =
      get<std::pair<std::vector<double>, std::vector<std::string>>>(state, "measurements");
  Unpacker unpacker{values, names};
  static_cast<Measurements&>(result).serialize(unpacker);
  std::vector<ColumnGroup> groups;
  for (const auto& [name, unit, meaning, frame, columns] :
       get<std::vector<GroupState>>(state, "columns"))
    groups.push_back({name, unit, meaning, frame, columns});
  if (state.contains("other_names")) {
    const auto other_names = get<std::vector<OtherNames>>(state, "other_names");
    for (size_t i = 0; i < std::min(groups.size(), other_names.size()); ++i)
      for (const auto& [name, place] : other_names[i])
        if (place < groups[i].columns.size()) groups[i].other_names.emplace_back(name, place);
  }
  result.trajectory = Trajectory(std::move(groups));
  const nb::bytes rows = get<nb::bytes>(state, "rows");
  const size_t row = result.trajectory.columns().size() * sizeof(double);
  if (row == 0 ? rows.size() > 0 : rows.size() % row != 0)
    throw std::invalid_argument("rows: not whole ones of these columns");
  std::vector<double> numbers(rows.size() / sizeof(double));
  if (!numbers.empty()) std::memcpy(numbers.data(), rows.data(), rows.size());
  result.trajectory.append(numbers);
  result.trajectory.stride(get<size_t>(state, "stride"));
  StoredResult out(std::move(result), get<std::string>(state, "source"));
  out.record = get<std::string>(state, "record");
  out.report = get<std::string>(state, "report");
  out.verbose_report = get<std::string>(state, "verbose_report");
  return out;
}

}  // namespace

void unpack(StoredResult& self, const nb::dict& state) {
  const auto damaged = [](const std::string& why) {
    return ConfigError({"a damaged pickle of a Result: " + why});
  };
  try {
    new (&self) StoredResult(read(state));
  } catch (const nb::python_error& error) {
    throw damaged(error.what());
  } catch (const nb::cast_error&) {
    throw damaged("a value of another type");
  } catch (const std::exception& error) {
    throw damaged(error.what());
  }
}

}  // namespace hamel::python
