// Threads that share a piece of work: the first thing that one of them throws is thrown to the
// caller, after all have ended. Not installed.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace hamel {

class Workers {
 public:
  /// work(i) for i < count, each in a thread of its own, and waits for all. Each ends early where
  /// failed() has become true.
  void run(int count, const std::function<void(int)>& work) {
    {
      std::vector<std::jthread> threads;
      for (int i = 0; i < count; ++i) {
        threads.emplace_back([this, &work, i] {
          try {
            work(i);
          } catch (...) {
            fail(std::current_exception());
          }
        });
      }
    }  // joins
    if (failure_) std::rethrow_exception(failure_);
  }
  bool failed() const { return failed_; }
  void fail(std::exception_ptr what) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(what);
    failed_ = true;
  }

 private:
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::atomic<bool> failed_ = false;
};

/// As many as requested, or as there are cores.
inline int threads_or_cores(int requested) {
  if (requested > 0) return requested;
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

}  // namespace hamel
