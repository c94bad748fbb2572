#include <hamel/framework/batch/shards.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <set>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>

namespace hamel {
namespace fs = std::filesystem;

Shard checked(const Shard& part) {
  constexpr long most = 100'000;
  if (part.count < 1 || part.index < 1 || part.index > part.count)
    throw ConfigError(
        {fmt::format("shard: got {}/{}, expected i/n with 1 <= i <= n", part.index, part.count)});
  if (part.count > most)
    throw ConfigError(
        {fmt::format("shard: got {}/{}, expected at most {} parts", part.index, part.count, most)});
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
long behind(const Shard& part, long pieces) { return pieces * part.index / part.count; }

namespace {

// A whole number from 1 at the front of a text, which it takes away; 0 for none.
long take_number(std::string_view& text) {
  long out = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || out < 1) return 0;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return out;
}

bool take_word(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

// The part whose journal has this name; a count of 0 where it is no journal of a part.
Shard part_of_name(std::string_view name) {
  Shard out{0, 0};
  if (!take_word(name, "journal-")) return out;
  const long index = take_number(name);
  if (index == 0 || !take_word(name, "-of-")) return out;
  const long count = take_number(name);
  if (name == ".jsonl" && index <= count && count > 1) out = {index, count};
  return out;
}

constexpr size_t kMostMistakes = 20;

}  // namespace

MergeLock::MergeLock(const std::string& folder, const std::atomic<bool>& stop) {
  std::error_code error;
  fs::create_directories(folder, error);
  const std::string path = (fs::path(folder) / "writing.lock").string();
  file_ = open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
  if (file_ < 0)
    throw ConfigError({fmt::format("output: cannot write '{}': {}", path, std::strerror(errno))});
  while (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    const bool held = errno == EWOULDBLOCK || errno == EINTR;
    if (held && !stop) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      continue;
    }
    const std::string why =
        held ? "interrupted, while another process writes the results there" : std::strerror(errno);
    close(file_);
    throw Unfinished(fmt::format("output: '{}': {}", folder, why));
  }
}
MergeLock::~MergeLock() { close(file_); }

long shards_in(const std::string& folder) {
  std::set<long> counts;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (const Shard part = part_of_name(entry.path().filename().string()); part.count > 0)
      counts.insert(part.count);
  if (counts.empty())
    throw MissingParts({fmt::format("merge: '{}' has no shards (--shard 1/2)", folder)});
  if (counts.size() > 1)
    throw ConfigError({fmt::format("merge: '{}' has shards of {} and of {}: remove those of one",
                                   folder, *counts.begin(), *std::next(counts.begin()))});
  return checked({1, *counts.begin()}).count;
}

std::vector<std::string> join_shards(const std::string& folder, long count,
                                     const JournalSubject& whole, const TakeLine& take,
                                     const std::function<std::string(const Shard&)>& lacks) {
  std::vector<std::string> notes, missing, refused;
  for (long i = 1; i <= count; ++i) {
    const Shard part{i, count};
    const std::string name = journal_name(part);
    if (!journal_has_begun(folder, name)) {
      missing.push_back(fmt::format("merge: shard {}/{} is missing", i, count));
      continue;
    }
    try {
      for (std::string& note : read_journal(folder, name, subject_of_part(whole, part), take))
        notes.push_back(std::move(note));
    } catch (const ConfigError& error) {
      for (const std::string& why : error.mistakes())
        refused.push_back(fmt::format("merge: {}: {}", name, why));
      continue;
    }
    if (const std::string what = lacks(part); !what.empty())
      missing.push_back(fmt::format("merge: shard {}/{} is incomplete: {}", i, count, what));
  }
  const auto shortened = [](std::vector<std::string> all) {
    if (all.size() <= kMostMistakes) return all;
    const size_t more = all.size() - kMostMistakes;
    all.resize(kMostMistakes);
    all.push_back(fmt::format("merge: and {} more", more));
    return all;
  };
  if (!refused.empty()) throw ConfigError(shortened(std::move(refused)));
  if (!missing.empty()) throw MissingParts(shortened(std::move(missing)));
  return notes;
}

}  // namespace hamel
