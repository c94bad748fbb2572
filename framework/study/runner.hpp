// The threads of a study: references, cells and rounds of timings, each piece of work taken by the
// next thread that is free. The yield of a piece depends on its system or cell alone, so the number
// of threads changes nothing but the times.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include <hamel/framework/batch/workers.hpp>
#include <hamel/framework/study/journal.hpp>

namespace hamel::study {

class Runner {
 public:
  /// journal: null for none.
  Runner(const Registry& registry, StudyResult& result, Journal* journal,
         std::function<void(double)> progress, const std::atomic<bool>* stop);

  /// Does what the result has not yet; what a piece threw is thrown here.
  void run();
  /// Whether nothing is left to do.
  bool complete() const;

 private:
  enum class Kind { reference, measure, time };
  struct Piece {
    Kind kind;
    size_t index;  // of the system, or of the cell
    size_t round = 0;
  };

  void list();
  std::optional<Piece> next();
  void work();
  bool done(const Piece& piece);
  long steps_of_reference(size_t system) const;
  bool make_reference(size_t system);
  bool measure(size_t cell);
  bool time(size_t cell, size_t round);
  void finished(long steps);

  const Registry& registry_;
  StudyResult& result_;
  Journal* journal_;
  std::function<void(double)> progress_;
  const std::atomic<bool>* stop_;

  std::mutex mutex_;  // of the queues and of the results
  std::condition_variable changed_;
  std::deque<Piece> references_, ready_, timings_;
  std::vector<std::deque<Piece>> waiting_;  // cells of each system whose reference is not there
  size_t in_flight_ = 0;                    // references
  Workers workers_;

  std::mutex reporting_;
  long all_ = 0;
  std::atomic<long> finished_ = 0;
};

}  // namespace hamel::study
