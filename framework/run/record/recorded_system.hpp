// A system of another program, as far as the file of a run shows it: its group, the names and units
// of its columns, its parameters. It has no mechanics, no drawing and no events. Not installed.
#pragma once

#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/record/run_file.hpp>

namespace hamel {

class Registry;

struct RecordedSystem {
  /// The group is the registry's where it has one of that name and size.
  RecordedSystem(const RunFile& run, const Registry& registry);
  /// Are these the group and the sizes of the columns of this model?
  bool has_columns_of(const SystemModel& other) const;

  SystemModel model;
};

}  // namespace hamel
