// Runs the cells of a study on all cores. The work is a list of independent pieces: each cell measured, then
// rounds of timings over all cells. Threads take the next piece; what a piece yields depends on its cell
// alone, so the number of threads changes nothing but the times.
#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include <hamel/framework/study/journal.hpp>
#include <hamel/framework/study/parts.hpp>

namespace hamel {
namespace {

constexpr double kPending = -1;  // a timing that is still to be taken

struct Piece {
  size_t cell;
  int round;  // -1: measure it
};

// The pieces that `metrics` has not yet, and how much of all steps they are.
std::vector<Piece> pending(const std::vector<StudyCell>& cells,
                           const std::vector<StudyMetrics>& metrics, int repeats) {
  std::vector<Piece> out;
  for (int round = -1; round < repeats; ++round) {
    for (size_t i = 0; i < cells.size(); ++i) {
      if (!cells[i].runs()) continue;
      const StudyMetrics& m = metrics[i];
      if (round < 0 ? !m.done : m.nanoseconds[static_cast<size_t>(round)] == kPending)
        out.push_back({i, round});
    }
  }
  return out;
}

class Runner {
 public:
  Runner(const Registry& registry, StudyResult& result, study::Journal* journal,
         std::function<void(double)> progress, const std::atomic<bool>* stop)
      : registry_(registry),
        result_(result),
        journal_(journal),
        progress_(std::move(progress)),
        stop_(stop) {}

  void run(const std::vector<Piece>& pieces, int threads) {
    const int passes = result_.config.repeats + 1;
    for (const StudyCell& cell : result_.cells)
      if (cell.runs()) all_ += passes * cell.config.steps();
    long left = 0;
    for (const Piece& piece : pieces) left += result_.cells[piece.cell].config.steps();
    finished_ = all_ - left;
    report();
    std::vector<std::jthread> workers;
    for (int i = 0; i < threads; ++i) workers.emplace_back([&] { work(pieces); });
    workers.clear();  // joins
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void work(const std::vector<Piece>& pieces) {
    try {
      for (size_t i = next_++; i < pieces.size() && !study::stopped(stop_) && !failed_;
           i = next_++) {
        if (!(pieces[i].round < 0 ? measure(pieces[i].cell) : time(pieces[i]))) return;
        finished_ += result_.cells[pieces[i].cell].config.steps();
        report();
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failed_ = true;
      if (!failure_) failure_ = std::current_exception();
    }
  }
  // Each piece has its own place in the metrics: no lock.
  bool measure(size_t cell) {
    StudyMetrics& mine = result_.metrics[cell];
    StudyMetrics measured = study::measure(registry_, result_.cells[cell],
                                           result_.references[result_.cells[cell].system], stop_);
    if (!measured.done) return false;
    measured.nanoseconds = mine.nanoseconds;
    mine = std::move(measured);
    if (journal_ != nullptr) journal_->measured(cell, mine);
    return true;
  }
  bool time(const Piece& piece) {
    const double ns = study::time_per_step(registry_, result_.cells[piece.cell], stop_);
    if (study::stopped(stop_)) return false;
    const auto round = static_cast<size_t>(piece.round);
    result_.metrics[piece.cell].nanoseconds[round] = ns;
    if (journal_ != nullptr) journal_->timed(piece.cell, round, ns);
    return true;
  }
  void report() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (progress_ && lock)
      progress_(static_cast<double>(finished_) / static_cast<double>(std::max(all_, 1L)));
  }

  const Registry& registry_;
  StudyResult& result_;
  study::Journal* journal_;
  std::function<void(double)> progress_;
  const std::atomic<bool>* stop_;
  std::atomic<size_t> next_ = 0;
  std::atomic<long> finished_ = 0;
  std::atomic<bool> failed_ = false;
  long all_ = 0;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace

Study::Study(const Registry& registry, StudyConfig config)
    : registry_(&registry), config_(std::move(config)) {
  const std::vector<std::string> mistakes = config_.mistakes(registry);
  if (!mistakes.empty()) throw ConfigError(mistakes);
  cells_ = study_cells(config_, registry);
}

Study& Study::threads(int count) {
  threads_ = count;
  return *this;
}
Study& Study::folder(std::string path) {
  folder_ = std::move(path);
  return *this;
}
Study& Study::fresh(bool forget) {
  fresh_ = forget;
  return *this;
}
Study& Study::progress(std::function<void(double)> report) {
  progress_ = std::move(report);
  return *this;
}
Study& Study::stop(const std::atomic<bool>* flag) {
  stop_ = flag;
  return *this;
}

StudyResult Study::run() const {
  const auto begin = std::chrono::steady_clock::now();
  const auto rounds = static_cast<size_t>(config_.repeats);
  StudyResult result;
  result.config = config_;
  result.cells = cells_;
  result.threads =
      threads_ > 0 ? threads_ : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::unique_ptr<study::Journal> journal;
  result.metrics.resize(cells_.size());
  if (!folder_.empty()) {
    journal = std::make_unique<study::Journal>(folder_, config_, fresh_);
    result.metrics = journal->read(cells_.size(), rounds);
  }
  for (StudyMetrics& m : result.metrics) {
    if (m.done) ++result.resumed;
    m.nanoseconds.resize(rounds, kPending);
  }

  // One reference for each system that is run, whatever was there already.
  const long intervals = study::common_intervals(config_);
  result.references.resize(config_.systems.size());
  for (const StudyCell& cell : cells_) {
    StudyReference& reference = result.references[cell.system];
    if (cell.runs() && reference.times.empty() && !study::stopped(stop_))
      reference = study::reference(*registry_, config_, cell.config, intervals);
  }
  if (!study::stopped(stop_)) {
    Runner runner(*registry_, result, journal.get(), progress_, stop_);
    runner.run(pending(cells_, result.metrics, config_.repeats), result.threads);
  }
  result.complete = pending(cells_, result.metrics, config_.repeats).empty();
  study::compare(config_, cells_, result.references, result.metrics);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace hamel
