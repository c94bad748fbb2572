#include <hamel/framework/run/record/sink.hpp>

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/table.hpp>
#include <hamel/framework/run/record/run_file.hpp>

namespace hamel {
namespace {

[[noreturn]] void refuse(const std::string& path) {
  throw Unfinished(fmt::format("output: cannot write '{}': {}", path, std::strerror(errno)));
}

// Bytes to a file, plain or compressed, or to standard output.
class PlainBytes {
 public:
  explicit PlainBytes(const std::string& path)
      : path_(path),
        lock_(path == "-" ? nullptr : std::make_unique<FileLock>(part_of(path))),
        file_(path == "-" ? stdout : std::fopen(part_of(path).c_str(), "wb")) {
    if (file_ == nullptr) refuse(path_);
  }
  ~PlainBytes() {
    if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  }
  PlainBytes(const PlainBytes&) = delete;
  PlainBytes& operator=(const PlainBytes&) = delete;
  void write(std::string_view bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) refuse(path_);
  }
  void flush() {
    if (std::fflush(file_) != 0) refuse(path_);
  }
  void finish() {
    flush();
    if (file_ == stdout) return;
    if (std::fclose(std::exchange(file_, nullptr)) != 0) refuse(path_);
    finish_file(part_of(path_), path_);
  }

 private:
  std::string path_;
  std::unique_ptr<FileLock> lock_;
  std::FILE* file_;
};

class CompressedBytes {
 public:
  explicit CompressedBytes(const std::string& path)
      : path_(path), lock_(part_of(path)), file_(gzopen(part_of(path).c_str(), "wb1")) {
    if (file_ == nullptr) refuse(path_);
  }
  ~CompressedBytes() {
    if (file_ != nullptr) gzclose(file_);
  }
  CompressedBytes(const CompressedBytes&) = delete;
  CompressedBytes& operator=(const CompressedBytes&) = delete;
  void write(std::string_view bytes) {
    if (!bytes.empty() && gzwrite(file_, bytes.data(), static_cast<unsigned>(bytes.size())) == 0)
      refuse(path_);
  }
  void flush() {
    if (gzflush(file_, Z_SYNC_FLUSH) != Z_OK) refuse(path_);
  }
  void finish() {
    if (gzclose(std::exchange(file_, nullptr)) != Z_OK) refuse(path_);
    finish_file(part_of(path_), path_);
  }

 private:
  std::string path_;
  FileLock lock_;
  gzFile file_;
};

std::string csv_of(const NamedRows& named) {
  std::string out = csv_field(named.name);
  for (const std::string& column : named.columns) out += "," + csv_field(column);
  out += '\n';
  for (const NamedRows::Row& row : named.rows) {
    out += csv_field(row.name);
    for (const double value : row.values) out += fmt::format(",{:.17g}", value);
    out += '\n';
  }
  return out;
}

// Names, rows, then the record in lines that begin with #. Events are a table in a file beside it.
template <class Bytes>
class CsvSink final : public Sink {
 public:
  explicit CsvSink(std::string path) : path_(std::move(path)) {}
  ~CsvSink() override {
    // An unfinished file without rows is removed.
    if (out_ && !rows_ && path_ != "-") std::remove(part_of(path_).c_str());
  }
  void begin(const RunHead& head) override {
    out_.emplace(path_);
    events_ = event_rows(head);
    for (const ColumnGroup& group : head.columns) {
      for (const std::string& name : group.columns) {
        text_.append(std::string_view(width_++ > 0 ? "," : ""));
        text_.append(name);
      }
    }
    text_.push_back('\n');
    put();
  }
  void rows(std::span<const double> values) override {
    rows_ = true;
    std::size_t column = 0;
    for (const double value : values) {
      text_.resize(text_.size() + kNumber);
      char* const begin = text_.data() + text_.size() - kNumber;
      const auto end =
          std::to_chars(begin, begin + kNumber, value, std::chars_format::general, 17).ptr;
      text_.resize(static_cast<std::size_t>(end - text_.data()));
      text_.push_back(++column == width_ ? '\n' : ',');
      if (column == width_) column = 0;
      if (text_.size() > 1 << 16) put();
    }
    put();
  }
  void flush() override { out_->flush(); }
  void finish(const Result& result) override {
    std::istringstream lines(result.record());
    for (std::string line; std::getline(lines, line);)
      fmt::format_to(std::back_inserter(text_), "# {}\n", line);
    put();
    if (const std::string path = path_of_events(path_); path.empty()) {
    } else if (events_.set.empty()) {
      std::remove(path.c_str());  // those of an earlier run
    } else {
      Bytes events(path);
      events.write(csv_of(event_rows(std::move(events_), result.events)));
      events.finish();
    }
    out_->finish();
  }

 private:
  void put() {
    out_->write({text_.data(), text_.size()});
    text_.clear();
  }

