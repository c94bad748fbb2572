#include <hamel/framework/study/journal.hpp>

#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/version.hpp>
#include <hamel/framework/run/record/result.hpp>
#include <hamel/framework/study/parts.hpp>

namespace hamel::study {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

std::string header(const StudyConfig& config) {
  return Json{{"journal", 1}, {"version", build_name()}, {"study", lines_of(config.fingerprint())}}
      .dump();
}

// The lines of one first line that the other has not, the first few.
std::string difference(const std::string& first, const std::string& mine) {
  const Json there = Json::parse(first, nullptr, false), here = Json::parse(mine);
  std::string out;
  int count = 0;
  const auto list = [&](const char* sign, const Json& some, const Json& others) {
    for (const auto& line : some)
      if (std::find(others.begin(), others.end(), line) == others.end() && ++count <= 6)
        out += fmt::format("\n  {} {}", sign, line.get<std::string>());
  };
  try {
    list("there:", there.at("study"), here["study"]);
    list("here: ", here["study"], there.at("study"));
    if (there.at("version") != here["version"])
      out += fmt::format("\n  there: hamel {}\n  here:  hamel {}",
                         there["version"].get<std::string>(), here["version"].get<std::string>());
  } catch (const Json::exception&) {
    out = "\n  (its first line is damaged)";
  }
  return out;
}

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

// What a reference consists of, for writing and reading alike.
template <class Reference, class Visit>
void members(Reference& r, Visit visit) {
  visit("bound", r.bound);
  visit("extent", r.extent);
  visit("times", r.times);
  visit("coordinates", r.coordinates);
  visit("velocities", r.velocities);
}

constexpr const char* kSum = ",\"sum\":\"";

// FNV-1a, 64 bits.
uint64_t checksum(const std::string& text) {
  uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
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

void take_line(const std::string& text, const std::vector<Shape>& shapes, StudyResult& result) {
  const size_t end = text.rfind(kSum);
  expect(end != std::string::npos && sealed(text.substr(0, end) + "}") == text, "its checksum");
  const Json line = Json::parse(text);
  if (line.contains("reference")) return take_reference(line, shapes, result);
  const auto cell = index_of(line.at("cell"));
  StudyMetrics& mine = result.metrics.at(cell);
  expect(result.cells[cell].runs(), "no cell that is run");
  if (line.contains("round")) {
    const auto round = index_of(line["round"]);
    expect(round < static_cast<size_t>(result.config.repeats), "no such round");
    mine.nanoseconds.resize(static_cast<size_t>(result.config.repeats), kPending);
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

}  // namespace

std::vector<Shape> shapes(const Registry& registry, const StudyConfig& config) {
  std::vector<Shape> out;
  for (const StudySystem& system : config.systems) {
    const auto group = registry.group_or_product(model(registry, system).group.name);
    out.push_back({static_cast<size_t>(common_intervals(config)) + 1, group->columns.size(),
                   static_cast<size_t>(group->dim)});
  }
  return out;
}

std::string sealed(const std::string& object) {
  const std::string body = object.substr(0, object.rfind('}'));
  return fmt::format("{}{}{:016x}\"}}", body, kSum, checksum(body));
}

std::vector<std::string> read_lines(const std::string& lines, const std::vector<Shape>& shapes,
                                    StudyResult& result) {
  std::vector<std::string> notes;
  std::istringstream in(lines);
  size_t number = 1;  // of the first line, which says whose the journal is
  for (std::string line; std::getline(in, line);) {
    ++number;
    try {
      take_line(line, shapes, result);
    } catch (const std::exception& error) {
      notes.push_back(fmt::format("journal.jsonl:{}: damaged ({}); what it held is computed again",
                                  number, error.what()));
    }
  }
  return notes;
}

Journal::Journal(const std::string& folder, const StudyConfig& config, bool fresh) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  path_ = (std::filesystem::path(folder) / "journal.jsonl").string();
  file_.reset(std::fopen(path_.c_str(), "a"));
  const auto refuse = [](const std::string& why) { throw ConfigError({"output: " + why}); };
  if (file_ == nullptr) refuse(fmt::format("cannot write '{}'", path_));
  if (flock(fileno(file_.get()), LOCK_EX | LOCK_NB) != 0)
    refuse(fmt::format("another study is running in '{}'", folder));
  std::ifstream in(path_, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  old_ = text.str();
  const size_t end = old_.find('\n');
  const std::string first = old_.substr(0, end), mine = header(config);
  if (!first.empty() && !first.starts_with("{\"journal\""))
    refuse(fmt::format("'{}' is no journal of a study; use another folder", path_));
  if (!fresh && end != std::string::npos && first != mine)
    refuse(
        fmt::format("'{}' holds the cells of another study or program; --fresh forgets them, or "
                    "use another folder{}",
                    folder, difference(first, mine)));
  // A torn first line is a study that had not begun, a torn last one a cell that was in flight.
  const bool goes_on = !fresh && end != std::string::npos;
  const size_t kept = goes_on ? old_.rfind('\n') + 1 : 0;
  if (ftruncate(fileno(file_.get()), static_cast<off_t>(kept)) != 0)
    refuse(fmt::format("cannot write '{}'", path_));
  old_ = goes_on ? old_.substr(end + 1, kept - end - 1) : "";
  if (!goes_on) append(mine);
}

void Journal::append(const std::string& line) {
  const std::lock_guard lock(mutex_);
  if (std::fputs((line + "\n").c_str(), file_.get()) < 0 || std::fflush(file_.get()) != 0)
    throw Unfinished(fmt::format("output: cannot write '{}': {}", path_, std::strerror(errno)));
}

void Journal::measured(size_t cell, const StudyMetrics& metrics) {
  Json line = {{"cell", cell}, {"ok", metrics.ok}, {"reason", metrics.reason}};
  numbers(metrics, [&](const char* name, const auto& x) { line[name] = json_of(x); });
  line["final"] = json_of(metrics.final);
  append(sealed(line.dump()));
}

void Journal::referred(size_t system, const StudyReference& reference) {
  Json line = {{"reference", system}, {"kind", reference.kind}};
  members(reference, [&](const char* name, const auto& x) { line[name] = json_of(x); });
  append(sealed(line.dump()));
}

void Journal::timed(size_t cell, size_t round, double nanoseconds) {
  append(sealed(Json{{"cell", cell}, {"round", round}, {"ns", json_of(nanoseconds)}}.dump()));
}

}  // namespace hamel::study
