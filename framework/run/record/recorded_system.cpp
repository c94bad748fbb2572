#include <hamel/framework/run/record/recorded_system.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel {
namespace {

// The units of the columns of a group, which its attribute has one behind the other; none where
// they are not as many.
std::vector<std::string> units_of_columns(const ColumnGroup& group) {
  std::vector<std::string> out(1);
  for (const char c : group.unit) {
    if (c == ',') out.emplace_back();
    else out.back() += c;
  }
  if (out.size() != group.columns.size()) out.clear();
  return out;
}

// A group that is not registered.
GroupInfo group_of_columns(const std::string& name, const ColumnGroup& element,
                           const ColumnGroup& velocity) {
  GroupFactor factor{.name = name,
                     .dim = static_cast<int>(velocity.columns.size()),
                     .columns = static_cast<int>(element.columns.size()),
                     .names = element.columns,
                     .units = units_of_columns(element)};
  const std::vector<std::string> units = units_of_columns(velocity);
  for (size_t i = 0; i < units.size(); ++i)
    factor.components.push_back({velocity.columns[i], units[i]});
  GroupInfo out;
  out.name = name;
  out.dim = factor.dim;
  out.factors = {std::move(factor)};
  return out;
}

}  // namespace

RecordedSystem::RecordedSystem(const RunFile& run, const Registry& registry) {
  const auto record = nlohmann::ordered_json::parse(run.record(), nullptr, false);
  const auto text = [&](const char* key) {
    if (!record.is_object() || !record.contains(key) || !record[key].is_string())
      throw ConfigError({fmt::format("'{}': its record has no {}", run.path(), key)});
    return record[key].get<std::string>();
  };
  const std::vector<ColumnGroup> groups = run.table().groups();
  const auto group_called = [&](const char* name) {
    const auto at = std::ranges::find(groups, name, &ColumnGroup::name);
    return at == groups.end() ? ColumnGroup() : *at;
  };
  const ColumnGroup element = group_called("configuration"), velocity = group_called("xi");
  model.name = text("system");
  const std::string name = text("group");
  const auto registered = registry.group_or_product(name);
  const bool fits = registered && registered->columns.size() == element.columns.size() &&
                    static_cast<size_t>(registered->dim) == velocity.columns.size();
  model.group = fits ? *registered : group_of_columns(name, element, velocity);
  model.group.columns = element.columns;
  model.rates = velocity.columns;
  model.has_names = true;
  model.reactions = group_called("lambda").columns;
  for (const auto& [parameter, value] : recorded_config(run.record(), run.path()).parameters)
    model.fields.push_back({parameter, value, "", "", {}});
}

bool RecordedSystem::has_columns_of(const SystemModel& other) const {
  return model.group.name == other.group.name &&
         model.group.columns.size() == other.group.columns.size() &&
         model.rates.size() == other.rates.size();
}

}  // namespace hamel
