#include <hamel/framework/batch/engine.hpp>

#include <algorithm>
#include <thread>
#include <utility>

#include <hamel/framework/io/errors.hpp>

namespace hamel {

void Engine::run() {
  const Shard& part = settings_.shard;
  if (part.count > 1 && settings_.folder.empty())
    throw ConfigError({"shard: a part needs a folder for its journal"});
  if (!settings_.folder.empty()) {
    journal_.emplace(settings_.folder, journal_name(part), subject_of_part(subject(), part),
                     settings_.fresh);
    add_notes(journal_->read([&](const std::string& line) { take(line); }));
  }
  list();
  count(0);
  start_threads();
  end(lacks(part).empty());
}

void Engine::merge() {
  result_.shards = shards_in(settings_.folder);
  add_notes(join_shards(
      settings_.folder, result_.shards, subject(), [&](const std::string& line) { take(line); },
      [&](const Shard& part) { return lacks(part); }));
  end(true);
}

void Engine::add_notes(const std::vector<std::string>& notes) {
  result_.notes.insert(result_.notes.end(), notes.begin(), notes.end());
}

void Engine::end(bool complete) {
  result_.complete = complete;
  result_.threads = threads();
  finish();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begun_;
  result_.seconds = seconds.count();
}

int Engine::threads() const {
  if (settings_.threads > 0) return settings_.threads;
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void Engine::list() {
  Pieces given = pieces();
  pieces_ = std::move(given.left);
  result_.resumed = given.resumed;
  all_ = given.all;
  long left = 0;
  for (size_t i = 0; i < pieces_.size(); ++i) {
    left += pieces_[i].share;
    if (pieces_[i].after == kNone) ready_.push(i);
    else waiting_[pieces_[i].after].push_back(i);
  }
  finished_ = all_ - left;
}

void Engine::start_threads() {
  {
    std::vector<std::jthread> all;
    for (int i = 0; i < threads(); ++i) {
      all.emplace_back([this] {
        try {
          work();
        } catch (...) {
          fail();
        }
      });
    }
  }  // joins
  if (failure_) std::rethrow_exception(failure_);
}

void Engine::work() {
  const Worker worker = this->worker();
  while (const auto at = next()) {
    const Piece& piece = pieces_[*at];
    long left = piece.share;  // an estimate: no more than these are counted
    const auto counted = [&](long share) {
      const long part = std::min(share, left);
      left -= part;
      count(part);
    };
    bool good = false;
    try {
      good = worker(piece.number, counted);
    } catch (...) {
      fail();
    }
    if (good) counted(left);
    done(*at, good);
  }
}

// Nothing: no more, or stopped.
std::optional<size_t> Engine::next() {
  std::unique_lock lock(mutex_);
  while (!stopped() && !failure_) {
    if (!ready_.empty()) {
      const size_t out = ready_.top();
      ready_.pop();
      ++in_flight_;
      return out;
    }
    if (in_flight_ == 0) break;
    changed_.wait(lock);
  }
  return {};
}

void Engine::done(size_t piece, bool good) {
  const std::lock_guard lock(mutex_);
  --in_flight_;
  if (const auto held = waiting_.find(piece); good && held != waiting_.end())
    for (const size_t next : held->second) ready_.push(next);
  changed_.notify_all();
}

void Engine::fail() {
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = std::current_exception();
}

void Engine::count(long share) {
  finished_ += share;
  const std::unique_lock lock(reporting_, std::try_to_lock);
  if (settings_.progress && lock)
    settings_.progress(static_cast<double>(finished_) / static_cast<double>(std::max(all_, 1L)));
}

}  // namespace hamel
