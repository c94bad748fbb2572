// A study as pieces of the engine (batch/engine.hpp): references, cells and rounds of timings, each
// of which becomes a line of the journal. The yield of a piece depends on its system or cell alone,
// so the number of threads changes nothing but the times.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <hamel/framework/batch/engine.hpp>
#include <hamel/framework/study/journal.hpp>

namespace hamel::study {

class Runner : public Engine {
 public:
  /// result: with all cells, and nothing measured.
  Runner(const Registry& registry, const BatchSettings& settings, StudyResult& result);

 private:
  enum class Kind { reference, measure, time };
  // A piece by its number: references first, then cells, then timings.
  struct Work {
    Kind kind;
    size_t index;  // of the system, or of the cell
    size_t round = 0;
  };
  size_t number_of(const Work& work) const;
  Work work_of(size_t number) const;

  JournalSubject subject() const override;
  void take(const std::string& line) override;
  std::string lacks(const Shard& part) const override;
  Pieces pieces() const override;
  Worker worker() override;
  void finish() override;

  bool does(const Work& work, const Counted& counted);
  bool make_reference(size_t system, const Counted& counted);
  bool measure(size_t cell);
  bool time(size_t cell, size_t round);

  const Registry& registry_;
  StudyResult& result_;
  std::vector<Shape> shapes_;
  std::mutex mutex_;  // of the metrics
};

}  // namespace hamel::study
