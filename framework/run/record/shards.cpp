#include <hamel/framework/run/record/shards.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {
namespace fs = std::filesystem;

Shard checked(const Shard& part) {
  if (part.count < 1 || part.index < 1 || part.index > part.count)
    throw ConfigError(
        {fmt::format("shard: got {}/{}, expected i/n with 1 <= i <= n", part.index, part.count)});
  return part;
}

std::string journal_name(const Shard& part) {
  return part.count == 1 ? "journal.jsonl"
                         : fmt::format("journal-{}-of-{}.jsonl", part.index, part.count);
}

JournalSubject subject_of_part(JournalSubject whole, const Shard& part) {
  if (part.count > 1) whole.lines.push_back(fmt::format("shard = {}/{}", part.index, part.count));
  return whole;
}

long first_piece(const Shard& part, long pieces) { return pieces * (part.index - 1) / part.count; }

long shards_in(const std::string& folder) {
  std::vector<long> counts;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const size_t of = name.find("-of-");
    if (!name.starts_with("journal-") || of == std::string::npos) continue;
    const long count = std::atol(name.c_str() + of + 4);
    if (count > 1 && std::ranges::find(counts, count) == counts.end()) counts.push_back(count);
  }
  if (counts.empty())
    throw ConfigError({fmt::format("merge: '{}' has no shards (--shard 1/2)", folder)});
  if (counts.size() > 1) {
    std::ranges::sort(counts);
    throw ConfigError({fmt::format("merge: '{}' has shards of {} and of {}: remove those of one",
                                   folder, counts[0], counts[1])});
  }
  return counts[0];
}

std::vector<std::string> join_shards(const std::string& folder, long count,
                                     const JournalSubject& whole, const TakeLine& take,
                                     const std::function<std::string(const Shard&)>& lacks) {
  std::vector<std::string> notes, missing;
  for (long i = 1; i <= count; ++i) {
    const Shard part{i, count};
    const std::string name = journal_name(part);
    std::error_code error;
    if (!fs::exists(fs::path(folder) / name, error)) {
      missing.push_back(fmt::format("merge: shard {}/{} is missing", i, count));
      continue;
    }
    try {
      for (std::string& note : read_journal(folder, name, subject_of_part(whole, part), take))
        notes.push_back(std::move(note));
    } catch (const ConfigError& refused) {
      for (const std::string& why : refused.mistakes())
        missing.push_back(fmt::format("merge: {}: {}", name, why));
      continue;
    }
    if (const std::string what = lacks(part); !what.empty())
      missing.push_back(fmt::format("merge: shard {}/{} is incomplete: {}", i, count, what));
  }
  if (!missing.empty()) throw ConfigError(missing);
  return notes;
}

}  // namespace hamel
