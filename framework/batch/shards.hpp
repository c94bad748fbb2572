// Parts of ensembles and studies: the journal of each part, and how they are joined. Not
// installed.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include <hamel/framework/batch/journal_file.hpp>
#include <hamel/framework/batch/shard.hpp>
#include <hamel/framework/io/errors.hpp>

namespace hamel {

/// "journal.jsonl" of the whole, "journal-3-of-16.jsonl" of a part.
std::string journal_name(const Shard& part);
/// The subject of a part's journal, made from that of the whole.
JournalSubject subject_of_part(JournalSubject whole, const Shard& part);
/// First of so many pieces in a part, and the first one behind it.
long first_piece(const Shard& part, long pieces);
long behind(const Shard& part, long pieces);

/// Parts that another process may still write.
struct HAMEL_API MissingParts : ConfigError {
  using ConfigError::ConfigError;
};

/// Writing of the results in a folder: one process at a time, others wait. stop, where it becomes
/// true, ends the wait with Unfinished.
class MergeLock {
 public:
  MergeLock(const std::string& folder, const std::atomic<bool>& stop);
  ~MergeLock();
  MergeLock(const MergeLock&) = delete;
  MergeLock& operator=(const MergeLock&) = delete;

 private:
  int file_;
};

/// The number of parts in a folder, by the names of their journals. MissingParts where there are
/// none, ConfigError where they are of two kinds.
long shards_in(const std::string& folder);
/// Passes the lines of all parts to take, and returns their notes. lacks(part), behind the lines of
/// a part: "" or what it has not, "3 of 7 members". MissingParts where nothing is wrong but what is
/// not there yet; ConfigError with everything that is.
std::vector<std::string> join_shards(const std::string& folder, long count,
                                     const JournalSubject& whole, const TakeLine& take,
                                     const std::function<std::string(const Shard&)>& lacks);

}  // namespace hamel
