// The result of a run from its file. Not installed.
#pragma once

#include <cstddef>
#include <string>

#include <hamel/framework/run/record/run_file.hpp>

namespace hamel {

class Registry;

struct RecordedResult {
  Result result;
  /// Parts of the system that the file does not have; "" where the registry has the system.
  std::string lack;
};

/// A finished run, at most so many of its rows. Made of the texts in the file: the files that it
/// was made of may be others by now, or gone. A system of another program is known by its columns
/// (record/recorded_system.hpp); its scheme, retraction and solver need not be registered.
RecordedResult recorded_result(const RunFile& run, const Registry& registry, std::size_t most);

}  // namespace hamel
