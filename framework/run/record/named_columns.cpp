#include <hamel/framework/run/record/named_columns.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/mechanics/components.hpp>

namespace hamel {
namespace {

void add_other_names(const SystemModel& system, size_t first, ColumnGroup& group) {
  for (const OtherName& other : system.other_names)
    if (other.place >= first && other.place - first < group.columns.size())
      group.other_names.emplace_back(other.name, other.place - first);
}

}  // namespace

ColumnGroup element_columns(const SystemModel& system) {
  ColumnGroup out{"configuration",
                  fmt::format("{}", fmt::join(units_of_element(system.group), ",")),
                  "the element g of " + system.group.name,
                  "g takes the body's frame to the frame in space", system.group.columns};
  add_other_names(system, 0, out);
  return out;
}

ColumnGroup velocity_columns(const SystemModel& system) {
  ColumnGroup out{"xi", "", "nodal body velocity",
                  "the body's: left trivialisation, angular part first", system.rates};
  std::vector<std::string> units;
  for (const Component& component : components_of(system)) units.push_back(component.unit);
  out.unit = fmt::format("{}", fmt::join(units, ","));
  add_other_names(system, system.group.columns.size(), out);
  return out;
}

void rename_columns(std::vector<ColumnGroup>& groups, const SystemModel& system) {
  for (const ColumnGroup& named : {element_columns(system), velocity_columns(system)}) {
    for (ColumnGroup& group : groups) {
      if (group.name != named.name || group.columns.size() != named.columns.size()) continue;
      group.columns = named.columns;
      group.other_names = named.other_names;
    }
  }
}

}  // namespace hamel
