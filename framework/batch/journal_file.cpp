#include <hamel/framework/batch/journal_file.hpp>

#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>

namespace hamel {
namespace {

using Json = nlohmann::ordered_json;

std::string header(const JournalSubject& subject) {
  return Json{{"journal", 1}, {"version", build_name()}, {subject.kind, subject.lines}}.dump();
}

// The lines of one first line that the other has not, the first few.
std::string difference(const JournalSubject& subject, const std::string& first,
                       const std::string& mine) {
  const Json there = Json::parse(first, nullptr, false), here = Json::parse(mine);
  std::string out;
  int count = 0;
  const auto list = [&](const char* sign, const Json& some, const Json& others) {
    for (const auto& line : some)
      if (std::find(others.begin(), others.end(), line) == others.end() && ++count <= 6)
        out += fmt::format("\n  {} {}", sign, line.get<std::string>());
  };
  try {
    list("there:", there.at(subject.kind), here[subject.kind]);
    list("here: ", here[subject.kind], there.at(subject.kind));
    if (there.at("version") != here["version"])
      out += fmt::format("\n  there: hamel {}\n  here:  hamel {}",
                         there["version"].get<std::string>(), here["version"].get<std::string>());
  } catch (const Json::exception&) {
    out = "\n  (its first line is damaged)";
  }
  return out;
}

constexpr const char* kSum = ",\"sum\":\"";

// FNV-1a, 64 bits.
uint64_t checksum(const std::string& text) {
  uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

[[noreturn]] void refuse_journal(const std::string& why) { throw ConfigError({"output: " + why}); }

// A pipe that nobody writes to, or reads, keeps its other end waiting for ever.
void require_regular(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status there = std::filesystem::status(path, error);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
    refuse_journal(fmt::format("'{}' is no regular file", path));
}

// The size of a file without a torn last line, and whether its first line is whole.
struct Extent {
  size_t whole = 0;
  bool begun = false;
};
Extent extent_of(std::istream& in) {
  Extent out;
  std::vector<char> block(1 << 16);
  for (size_t at = 0; in.good();) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto read = static_cast<size_t>(in.gcount());
    for (size_t i = read; i > 0; --i) {
      if (block[i - 1] != '\n') continue;
      out = {at + i, true};
      break;
    }
    at += read;
  }
  return out;
}

// Refuses a first line that is not `subject`'s.
void check_first(const std::string& folder, const std::string& path, const std::string& first,
                 const JournalSubject& subject, bool fresh, bool begun) {
  if (!first.empty() && !first.starts_with("{\"journal\""))
    refuse_journal(
        fmt::format("'{}' is no journal of a {}; use another folder", path, subject.kind));
  const std::string mine = header(subject);
  if (!fresh && begun && first != mine)
    refuse_journal(
        fmt::format("'{}' holds the {} of another {} or program; --fresh forgets them, or use "
                    "another folder{}",
                    folder, subject.pieces, subject.kind, difference(subject, first, mine)));
}

}  // namespace

std::string sealed(const std::string& object) {
  const std::string body = object.substr(0, object.rfind('}'));
  return fmt::format("{}{}{:016x}\"}}", body, kSum, checksum(body));
}

std::vector<std::string> read_sealed(std::istream& lines, const std::string& name,
                                     const TakeLine& take) {
  std::vector<std::string> notes;
  size_t number = 1;  // of the first line, which names the work
  for (std::string line; std::getline(lines, line);) {
    ++number;
    try {
      const size_t end = line.rfind(kSum);
      if (end == std::string::npos || sealed(line.substr(0, end) + "}") != line)
        throw std::runtime_error("its checksum");
      take(line);
    } catch (const std::exception& error) {
      notes.push_back(fmt::format("{}:{}: damaged ({}); what it held is computed again", name,
                                  number, error.what()));
    }
  }
  return notes;
}

JournalFile::JournalFile(const std::string& folder, const std::string& name,
                         const JournalSubject& subject, bool fresh)
    : name_(name) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  path_ = (std::filesystem::path(folder) / name).string();
  require_regular(path_);
  file_.reset(std::fopen(path_.c_str(), "a"));
  if (file_ == nullptr) refuse_journal(fmt::format("cannot write '{}'", path_));
  if (flock(fileno(file_.get()), LOCK_EX | LOCK_NB) != 0)
    refuse_journal(fmt::format("another {} is running in '{}'", subject.kind, folder));
  std::ifstream in(path_, std::ios::binary);
  const Extent there = extent_of(in);
  in.clear();
  in.seekg(0);
  std::string first;
  std::getline(in, first);
  check_first(folder, path_, first, subject, fresh, there.begun);
  // A torn first line is a work that had not begun, a torn last one a piece that was in flight.
  goes_on_ = !fresh && there.begun;
  if (ftruncate(fileno(file_.get()), static_cast<off_t>(goes_on_ ? there.whole : 0)) != 0)
    refuse_journal(fmt::format("cannot write '{}'", path_));
  if (!goes_on_) write(header(subject));
}

std::vector<std::string> JournalFile::read(const TakeLine& take) const {
  if (!goes_on_) return {};
  std::ifstream in(path_, std::ios::binary);
  std::string first;
  std::getline(in, first);
  return read_sealed(in, name_, take);
}

void JournalFile::write(const std::string& line) {
  const std::lock_guard lock(mutex_);
  if (std::fputs((line + "\n").c_str(), file_.get()) < 0 || std::fflush(file_.get()) != 0)
    throw Unfinished(fmt::format("output: cannot write '{}': {}", path_, std::strerror(errno)));
}

bool journal_has_begun(const std::string& folder, const std::string& name) {
  const std::string path = (std::filesystem::path(folder) / name).string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return false;
  if (!std::filesystem::is_regular_file(path, error)) return true;  // refused where it is read
  std::ifstream in(path, std::ios::binary);
  std::string first;
  return std::getline(in, first) && !in.eof();
}

std::vector<std::string> read_journal(const std::string& folder, const std::string& name,
                                      const JournalSubject& subject, const TakeLine& take) {
  const std::string path = (std::filesystem::path(folder) / name).string();
  require_regular(path);
  std::ifstream in(path, std::ios::binary);
  std::string first;
  if (!std::getline(in, first))
    refuse_journal(fmt::format("'{}' is no journal of a {}", path, subject.kind));
  check_first(folder, path, first, subject, false, true);
  return read_sealed(in, name, take);
}

}  // namespace hamel
