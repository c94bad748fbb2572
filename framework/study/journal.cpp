#include <hamel/framework/study/journal.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include <hamel/framework/study/parts.hpp>

namespace hamel::study {
namespace {

using Json = nlohmann::ordered_json;

// The numbers that a run leaves, by name, for writing and reading alike.
template <class Metrics, class Visit>
void numbers(Metrics& m, Visit visit) {
  visit("iterations", m.iterations);
  measured_columns([&](const Quantity& quantity, auto of) {
    if constexpr (std::is_member_object_pointer_v<decltype(of)>) visit(quantity.name, m.*of);
  });
}

void expect(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

Json json_of(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
Json json_of(long x) { return x; }
void take(const Json& from, double& x) { x = from.is_null() ? kNotMeasured : from.get<double>(); }
void take(const Json& from, long& x) {
  expect(from.is_number_integer(), "no whole number");
  x = from.get<long>();
}
size_t index_of(const Json& from) {
  expect(from.is_number_unsigned(), "no index");
  return from.get<size_t>();
}

template <class List>
Json json_of(const List& list) {
  Json out = Json::array();
  for (const auto& entry : list) out.push_back(json_of(entry));
  return out;
}
template <class Entry>
void take(const Json& from, std::vector<Entry>& list) {
  for (const Json& entry : from) take(entry, list.emplace_back());
}

// Members of a reference, for writing and reading alike.
template <class Reference, class Visit>
void members(Reference& r, Visit visit) {
  visit("bound", r.bound);
  visit("extent", r.extent);
  visit("times", r.times);
  visit("coordinates", r.coordinates);
  visit("velocities", r.velocities);
}

void take_reference(const Json& line, const std::vector<Shape>& shapes, StudyResult& result) {
  const auto system = index_of(line["reference"]);
  const Shape& shape = shapes.at(system);
  StudyReference r;
  r.kind = line.at("kind").get<std::string>();
  members(r, [&](const char* name, auto& x) { take(line.at(name), x); });
  const auto fits = [&](const std::vector<std::vector<double>>& rows, size_t width) {
    return (rows.empty() || rows.size() == shape.times) &&
           std::all_of(rows.begin(), rows.end(), [&](auto& row) { return row.size() == width; });
  };
  expect(r.times.size() == shape.times && fits(r.coordinates, shape.columns) &&
             fits(r.velocities, shape.dim) && r.coordinates.size() == r.velocities.size(),
         "of another length");
  result.references[system] = std::move(r);
}

}  // namespace

void take_line(const std::string& text, const std::vector<Shape>& shapes, StudyResult& result) {
  const Json line = Json::parse(text);
  if (line.contains("reference")) return take_reference(line, shapes, result);
  const auto cell = index_of(line.at("cell"));
  StudyMetrics& mine = result.metrics.at(cell);
  expect(result.cells[cell].runs(), "no cell that is run");
  if (line.contains("round")) {
    const auto round = index_of(line["round"]);
    expect(round < mine.nanoseconds.size(), "no such round");
    take(line.at("ns"), mine.nanoseconds[round]);
    return;
  }
  StudyMetrics m;
  m.done = true;
  m.ok = line.at("ok").get<bool>();
  m.reason = line.at("reason").get<std::string>();
  numbers(m, [&](const char* name, auto& x) { take(line.at(name), x); });
  take(line.at("final"), m.final);
  expect(m.final.size() == shapes.at(result.cells[cell].system).columns, "of another length");
  m.nanoseconds = std::move(mine.nanoseconds);
  mine = std::move(m);
}

std::vector<Shape> shapes(const Registry& registry, const StudyConfig& config) {
  std::vector<Shape> out;
  for (const StudySystem& system : config.systems) {
    const auto group = registry.group_or_product(model(registry, system).group.name);
    out.push_back({static_cast<size_t>(common_intervals(config)) + 1, group->columns.size(),
                   static_cast<size_t>(group->dim)});
  }
  return out;
}

bool finished_cell(const StudyResult& result, size_t cell) {
  const StudyMetrics& m = result.metrics[cell];
  const auto rounds = static_cast<size_t>(result.config.repeats);
  return m.done && !result.references[result.cells[cell].system].times.empty() &&
         m.nanoseconds.size() == rounds &&
         std::count(m.nanoseconds.begin(), m.nanoseconds.end(), kPending) == 0;
}

std::string line_of(size_t system, const StudyReference& reference) {
  Json line = {{"reference", system}, {"kind", reference.kind}};
  members(reference, [&](const char* name, const auto& x) { line[name] = json_of(x); });
  return line.dump();
}

std::string line_of(size_t cell, const StudyMetrics& metrics) {
  Json line = {{"cell", cell}, {"ok", metrics.ok}, {"reason", metrics.reason}};
  numbers(metrics, [&](const char* name, const auto& x) { line[name] = json_of(x); });
  line["final"] = json_of(metrics.final);
  return line.dump();
}

std::string line_of(size_t cell, size_t round, double nanoseconds) {
  return Json{{"cell", cell}, {"round", round}, {"ns", json_of(nanoseconds)}}.dump();
}

}  // namespace hamel::study
