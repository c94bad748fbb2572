// Settings and outcome of work in many pieces: threads, the folder of its journal, shards,
// progress, stop. Studies and ensembles have these in common.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/batch/shard.hpp>

namespace hamel {

struct BatchSettings {
  int threads = 0;
  std::string folder = {};
  Shard shard = {};
  bool fresh = false;
  std::function<void(double)> progress = {};
  const std::atomic<bool>* stop = nullptr;
};

/// The calls by which a Study or an Ensemble receives them.
template <class Work>
class Batch {
 public:
  /// Number of threads; 0: as many as there are cores.
  Work& threads(int count) { return set(&BatchSettings::threads, count); }
  /// Keeps a journal there and resumes from an existing one.
  Work& folder(std::string path) { return set(&BatchSettings::folder, std::move(path)); }
  /// Runs a part alone, whose journal merge() reads. ConfigError where it is none.
  Work& shard(Shard part) { return set(&BatchSettings::shard, checked(part)); }
  /// Forgets the journal that is there.
  Work& fresh(bool forget = true) { return set(&BatchSettings::fresh, forget); }
  /// Called now and then, from one thread at a time, with the fraction of the work done.
  Work& progress(std::function<void(double)> report) {
    return set(&BatchSettings::progress, std::move(report));
  }
  /// Polled within each piece of work: true abandons what is in flight and returns.
  Work& stop(const std::atomic<bool>* flag) { return set(&BatchSettings::stop, flag); }

 protected:
  BatchSettings settings_;

 private:
  template <class Value>
  Work& set(Value BatchSettings::*setting, Value value) {
    settings_.*setting = std::move(value);
    return static_cast<Work&>(*this);
  }
};

struct BatchResult {
  std::vector<std::string> notes;  // lines of the journal that were damaged, and others
  bool complete = false;
  size_t resumed = 0;  // cells or members taken over from the journal
  Shard shard;         // the part that was run
  long shards = 1;     // that were merged
  int threads = 1;
  double seconds = 0;  // of this session
};

}  // namespace hamel