  static constexpr std::size_t kNumber = 32;  // bytes of a number at most: -1.7976931348623157e+308
  std::string path_;
  std::optional<Bytes> out_;  // from its beginning on: of a run that is refused nothing is left
  NamedRows events_;
  bool rows_ = false;
  std::size_t width_ = 0;
  fmt::memory_buffer text_;
};

class JsonSink final : public Sink {
 public:
  explicit JsonSink(std::string path) : path_(std::move(path)) {}
  void begin(const RunHead&) override {}
  void rows(std::span<const double>) override {}
  void finish(const Result& result) override { write_file(path_, result.record() + "\n"); }

 private:
  std::string path_;
};

struct Format {
  const char* extension;
  std::unique_ptr<Sink> (*make)(const std::string& path);
};

template <class Made>
std::unique_ptr<Sink> make(const std::string& path) {
  return std::make_unique<Made>(path);
}

constexpr Format kFormats[] = {{".csv", make<CsvSink<PlainBytes>>},
                               {".csv.gz", make<CsvSink<CompressedBytes>>},
                               {".h5", make<RunFileSink>},
                               {".json", make<JsonSink>}};

const Format* format_of(const std::string& path) {
  if (path == "-") return &kFormats[0];
  const std::string name = std::filesystem::path(path).filename();
  const auto* it = std::find_if(std::begin(kFormats), std::end(kFormats), [&](const Format& f) {
    return name.ends_with(f.extension) && name != f.extension;
  });
  return it == std::end(kFormats) ? nullptr : it;
}

}  // namespace

std::string path_of_events(const std::string& path) {
  const std::filesystem::path file(path);
  const std::string name = file.filename();
  const size_t dot = std::min(name.rfind(".csv"), name.rfind(".csv.gz"));
  const bool csv = path != "-" && (name.ends_with(".csv") || name.ends_with(".csv.gz"));
  return csv ? file.parent_path() / (name.substr(0, dot) + ".events" + name.substr(dot)) : "";
}

NamedRows event_rows(const RunHead& head) {
  if (head.events.empty()) return {};
  NamedRows out{"events", "name", 0, {}};
  for (const std::string& event : head.events) out.longest = std::max(out.longest, event.size());
  for (const char* name : {"t", "configuration", "xi"})
    for (const ColumnGroup& group : head.columns)
      if (group.name == name)
        out.columns.insert(out.columns.end(), group.columns.begin(), group.columns.end());
  while (std::find(out.columns.begin(), out.columns.end(), out.name) != out.columns.end())
    out.name += '_';  // a system has a coordinate called so
  return out;
}

NamedRows event_rows(NamedRows head, const std::vector<EventMet>& met) {
  for (const EventMet& event : met) {
    NamedRows::Row& row = head.rows.emplace_back(NamedRows::Row{event.name, {event.time}});
    row.values.insert(row.values.end(), event.coordinates.begin(), event.coordinates.end());
    row.values.insert(row.values.end(), event.velocity.begin(), event.velocity.end());
  }
  return head;
}

const std::vector<std::string>& output_formats() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> out;
    for (const Format& f : kFormats) out.emplace_back(f.extension);
    return out;
  }();
  return all;
}

std::unique_ptr<Sink> make_sink(const std::string& path) {
  if (const std::string mistake = record_mistake(path); !mistake.empty())
    throw ConfigError({mistake});
  return format_of(path)->make(path);
}

std::string record_mistake(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension();
  if (format_of(path) == nullptr)
    return unknown_name("output format", extension, output_formats()) + " in '" + path + "'";
  if (path == "-") return "";
  if (extension == ".h5" && !hdf5_missing().empty())
    return fmt::format("output: '{}': {}", path, hdf5_missing());
  return unwritable(path);
}

namespace {

class MemorySink final : public Sink {
 public:
  MemorySink(Trajectory& rows, std::size_t most) : out_(rows), most_(most) {}
  void begin(const RunHead& head) override { out_ = Trajectory(head.columns); }
  void rows(std::span<const double> values) override {
    if (most_ == 0) return out_.append(values);
    const std::size_t width = out_.columns().size();
    for (std::size_t at = 0; at < values.size(); at += width) {
      const auto row = values.subspan(at, width);
      last_.clear();
      if (seen_++ % stride_ != 0) {
        last_.assign(row.begin(), row.end());
        continue;
      }
      out_.append(row);
      if (out_.rows() <= most_) continue;
      out_.thin();
      stride_ *= 2;
      if ((seen_ - 1) % stride_ != 0) last_.assign(row.begin(), row.end());
    }
  }
  void finish(const Result&) override {
    if (!last_.empty()) out_.append(last_);
    out_.stride(stride_);
  }

 private:
  Trajectory& out_;
  std::size_t most_, stride_ = 1, seen_ = 0;
  std::vector<double> last_;  // row, where it is none of the kept
};

}  // namespace

std::unique_ptr<Sink> make_memory_sink(Trajectory& rows, std::size_t most) {
  return std::make_unique<MemorySink>(rows, most);
}

}  // namespace hamel
