#include <hamel/framework/run/record/run_file.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/table.hpp>
#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/run/names/system_file.hpp>
#include <hamel/framework/run/record/checkpoint.hpp>
#include <hamel/framework/run/record/named_columns.hpp>

namespace hamel {
namespace {

using Json = nlohmann::ordered_json;

// The one before had texts of variable length, without a checksum.
constexpr const char *kFormat = "hamel run 2", *kFormatBefore = "hamel run 1";

// The unfinished run of this file where there is one, else the file.
std::string existing(const std::string& path) {
  std::error_code error;
  const std::string part = part_of(path);
  return std::filesystem::exists(part, error) ? part : path;
}

std::string whole(const std::string& path) {
  const std::string part = part_of("");
  return path.ends_with(part) ? path.substr(0, path.size() - part.size()) : path;
}

// The rows of a run; of a table, whose file is whole, what it is.
RowFileReader rows_of(const std::string& path) {
  try {
    return RowFileReader(path);
  } catch (const ConfigError&) {
    std::map<std::string, std::string> texts;
    try {
      (void)read_hdf5(path, &texts);
    } catch (const ConfigError&) {
    }
    const char* of = texts.contains("ensemble") ? "an ensemble: its page is report.html beside it"
                     : texts.contains("title")  ? "a study: its page is report.html beside it"
                     : texts.contains("event")  ? "a section"
                                                : nullptr;
    if (of == nullptr) throw;
    throw ConfigError(
        {fmt::format("'{}': expected a run (hamel run … -o x.h5), got the table of {}", path, of)});
  }
}

}  // namespace

RunFileSink::~RunFileSink() {
  // Ended before it took its place, it has nothing that is not elsewhere.
  if (lock_ != nullptr && !in_place_) std::remove((part_of(path_) + ".new").c_str());
}

void RunFileSink::begin(const RunHead& head) {
  const std::string part = part_of(path_), fresh = part + ".new";
  lock_ = std::make_unique<FileLock>(fresh);  // it stays with the file when that becomes x.part
  if (locked(part))
    throw ConfigError({fmt::format("output: another process is writing '{}'", part)});
  events_ = event_rows(head);
  out_ = std::make_unique<RowFileWriter>(fresh, head.columns,
                                         std::map<std::string, std::string>{
                                             {"format", kFormat},
                                             {"build", build_name()},
                                             {"config", head.config},
                                             {"files", head.files},
                                             {"start", head.record},
                                         },
                                         events_);
}

void RunFileSink::checkpoint(const std::string& state, const std::string& news) {
  CheckpointWriter both;
  std::string first = state, second = news;
  both(first, second);
  out_->mark(both.bytes());
}

void RunFileSink::flush() {
  if (in_place_) return;
  const std::string part = part_of(path_);
  if (std::rename((part + ".new").c_str(), part.c_str()) != 0)
    throw Unfinished(fmt::format("output: cannot write '{}'", path_));
  in_place_ = true;
}

void RunFileSink::finish(const Result& result) {
  flush();
  out_->finish(result.record(), event_rows(std::move(events_), result.events));
  finish_file(part_of(path_), path_);
}

RunFile::RunFile(const std::string& path) : path_(whole(path)), rows_(rows_of(existing(path_))) {
  if (const std::string format = rows_.text("format"); format != kFormat && format != kFormatBefore)
    throw ConfigError({fmt::format("'{}': it holds no run (hamel run … -o x.h5)", path_)});
}

RunFile::Kept RunFile::kept() const {
  Kept out;
  for (const RowFileReader::Mark& mark : rows_.marks()) {
    out.rows = mark.rows;
    CheckpointReader both(mark.bytes);
    both(out.state, out.news.emplace_back());
  }
  return out;
}

Config RunFile::config() const { return Config::from_toml(rows_.text("config"), path_); }

std::string texts_of_files(const Config& config) {
  Json out = Json::object();
  if (names_file(config.system)) out[config.system] = read_system_file(config.system);
  for (const auto& [name, signal] : config.inputs) {
    if (const auto* file = std::get_if<InputFile>(&signal))
      out[file->path] = read_text_file(name, file->path);
  }
  // (A comment may be in no UTF-8.)
  return out.empty() ? "" : out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string RunFile::file(const std::string& path) const {
  const Json files = Json::parse(text("files"), nullptr, false);
  if (files.is_object() && files.contains(path)) return files[path].get<std::string>();
  throw ConfigError({fmt::format("'{}': it does not hold the text of '{}'", path_, path)});
}

Trajectory read_rows(const RunFile& file, std::size_t most, const SystemModel* system) {
  constexpr std::size_t piece = 4096;
  Trajectory out;
  const std::unique_ptr<Sink> rows = make_memory_sink(out, most);
  std::vector<ColumnGroup> groups = file.table().groups();
  if (system != nullptr) rename_columns(groups, *system);
  rows->begin({std::move(groups), "", "", ""});
  std::vector<double> values;
  const std::size_t count = file.table().rows();
  std::uint64_t sum = kNoRows;
  for (std::size_t at = 0; at < count; at += piece) {
    file.table().read(at, std::min(piece, count - at), values);
    sum = checksum_of_rows(sum, values);
    rows->rows(values);
  }
  if (file.table().checksum().value_or(sum) != sum) {
    throw ConfigError(
        {fmt::format("'{}': it is damaged: its rows are not those written", file.path())});
  }
  rows->finish(Result());
  return out;
}

Recorded read_recorded(const std::string& path) {
  const RunFile file(path);
  if (!file.finished()) return {file.path(), false, file.config()};
  const Config config = Config::continued(file.record(), path);
  const std::string& system = config.system;
  if (names_file(system) && file.file(system) != read_system_file(system)) {
    throw ConfigError({fmt::format(
        "continue: '{}': the file of its system, '{}', is not what it was", file.path(), system)});
  }
  return {file.path(), true, config};
}

}  // namespace hamel
