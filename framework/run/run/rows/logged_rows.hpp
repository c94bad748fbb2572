// Rows of a run that are states alone (StateLog) until they are read: a kernel of the same problem
// then measures each, and the recorder of the run makes its columns, as if it had been there. Not
// installed.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>

#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/record/result.hpp>
#include <hamel/framework/run/record/sink.hpp>
#include <hamel/framework/run/run/rows/run_recorder.hpp>

namespace hamel {

class LoggedRows final : public UnreadRows {
 public:
  /// recorder: begun, without a row. most: of make_memory_sink.
  LoggedRows(std::shared_ptr<const SystemModel> system, std::shared_ptr<RunRecorder> recorder,
             KernelFactory factory, KernelSetup setup, std::size_t most);
  StateLog log;
  Snapshot last;                      // of the run
  std::function<void(Result&)> then;  // notes by what was measured
  /// The logged state before the present one; false where there is none.
  bool latest(Snapshot& out);
  /// Where few rows are kept, the log does not grow beyond 32 MB.
  void bound();
  void read(Result& out) override;

 private:
  Kernel& kernel();
  void take();
  void deliver();

  std::shared_ptr<const SystemModel> system_;
  std::shared_ptr<RunRecorder> recorder_;
  KernelFactory factory_;
  KernelSetup setup_;
  std::size_t most_, first_ = 0;  // first: that was not taken
  std::unique_ptr<Kernel> kernel_;
  std::unique_ptr<Sink> sink_;
  Trajectory rows_;
  double seconds_ = 0;
  std::once_flag taken_;
};

}  // namespace hamel
