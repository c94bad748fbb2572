// The engine of many runs: threads take pieces of work, each finished piece becomes a line of the
// journal, an interrupted session resumes from these lines, and shards are joined from theirs. A
// study and an ensemble implement the functions in the middle. Their results depend neither on the
// thread nor on the order in which pieces finish. Not installed.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <queue>
#include <string>
#include <vector>

#include <hamel/framework/batch/batch.hpp>
#include <hamel/framework/batch/journal_file.hpp>
#include <hamel/framework/batch/shards.hpp>

namespace hamel {

class Engine {
 public:
  /// Both outlive it. The time of the session begins here.
  Engine(const BatchSettings& settings, BatchResult& result)
      : settings_(settings), result_(result) {}
  virtual ~Engine() = default;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Does what the journal has not yet, and throws what a piece of work has thrown. ConfigError
  /// before anything runs: a folder that cannot be written, the journal of something else.
  void run();
  /// Joins the shards in the folder. ConfigError where some are missing or incomplete, or are of
  /// something else.
  void merge();

 protected:
  static constexpr size_t kNone = static_cast<size_t>(-1);
  struct Piece {
    size_t number;         // of the derived class, for its worker
    long share = 1;        // of the progress
    size_t after = kNone;  // index in the list of a piece that has to be finished before
  };
  struct Pieces {
    std::vector<Piece> left;  // the first one that is ready is taken
    long all = 0;             // shares of all pieces, finished ones too
    size_t resumed = 0;
  };
  /// Does a piece; false: stopped on the way. counted(share) reports a part of it as done.
  using Counted = std::function<void(long)>;
  using Worker = std::function<bool(size_t number, const Counted& counted)>;

  /// Appends line() to the journal where there is one, from any thread.
  template <class Line>
  void keep(const Line& line) {
    if (journal_) journal_->append(line());
  }
  const std::atomic<bool>* stop() const { return settings_.stop; }
  bool stopped() const { return settings_.stop != nullptr && settings_.stop->load(); }

 private:
  virtual JournalSubject subject() const = 0;
  /// The line of a journal becomes part of the result; an exception where it does not fit.
  virtual void take(const std::string& line) = 0;
  /// "" or what a part has not: "3 of 7 members".
  virtual std::string lacks(const Shard& part) const = 0;
  /// The pieces that the lines have not, listed once, after the last line.
  virtual Pieces pieces() const = 0;
  /// Made for each thread, in that thread.
  virtual Worker worker() = 0;
  /// Derives from all pieces what depends on several of them; also after a stop.
  virtual void finish() = 0;

  int threads() const;
  void list();
  void start_threads();
  void work();
  std::optional<size_t> next();
  void done(size_t piece, bool good);
  void fail();
  void count(long share);
  void add_notes(const std::vector<std::string>& notes);
  void end(bool complete);

  const BatchSettings& settings_;
  BatchResult& result_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::optional<JournalFile> journal_;

  std::mutex mutex_;  // of the following six
  std::condition_variable changed_;
  std::priority_queue<size_t, std::vector<size_t>, std::greater<>> ready_;
  std::map<size_t, std::vector<size_t>> waiting_;  // by the piece that they wait for
  size_t in_flight_ = 0;
  std::exception_ptr failure_;

  std::vector<Piece> pieces_;
  std::mutex reporting_;
  long all_ = 0;
  std::atomic<long> finished_ = 0;
};

}  // namespace hamel
