// hamel list: tables of what exists by name, as text, JSON or Markdown. The tables of the README
// are the last (tools/docs/tables).
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/schemes/composition.hpp>
#include <hamel/systems/by_name.hpp>

#include "commands.hpp"
#include "lines/help.hpp"
#include "words/screen.hpp"

namespace hamel::tools {
namespace {

using Json = nlohmann::ordered_json;

struct Table {
  std::string kind;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

constexpr size_t kWidth = 80;

// In kWidth characters: cells of the widest columns are broken.
void print(const Table& table) {
  std::vector<size_t> width, least;  // least: that of the longest word
  const auto widen = [&](size_t j, const std::string& cell) {
    width[j] = std::max(width[j], cell.size());
    for (const std::string& word : wrapped(cell, 1)) least[j] = std::max(least[j], word.size());
  };
  for (size_t j = 0; j < table.columns.size(); ++j) {
    width.push_back(0);
    least.push_back(0);
    widen(j, table.columns[j]);
    for (const auto& row : table.rows) widen(j, row[j]);
  }
  const auto all = [&] {
    size_t sum = 1;
    for (const size_t w : width) sum += 1 + w;
    return sum;
  };
  while (all() > kWidth) {
    size_t widest = 0;
    for (size_t j = 0; j < width.size(); ++j)
      if (width[j] - least[j] > width[widest] - least[widest]) widest = j;
    if (width[widest] == least[widest]) break;
    --width[widest];
  }
  say("{}\n", table.kind);
  const auto line = [&](const std::vector<std::string>& cells) {
    std::vector<std::vector<std::string>> lines;
    size_t height = 0;
    for (size_t j = 0; j < cells.size(); ++j) {
      lines.push_back(wrapped(cells[j], width[j]));
      height = std::max(height, lines[j].size());
    }
    for (size_t i = 0; i < height; ++i) {
      std::string text = " ";
      for (size_t j = 0; j < cells.size(); ++j)
        text += fmt::format(" {:<{}}", i < lines[j].size() ? lines[j][i] : "", width[j]);
      text.erase(text.find_last_not_of(' ') + 1);
      say("{}\n", text);
    }
  };
  line(table.columns);
  for (const auto& row : table.rows) line(row);
  say("\n");
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

// Rows of the systems are there where that kind is requested, or every one: mechanisms are read
// for them.
bool with_systems(const std::string& kind) { return kind.empty() || kind == "systems"; }

Table table_of_groups(const Registry& all) {
  Table out{"groups", {"name", "dim", "columns", "retractions"}, {}};
  for (const std::string& name : all.groups()) {
    const GroupInfo& info = *all.group(name);
    std::vector<std::string> columns = info.columns;
    if (columns.size() > 6) columns = {columns.front(), "...", columns.back()};
    out.rows.push_back(
        {name, std::to_string(info.dim), join(columns), join(all.retractions(name))});
  }
  return out;
}

Table table_of_retractions(const Registry& all) {
  Table out{"retractions", {"name", "symmetric", "groups"}, {}};
  for (const std::string& name : all.retractions()) {
    std::vector<std::string> where;
    bool symmetric = true;  // on every group that is not abelian
    for (const std::string& group : all.groups()) {
      if (const RetractionInfo* info = all.retraction(group, name)) {
        where.push_back(group);
        symmetric = symmetric && info->symmetric;
      }
    }
    out.rows.push_back({name, symmetric ? "yes" : "no", join(where)});
  }
  return out;
}

Table table_of_schemes(const Registry& all) {
  Table out{"schemes", {"name", "order", "formula"}, {}};
  for (const std::string& name : all.schemes()) {
    const SchemeInfo& info = *all.scheme(name);
    const int half = info.claim(0.5, true, true).order, zero = info.claim(0, true, true).order;
    std::string order = half == 0 ? "-" : std::to_string(half);
    if (!info.adapted) order = "leaves d";
    else if (half != zero) order = fmt::format("{} at s = 1/2, else {}", half, zero);
    out.rows.push_back({name, order, info.formula});
    for (const auto& [alias, scheme] : all.scheme_aliases()) {
      if (scheme == name) out.rows.push_back({alias, order, "another name of " + name});
    }
  }
  return out;
}

Table table_of_solvers(const Registry& all) {
  Table out{"solvers", {"name", "summary"}, {}};
  for (const std::string& name : all.solvers()) {
    out.rows.push_back({name, all.solver(name)->summary});
  }
  for (const std::string& name : all.absent_solvers()) {
    const SolverInfo& info = *all.absent_solver(name);
    out.rows.push_back({name, fmt::format("not built (needs {}): {}", info.package, info.summary)});
  }
  return out;
}

Table table_of_systems(const Registry& all, const std::string& kind) {
  Table out{"systems", {"name", "group", "parameters", "summary"}, {}};
  std::vector<std::string> both;
  if (with_systems(kind)) {
    both = all.systems();
    for (const std::string& name : all.deferred_systems()) both.push_back(name);
  }
  for (const std::string& name : both) {
    const SystemInfo& info = *all.system(name);
    std::vector<std::string> fields;
    for (const Field& field : info.fields) fields.push_back(field.name);
    out.rows.push_back({name, info.group.name, join(fields), info.summary});
  }
  return out;
}

std::vector<Table> tables(const std::string& kind) {
  const Registry& all = registry();
  return {table_of_groups(all), table_of_retractions(all), table_of_schemes(all),
          table_of_solvers(all), table_of_systems(all, kind)};
}

// ---- Markdown: short tables, names of one kind in one row
// ------------------------------------------

std::string code(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += fmt::format("{}`{}`", out.empty() ? "" : " ", name);
  return out;
}

/// Names under keys: those given first, others in the order of their first name.
class Grouped {
 public:
  Grouped(const std::vector<std::string>& keys = {}) {
    for (const std::string& key : keys) rows_.push_back({key, {}});
  }
  void add(const std::string& key, const std::string& name) {
    for (auto& [known, names] : rows_) {
      if (known == key) return names.push_back(name);
    }
    rows_.push_back({key, {name}});
  }
  const auto& rows() const { return rows_; }

 private:
  std::vector<std::pair<std::string, std::vector<std::string>>> rows_;
};

std::string order_in_words(const SchemeInfo& info) {
  const auto order = [&](double s, bool symmetric) { return info.claim(s, symmetric, true).order; };
  const int half = order(0.5, true), other = order(0.25, true), skewed = order(0.25, false);
  if (!info.adapted) return "leaves the constraint";
  if (half == 0) return "none";
  if (other != half) return fmt::format("{} at s = ½, else {}", half, other);
  if (skewed == half) return std::to_string(half);
  if (info.uses_s) return fmt::format("{}; {} if τ is not symmetric and s ≠ ½", half, skewed);
  // Without s, tau is in g_1 = g_0 tau(h W) alone.
  return fmt::format("{}; {} in the configuration if τ is not symmetric", half, skewed);
}
std::string general_order_in_words(const SchemeInfo& info) {
  if (!info.defined(false)) return "not defined";
  const int half = info.claim(0.5, true, false).order, other = info.claim(0.25, true, false).order;
  if (!info.adapted) return "leaves the constraint";
  return half == other ? std::to_string(half) : fmt::format("{} at s = ½, else {}", half, other);
}

std::string kind_in_words(const SystemInfo& info) {
  const Registry& all = registry();
  const SystemModel model = info.make({});
  if (model.mechanics->left_invariant()) return "left-invariant";
  const Mechanics& mechanics = *model.mechanics;
  if (mechanics.holonomic_rows() > 0) return "holonomic rows";
  const std::string& group = model.group.name;
  const auto geometry = all.geometry(group, all.retractions_or_common(group).front());
  Eigen::VectorXd g(geometry->size()), b(mechanics.constraint_count());
  Eigen::MatrixXd a(mechanics.constraint_count(), mechanics.dim());
  geometry->from_coordinates(model.start.configuration.empty()
                                 ? all.group_or_product(group)->identity
                                 : model.start.configuration,
                             g.data());
  constexpr double some_time = 0.1;  // s, where nothing that is prescribed rests
  mechanics.constraints(some_time, g.data(), a, b);
  return b.norm() > 0 ? "affine rows" : "rows, metric or forces that depend on the configuration";
}

std::vector<Table> markdown_tables(const std::string& kind) {
  const Registry& all = registry();
  Grouped of_groups, of_systems({"left-invariant"}), of_solvers({"always"});
  for (const std::string& name : all.groups()) of_groups.add(code(all.retractions(name)), name);
  if (with_systems(kind)) {
    for (const std::string& name : all.systems()) {
      of_systems.add(kind_in_words(*all.system(name)), name);
    }
  }
  for (const std::string& name : all.deferred_systems())
    of_systems.add("mechanisms by parts", name);
  const auto package = [](const SolverInfo& info) {
    return info.package.empty() ? "always" : "with " + info.package;
  };
  for (const std::string& name : all.solvers()) of_solvers.add(package(*all.solver(name)), name);
  for (const std::string& name : all.absent_solvers()) {
    of_solvers.add(package(*all.absent_solver(name)), name);
  }
  Table groups{"groups", {"groups", "retractions there"}, {}};
  for (const auto& [key, names] : of_groups.rows()) groups.rows.push_back({code(names), key});
  Table systems{"systems", {"systems", ""}, {}};
  for (const auto& [key, names] : of_systems.rows()) systems.rows.push_back({key, code(names)});
  Table solvers{"solvers", {"solvers", ""}, {}};
  for (const auto& [key, names] : of_solvers.rows()) solvers.rows.push_back({key, code(names)});
  Table retractions{"retractions", {"retraction", "symmetric", "one-parameter"}, {}};
  for (const std::string& name : all.retractions()) {
    bool symmetric = true, one_parameter = true;
    for (const std::string& group : all.groups()) {
      if (const RetractionInfo* info = all.retraction(group, name)) {
        symmetric = symmetric && info->symmetric;
        one_parameter = one_parameter && info->one_parameter;
      }
    }
    retractions.rows.push_back(
        {code({name}), symmetric ? "yes" : "no", one_parameter ? "yes" : "no"});
  }
  Table schemes{
      "schemes", {"scheme", "order on left-invariant systems", "on general systems", "source"}, {}};
  for (const std::string& name : all.schemes()) {
    const SchemeInfo& info = *all.scheme(name);
    schemes.rows.push_back(
        {code({name}), order_in_words(info), general_order_in_words(info), info.source});
  }
  return {groups, retractions, schemes, solvers, systems};
}

void print_markdown(const Table& table) {
  const auto line = [](const std::vector<std::string>& cells) {
    std::string text = "|";
    for (const std::string& cell : cells) text += cell.empty() ? " |" : fmt::format(" {} |", cell);
    say("{}\n", text);
  };
  line(table.columns);
  std::string rule = "|";
  for (size_t j = 0; j < table.columns.size(); ++j) rule += "---|";
  say("{}\n", rule);
  for (const auto& row : table.rows) line(row);
}

}  // namespace

int list(const ListOptions& options) {
  std::vector<std::string> kinds;
  Json json = Json::object();
  bool found = options.kind.empty();
  for (const Table& table :
       options.markdown ? markdown_tables(options.kind) : tables(options.kind)) {
    kinds.push_back(table.kind);
    if (!options.kind.empty() && table.kind != options.kind) continue;
    found = true;
    if (options.markdown) print_markdown(table);
    else if (!options.json) print(table);
    else if (options.kind.empty()) json[table.kind] = to_json(table);
    else json = to_json(table);
  }
  if (!found) throw ConfigError({unknown_name("kind", options.kind, kinds)});
  if (options.json) say_json(json);
  return 0;
}

}  // namespace hamel::tools
