// Progress on a terminal while one waits.
#include <unistd.h>

#include <cmath>
#include <condition_variable>
#include <mutex>

#include <fmt/format.h>

#include "commands.hpp"
#include "words/screen.hpp"

namespace hamel::tools {
namespace {

bool on_terminal() { return isatty(STDERR_FILENO) == 1; }
void clear_line() { write_message(fmt::format("\r{:70}\r", "")); }

}  // namespace

Elapsed::Elapsed(std::string what) {
  if (!on_terminal()) return;
  ticker_ = std::jthread([what = visible(what)](const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any changed;
    std::unique_lock lock(mutex);
    for (int seconds = 1;; ++seconds) {
      changed.wait_for(lock, stop, std::chrono::seconds(1), [] { return false; });
      if (stop.stop_requested()) break;
      write_message(fmt::format("\r{:<70}", fmt::format("{}: {} s", what, seconds)));
    }
    clear_line();
  });
}
Elapsed::~Elapsed() = default;

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), active_(!quiet && on_terminal()) {}
Progress::~Progress() {
  if (active_) clear_line();
}
void Progress::operator()(double fraction) {
  if (!active_) return;
  const auto now = std::chrono::steady_clock::now();
  if (first_ < 0) {
    first_ = fraction;
    begin_ = now;
  } else if (now - shown_ < std::chrono::milliseconds(100)) {
    return;
  }
  shown_ = now;
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  std::string left;
  if (fraction > first_ && seconds > 0.3) {
    const long rest = std::lround(seconds * (1 - fraction) / (fraction - first_));
    left = rest < 60 ? fmt::format(", {} s left", rest)
                     : fmt::format(", {} min {:02} s left", rest / 60, rest % 60);
  }
  const int filled = static_cast<int>(30 * fraction);
  const std::string bar = fmt::format("{} [{:=<{}}{:{}}] {:3.0f}%{}", visible(what_), "", filled,
                                      "", 30 - filled, 100 * fraction, left);
  write_message(fmt::format("\r{:<70}", bar));
}

}  // namespace hamel::tools
