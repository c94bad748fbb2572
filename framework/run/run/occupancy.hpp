// Occupancy of a run: the thread that is in it now, and whether its Run is still there.
//
// A run belongs to one caller at a time. Its driver is in the middle of a step while it calls the
// user's functions (observer, impact, progress), and in no state of its own while another thread
// steps it. Both are mistakes of a program, std::logic_error that names the member. Two threads are
// seen where their calls overlap in time as one of them enters; a mutex of the caller's own is the
// remedy. The fields are atomic, so that the check itself is no data race, and relaxed, so that a
// step pays two plain stores. Not installed: the insides of Run.
#pragma once

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>

namespace hamel {

class Occupancy {
 public:
  /// A call that changes the run begins.
  void enter(const char* member) {
    if (owner() != std::thread::id()) refuse(member);
    owner_.store(std::this_thread::get_id(), std::memory_order_relaxed);
    moved_.store(false, std::memory_order_relaxed);
  }
  /// It ends. True: the Run is gone, and its driver is the caller's to delete.
  bool leave() {
    owner_.store(std::thread::id(), std::memory_order_relaxed);
    return abandoned_.load(std::memory_order_relaxed);
  }
  /// A call that leaves the steps alone: also from within, but from the same thread.
  void look(const char* member) const {
    const std::thread::id now = owner();
    if (now != std::thread::id() && now != std::this_thread::get_id()) refuse(member);
  }
  /// The Run of a driver goes. True: in the middle of a call, whose leave() then returns true.
  bool abandon() {
    if (owner() == std::thread::id()) return false;
    abandoned_.store(true, std::memory_order_relaxed);
    return true;
  }
  /// The Run of a driver is moved.
  void move() { moved_.store(owner() != std::thread::id(), std::memory_order_relaxed); }
  /// Behind each call of a user's function.
  void require_run() const {
    if (moved_.load(std::memory_order_relaxed) || abandoned_.load(std::memory_order_relaxed))
      throw std::logic_error(
          "Run: one of its own functions (observer, impact, progress) moved or destroyed it during "
          "a step");
  }

 private:
  std::thread::id owner() const { return owner_.load(std::memory_order_relaxed); }
  [[noreturn]] void refuse(const char* member) const {
    throw std::logic_error(
        std::string("Run::") + member +
        (owner() == std::this_thread::get_id()
             ? ": called by one of its own functions (observer, impact, progress) during a step; "
               "an "
               "observer ends a run by returning false, and an impact changes its state"
             : ": two threads use this run at once; one at a time may"));
  }

  std::atomic<std::thread::id> owner_ = {};
  std::atomic<bool> moved_ = false, abandoned_ = false;
};

}  // namespace hamel
