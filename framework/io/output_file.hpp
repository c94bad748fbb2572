// Files that appear whole under their name: written beside it, as name.part, and renamed when they
// are done.
#pragma once

#include <stdexcept>
#include <string>

namespace hamel {

/// Thrown where a file could not be completed (a full disk, a closed pipe): the part written stays
/// beside it, as name.part.
struct Unfinished : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The path under which `path` is written until it is complete.
inline std::string part_of(const std::string& path) { return path + ".part"; }

/// Name of a file, the same for all spellings of a path ("a.h5", "./a.h5", a link to its folder).
std::string place_of(const std::string& path);

/// Brings `part` to the disk and gives it its name; Unfinished on failure.
void finish_file(const std::string& part, const std::string& path);

/// This process writes the file: other processes are refused until this object or the process ends.
class FileLock {
 public:
  /// Creates the file where there is none. ConfigError where another has it.
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int file_;
};
/// Has somebody a FileLock of it?
bool locked(const std::string& path);

/// Writes text as a whole; Unfinished on failure, and then nothing is left.
void write_file(const std::string& path, const std::string& text);

/// "" when a file can be created at path, else what is in the way. Touches nothing.
std::string unwritable(const std::string& path);

}  // namespace hamel
