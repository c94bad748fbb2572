// A run in an HDF5 file (io/row_file.hpp): written during the run, read when it is resumed, or for
// its page. Not installed.
//
// Data sets: the groups of columns; texts: config (TOML), files (texts_of_files), start (the record
// before the first step), build, format, and record, the Result's, in the end; resume, checkpoints
// (run/record/checkpoint.hpp) until then. The set events, where some are watched, is for readers;
// hamel itself reads them in the record.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/run/names/config.hpp>
#include <hamel/framework/run/record/sink.hpp>

namespace hamel {

/// The texts of the files that a run reads, its system and inputs: {path: text}, JSON; "" where
/// there is none.
std::string texts_of_files(const Config& config);

class RunFileSink final : public Sink {
 public:
  explicit RunFileSink(std::string path) : path_(std::move(path)) {}
  ~RunFileSink() override;
  void begin(const RunHead& head) override;
  void rows(std::span<const double> values) override { out_->append(values); }
  bool resumable() const override { return true; }
  void checkpoint(const std::string& state, const std::string& news) override;
  /// The first time its file takes the place of one that was there: a resumed run has written
  /// its rows again by then.
  void flush() override;
  void finish(const Result& result) override;

 private:
  std::string path_;
  bool in_place_ = false;
  std::unique_ptr<FileLock> lock_;
  std::unique_ptr<RowFileWriter> out_;
  NamedRows events_;
};

/// An unfinished or finished run, as its file has it.
class RunFile {
 public:
  /// path: with or without .part. ConfigError where there is no run.
  explicit RunFile(const std::string& path);
  /// The path of the whole file, without .part.
  const std::string& path() const { return path_; }
  bool finished() const { return rows_.finished(); }
  std::string record() const { return rows_.record(); }
  Config config() const;
  std::string text(const std::string& name) const { return rows_.text(name); }
  const RowFileReader& table() const { return rows_; }
  /// A text of texts_of_files, by path. ConfigError where it is not there.
  std::string file(const std::string& path) const;

  /// The last checkpoint that is whole with the rows before it: its state, what came before it
  /// piece by piece, and how many rows; 0 where there is none. Reads these rows.
  struct Kept {
    std::string state;
    std::vector<std::string> news;
    std::size_t rows = 0;
  };
  Kept kept() const;

 private:
  std::string path_;
  RowFileReader rows_;
};

/// The rows of a finished file, thinned to at most so many, by the names of its system where it is
/// given. ConfigError where they are not those that were written.
Trajectory read_rows(const RunFile& file, std::size_t most, const SystemModel* system = nullptr);

/// The run of a record as it was run: system, parameters, start and every option that was used.
/// ConfigError, with the place, where it is none.
Config recorded_config(const std::string& record, const std::string& origin);

/// The contents of a record, into a Result that has its system and config. ConfigError, with the
/// place, where it is none.
void read_record(const std::string& record, const std::string& origin, Result& out);

/// The key of an option in a record: its "events" are those that occurred, its "start" is whole.
inline std::string key_in_record(const Option& option) {
  const std::string name = option.name;
  return name == "events" ? "watched" : name == "start" ? "start_values" : name;
}

}  // namespace hamel
