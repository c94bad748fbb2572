// hamel list: tables of what exists by name.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/schemes/composition.hpp>
#include <hamel/systems/simulate.hpp>

#include "commands.hpp"

namespace hamel::tools {
namespace {

using Json = nlohmann::ordered_json;

struct Table {
  std::string kind;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

void print(const Table& table) {
  std::vector<size_t> width;
  for (const std::string& column : table.columns) width.push_back(column.size());
  for (const auto& row : table.rows) {
    for (size_t j = 0; j < row.size(); ++j) width[j] = std::max(width[j], row[j].size());
  }
  fmt::print("{}\n", table.kind);
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text = " ";
    for (size_t j = 0; j < cells.size(); ++j) text += fmt::format(" {:<{}}", cells[j], width[j]);
    text.erase(text.find_last_not_of(' ') + 1);
    fmt::print("{}\n", text);
  };
  line(table.columns);
  for (const auto& row : table.rows) line(row);
  fmt::print("\n");
}

Json to_json(const Table& table) {
  Json out = Json::array();
  for (const auto& row : table.rows) {
    Json entry;
    for (size_t j = 0; j < row.size(); ++j) entry[table.columns[j]] = row[j];
    out.push_back(entry);
  }
  return out;
}

std::vector<Table> tables() {
  const Registry& all = registry();
  Table groups{"groups", {"name", "dim", "columns", "retractions"}, {}};
  for (const std::string& name : all.groups()) {
    const GroupInfo& info = *all.group(name);
    std::vector<std::string> columns = info.columns;
    if (columns.size() > 6) columns = {columns.front(), "...", columns.back()};
    groups.rows.push_back(
        {name, std::to_string(info.dim), join(columns), join(all.retractions(name))});
  }
  Table retractions{"retractions", {"name", "symmetric", "groups"}, {}};
  for (const std::string& name : all.retractions()) {
    std::vector<std::string> where;
    bool symmetric = true;  // on every group that is not abelian
    for (const std::string& group : all.groups()) {
      if (const RetractionInfo* info = all.retraction(group, name)) {
        where.push_back(group);
        symmetric = symmetric && info->symmetric;
      }
    }
    retractions.rows.push_back({name, symmetric ? "yes" : "no", join(where)});
  }
  Table schemes{"schemes", {"name", "order", "formula"}, {}};
  for (const std::string& name : all.schemes()) {
    const SchemeInfo& info = *all.scheme(name);
    const int half = info.claim(0.5, true, true).order, zero = info.claim(0, true, true).order;
    std::string order = half == 0 ? "-" : std::to_string(half);
    if (!info.adapted) order = "leaves d";
    else if (half != zero) order = fmt::format("{} at s = 1/2, else {}", half, zero);
    schemes.rows.push_back({name, order, info.formula});
    for (const auto& [alias, scheme] : all.scheme_aliases()) {
      if (scheme == name) schemes.rows.push_back({alias, order, "another name of " + name});
    }
  }
  Table solvers{"solvers", {"name", "summary"}, {}};
  for (const std::string& name : all.solvers()) {
    solvers.rows.push_back({name, all.solver(name)->summary});
  }
  for (const std::string& name : all.absent_solvers()) {
    const SolverInfo& info = *all.absent_solver(name);
    solvers.rows.push_back(
        {name, fmt::format("not built (needs {}): {}", info.package, info.summary)});
  }
  Table systems{"systems", {"name", "group", "parameters", "summary"}, {}};
  for (const std::string& name : all.systems()) {
    const SystemInfo& info = *all.system(name);
    std::vector<std::string> fields;
    for (const Field& field : info.fields) fields.push_back(field.name);
    systems.rows.push_back({name, info.group.name, join(fields), info.summary});
  }
  return {groups, retractions, schemes, solvers, systems};
}

}  // namespace

int list(const ListOptions& options) {
  std::vector<std::string> kinds;
  Json json = Json::object();
  bool found = options.kind.empty();
  for (const Table& table : tables()) {
    kinds.push_back(table.kind);
    if (!options.kind.empty() && table.kind != options.kind) continue;
    found = true;
    if (!options.json) print(table);
    else if (options.kind.empty()) json[table.kind] = to_json(table);
    else json = to_json(table);
  }
  if (!found) throw ConfigError({unknown_name("kind", options.kind, kinds)});
  if (options.json) fmt::print("{}\n", json.dump(2));
  return 0;
}

}  // namespace hamel::tools
