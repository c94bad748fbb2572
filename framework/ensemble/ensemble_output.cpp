// Output of an ensemble: the table of its members and the record.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/io/csv_file.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>

namespace hamel {
namespace {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
Json numbers(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double x : values) out.push_back(number(x));
  return out;
}

Json json_of(const Moments& m) {
  const bool none = m.count == 0;
  return {{"members", m.count},
          {"mean", none ? Json() : number(m.mean)},
          {"deviation", number(m.deviation())},
          {"least", none ? Json() : number(m.least)},
          {"most", none ? Json() : number(m.most)}};
}

// The first of them; `failed` counts all.
Json failures_of(const EnsembleResult& result) {
  constexpr size_t most = 100;
  Json out = Json::array();
  for (size_t i = 0; i < std::min(result.failures.size(), most); ++i) {
    const MemberFailure& failure = result.failures[i];
    Json values = Json::object();
    for (const TableColumn& column : result.table.columns)
      if (column.meaning.starts_with("varied"))
        values[column.name] =
            number(std::get<0>(column.values)[static_cast<size_t>(failure.member - result.first)]);
    out.push_back({{"member", failure.member},
                   {"time", number(failure.time)},
                   {"reason", failure.reason},
                   {"values", values}});
  }
  return out;
}

Json kept_of(const EnsembleResult& result) {
  Json out = Json::object();
  for (const std::string& name : result.kept) {
    out[name] = json_of(result.moments.at(name));
    if (const auto it = result.quantiles.find(name); it != result.quantiles.end())
      for (size_t i = 0; i < it->second.size(); ++i)
        out[name]["quantiles"][text_of(result.config.quantiles[i])] = number(it->second[i]);
  }
  return out;
}

// Members of the record that do not depend on threads and shards.
Json core(const EnsembleResult& result) {
  Json out = {{"members", result.members},
              {"failed", result.failures.size()},
              {"failures", failures_of(result)},
              {"kept", kept_of(result)}};
  for (size_t i = 0; i < result.class_counts.size(); ++i)
    out["classes"][result.config.classes.names[i]] = result.class_counts[i];
  for (const auto& [name, h] : result.histograms)
    out["histograms"][name] = {{"from", number(h.from)},
                               {"until", number(h.until)},
                               {"counts", h.counts},
                               {"below", h.below},
                               {"above", h.above}};
  if (!result.covariance.matrix.empty()) {
    Json rows = Json::array();
    for (const auto& row : result.covariance.matrix) rows.push_back(numbers(row));
    out["covariance"] = {
        {"names", result.kept}, {"matrix", rows}, {"members", result.covariance.members}};
  }
  for (const StatisticsAt& at : result.statistics) {
    Json one = {{"t", at.time}};
    for (const auto& [name, moments] : at.quantities) one[name] = json_of(moments);
    out["statistics"].push_back(one);
  }
  out["seed"] = result.config.seed;
  out["version"] = build_name();
  out["file"] = result.config.origin;
  return out;
}

}  // namespace

std::string EnsembleResult::record() const {
  Json out = core(*this);
  out["seconds"] = seconds;
  out["ranks"] = shards;
  out["threads"] = threads;
  return out.dump(2, ' ', false, Json::error_handler_t::replace);
}

void EnsembleResult::write(const std::string& folder) const {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::create_directories(folder, error);
  const auto path = [&](const char* name) { return (fs::path(folder) / name).string(); };
  if (!hdf5_version().empty()) {
    std::map<std::string, std::string> texts = {
        {"record", core(*this).dump(2, ' ', false, Json::error_handler_t::replace)},
        {"config", config.run.to_toml()},
        {"ensemble", config.text.empty()
                         ? fmt::format("{}\n", fmt::join(config.fingerprint(), "\n"))
                         : config.text},
        {"seed", std::to_string(config.seed)},
        {"version", build_name()}};
    if (!config.data.empty()) texts["data"] = config.data;
    table.write_hdf5(path("ensemble.h5"), texts);
  }
  write_csv(table, path("ensemble.csv"), "member");
  write_file(path("ensemble.json"), record() + "\n");
}

}  // namespace hamel
