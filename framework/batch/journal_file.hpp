// A journal: one line of JSON for each finished piece of work, appended and flushed, so that a
// killed program resumes where it stopped. Its first line names the work and the program it
// belongs to. Each further line ends with a checksum: a damaged one is left out, and its piece of
// work is done again. Not installed.
#pragma once

#include <cstdio>
#include <functional>
#include <iosfwd>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace hamel {

/// Subject of a journal: "study", its pieces in plural, and the lines that fix the results.
struct JournalSubject {
  std::string kind, pieces;
  std::vector<std::string> lines;
};

/// A JSON object with the checksum of its text as the last member, "sum".
std::string sealed(const std::string& object);

/// Passes each line whose checksum is right to take, and returns a note for each other one and for
/// those on which take throws.
using TakeLine = std::function<void(const std::string& object)>;
std::vector<std::string> read_sealed(std::istream& lines, const std::string& name,
                                     const TakeLine& take);

class JournalFile {
 public:
  /// Opens or begins folder/name and locks it. ConfigError when it belongs to something else, when
  /// its first line is damaged, when it is in use, or cannot be written.
  JournalFile(const std::string& folder, const std::string& name, const JournalSubject& subject,
              bool fresh);
  /// The lines that were there, after the first: read_sealed.
  std::vector<std::string> read(const TakeLine& take) const;
  void append(const std::string& object) { write(sealed(object)); }

 private:
  void write(const std::string& line);

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_, name_;
  bool goes_on_ = false;
  std::unique_ptr<std::FILE, Close> file_;
  std::mutex mutex_;
};

/// Is its first line there, which is written at once?
bool journal_has_begun(const std::string& folder, const std::string& name);

/// The lines of a journal that another process may be writing. ConfigError where there is none, or
/// one of something else.
std::vector<std::string> read_journal(const std::string& folder, const std::string& name,
                                      const JournalSubject& subject, const TakeLine& take);

}  // namespace hamel
