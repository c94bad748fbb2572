#include <hamel/framework/study/journal.hpp>

#include <sys/file.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/version.hpp>
#include <hamel/framework/run/result.hpp>
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
  return Json{
      {"journal", 1},
      {"version", fmt::format("{} ({}; {}; {})", version(), git_hash(), compiler(), build_flags())},
      {"study", lines_of(config.fingerprint())}}
      .dump();
}

// The lines of one that the other has not, the first few.
std::string difference(const Json& there, const Json& here) {
  std::string out;
  int count = 0;
  const auto list = [&](const char* sign, const Json& some, const Json& others) {
    for (const auto& line : some)
      if (std::find(others.begin(), others.end(), line) == others.end() && ++count <= 6)
        out += fmt::format("\n  {} {}", sign, line.get<std::string>());
  };
  list("there:", there, here);
  list("here: ", here, there);
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

Json json_of(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
Json json_of(long x) { return x; }
void take(const Json& from, double& x) { x = from.is_null() ? kNotMeasured : from.get<double>(); }
void take(const Json& from, long& x) { x = from.get<long>(); }

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

}  // namespace

Journal::Journal(const std::string& folder, const StudyConfig& config, bool fresh) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  path_ = (std::filesystem::path(folder) / "journal.jsonl").string();
  file_ = std::fopen(path_.c_str(), "a");
  if (file_ == nullptr) throw ConfigError({fmt::format("output: cannot write '{}'", path_)});
  const auto refuse = [&](const std::string& why) {
    std::fclose(file_);
    throw ConfigError({why});
  };
  if (flock(fileno(file_), LOCK_EX | LOCK_NB) != 0)
    refuse(fmt::format("output: another study is running in '{}'", folder));
  std::ifstream in(path_, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  old_ = text.str();
  const std::string first = old_.substr(0, old_.find('\n')), mine = header(config);
  const Json there = Json::parse(first, nullptr, false), here = Json::parse(mine);
  const bool ours = there.is_object() && there.contains("study") && there.contains("version");
  if (!ours && !first.empty() && !first.starts_with("{\"journal\""))
    refuse(fmt::format("output: '{}' is no journal of a study; use another folder", path_));
  if (!fresh && ours && first != mine) {
    std::string why = difference(there["study"], here["study"]);
    if (there["version"] != here["version"])
      why += fmt::format("\n  there: hamel {}\n  here:  hamel {}",
                         there["version"].get<std::string>(), here["version"].get<std::string>());
    refuse(
        fmt::format("output: '{}' holds the cells of another study or program; --fresh forgets "
                    "them, or use another folder{}",
                    folder, why));
  }
  // A torn last line is a cell that was in flight (npos + 1 = 0).
  old_.resize(fresh || !ours ? 0 : old_.rfind('\n') + 1);
  if (ftruncate(fileno(file_), static_cast<off_t>(old_.size())) != 0)
    refuse(fmt::format("output: cannot write '{}'", path_));
  if (old_.empty()) append(mine);
}

Journal::~Journal() { std::fclose(file_); }

void Journal::append(const std::string& line) {
  const std::lock_guard lock(mutex_);
  if (std::fputs((line + "\n").c_str(), file_) < 0 || std::fflush(file_) != 0)
    throw std::runtime_error(fmt::format("cannot write '{}'", path_));
}

void Journal::measured(size_t cell, const StudyMetrics& metrics) {
  Json line = {{"cell", cell}, {"ok", metrics.ok}, {"reason", metrics.reason}};
  numbers(metrics, [&](const char* name, const auto& x) { line[name] = json_of(x); });
  line["final"] = json_of(metrics.final);
  append(line.dump());
}

void Journal::referred(size_t system, const StudyReference& reference) {
  Json line = {{"reference", system}, {"kind", reference.kind}};
  members(reference, [&](const char* name, const auto& x) { line[name] = json_of(x); });
  append(line.dump());
}

void Journal::timed(size_t cell, size_t round, double nanoseconds) {
  append(Json{{"cell", cell}, {"round", round}, {"ns", json_of(nanoseconds)}}.dump());
}

void Journal::read(StudyResult& result) const {
  std::istringstream in(old_);
  std::string text;
  std::getline(in, text);
  for (size_t number = 2; std::getline(in, text); ++number) {
    try {
      const Json line = Json::parse(text);
      if (line.contains("reference")) {
        StudyReference& r = result.references.at(line["reference"].get<size_t>());
        r.kind = line.at("kind").get<std::string>();
        members(r, [&](const char* name, auto& x) { take(line.at(name), x); });
        continue;
      }
      StudyMetrics& m = result.metrics.at(line.at("cell").get<size_t>());
      if (line.contains("round")) {
        m.nanoseconds.resize(static_cast<size_t>(result.config.repeats), kPending);
        take(line.at("ns"), m.nanoseconds.at(line.at("round").get<size_t>()));
        continue;
      }
      m.done = true;
      m.ok = line.at("ok").get<bool>();
      m.reason = line.at("reason").get<std::string>();
      numbers(m, [&](const char* name, auto& x) { take(line.at(name), x); });
      take(line.at("final"), m.final);
    } catch (const std::exception& error) {
      throw ConfigError(
          {fmt::format("output: {}:{}: {}; --fresh begins anew", path_, number, error.what())});
    }
  }
}

}  // namespace hamel::study
