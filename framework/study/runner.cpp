#include <hamel/framework/study/runner.hpp>

#include <algorithm>
#include <utility>

#include <hamel/framework/study/parts.hpp>

namespace hamel::study {

Runner::Runner(const Registry& registry, StudyResult& result, Journal* journal,
               std::function<void(double)> progress, const std::atomic<bool>* stop)
    : registry_(registry),
      result_(result),
      journal_(journal),
      progress_(std::move(progress)),
      stop_(stop) {}

// The pieces that the result has not yet, and what part of all steps is done.
void Runner::list() {
  const auto rounds = static_cast<size_t>(result_.config.repeats);
  references_.clear();
  ready_.clear();
  timings_.clear();
  waiting_.assign(result_.config.systems.size(), {});
  std::vector<bool> used(waiting_.size());
  long left = 0;
  all_ = 0;
  for (size_t i = 0; i < result_.cells.size(); ++i) {
    const StudyCell& cell = result_.cells[i];
    if (!result_.runs(i)) continue;
    all_ += static_cast<long>(rounds + 1) * expected_steps(cell.config());
    const bool there = !result_.references[cell.system].times.empty();
    if (!used[cell.system]) {
      used[cell.system] = true;
      const long steps = steps_of_reference(cell.system);
      all_ += steps;
      if (!there) {
        references_.push_back({Kind::reference, cell.system});
        left += steps;
      }
    }
    if (result_.metrics[i].done) continue;
    (there ? ready_ : waiting_[cell.system]).push_back({Kind::measure, i});
    left += expected_steps(cell.config());
  }
  for (size_t round = 0; round < rounds; ++round) {
    for (size_t i = 0; i < result_.cells.size(); ++i) {
      if (!result_.runs(i) || result_.metrics[i].nanoseconds[round] != kPending) continue;
      timings_.push_back({Kind::time, i, round});
      left += expected_steps(result_.cells[i].config());
    }
  }
  finished_ = all_ - left;
}

bool Runner::complete() const {
  for (size_t i = 0; i < result_.cells.size(); ++i)
    if (result_.runs(i) && !finished_cell(result_, i)) return false;
  return true;
}

void Runner::run() {
  list();
  finished(0);
  workers_.run(result_.threads, [this](int) { work(); });
}

// References first, then cells whose reference is there, then timings. Nothing: no more, or
// stopped.
std::optional<Runner::Piece> Runner::next() {
  std::unique_lock lock(mutex_);
  while (!stopped(stop_) && !workers_.failed()) {
    for (auto* queue : {&references_, &ready_, &timings_}) {
      if (queue->empty()) continue;
      const Piece piece = queue->front();
      queue->pop_front();
      if (piece.kind == Kind::reference) ++in_flight_;
      return piece;
    }
    if (in_flight_ == 0) break;
    changed_.wait(lock);
  }
  return {};
}

void Runner::work() {
  while (const auto piece = next()) {
    bool good = false;
    try {
      good = done(*piece);
    } catch (...) {
      workers_.fail(std::current_exception());
    }
    if (piece->kind == Kind::reference) {
      const std::lock_guard lock(mutex_);
      --in_flight_;
      if (good)
        ready_.insert(ready_.end(), waiting_[piece->index].begin(), waiting_[piece->index].end());
      changed_.notify_all();
    }
    if (!good) return;
  }
}

long Runner::steps_of_reference(size_t system) const {
  return reference_steps(registry_, result_.config, result_.config.systems[system]);
}

// False: stopped on the way.
bool Runner::done(const Piece& piece) {
  if (piece.kind == Kind::reference) return make_reference(piece.index);
  if (!(piece.kind == Kind::measure ? measure(piece.index) : time(piece.index, piece.round)))
    return false;
  finished(expected_steps(result_.cells[piece.index].config()));
  return true;
}

bool Runner::make_reference(size_t system) {
  const auto cell = std::find_if(
      result_.cells.begin(), result_.cells.end(),
      [&](const StudyCell& candidate) { return candidate.runs() && candidate.system == system; });
  long left = steps_of_reference(system);  // an estimate: no more than these are counted
  const auto stepped = [&](long steps) {
    finished(std::min(steps, left));
    left -= std::min(steps, left);
  };
  StudyReference made = study::reference(registry_, result_.config, result_.config.systems[system],
                                         cell->config(), stepped, stop_);
  if (made.times.empty()) return false;
  if (journal_ != nullptr) journal_->referred(system, made);
  finished(left);
  result_.references[system] = std::move(made);  // not read before work() publishes it
  return true;
}

bool Runner::measure(size_t cell) {
  const size_t system = result_.cells[cell].system;
  StudyMetrics measured = study::measure(registry_, result_.config.systems[system],
                                         result_.cells[cell], result_.references[system], stop_);
  if (!measured.done) return false;
  if (journal_ != nullptr) journal_->measured(cell, measured);
  const std::lock_guard lock(mutex_);  // the cell may be timed at the same time
  StudyMetrics& mine = result_.metrics[cell];
  measured.nanoseconds = std::move(mine.nanoseconds);
  mine = std::move(measured);
  return true;
}

bool Runner::time(size_t cell, size_t round) {
  const double ns = time_per_step(registry_, result_.config.systems[result_.cells[cell].system],
                                  result_.cells[cell], stop_);
  if (stopped(stop_)) return false;
  if (journal_ != nullptr) journal_->timed(cell, round, ns);
  const std::lock_guard lock(mutex_);
  result_.metrics[cell].nanoseconds[round] = ns;
  return true;
}

void Runner::finished(long steps) {
  finished_ += steps;
  const std::unique_lock lock(reporting_, std::try_to_lock);
  if (progress_ && lock)
    progress_(static_cast<double>(finished_) / static_cast<double>(std::max(all_, 1L)));
}

}  // namespace hamel::study
