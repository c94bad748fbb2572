#include <hamel/framework/run/run/rows/logged_rows.hpp>

#include <chrono>
#include <utility>

namespace hamel {

LoggedRows::LoggedRows(std::shared_ptr<const SystemModel> system,
                       std::shared_ptr<RunRecorder> recorder, KernelFactory factory,
                       KernelSetup setup, std::size_t most)
    : system_(std::move(system)),
      recorder_(std::move(recorder)),
      factory_(std::move(factory)),
      setup_(std::move(setup)),
      most_(most) {}

Kernel& LoggedRows::kernel() {
  if (kernel_ == nullptr) kernel_ = factory_(setup_);
  return *kernel_;
}

bool LoggedRows::latest(Snapshot& out) {
  if (log.size() == 0) return false;
  kernel().measure(log.state(log.size() - 1), out, {});
  return true;
}

void LoggedRows::bound() {
  constexpr std::size_t most = std::size_t{1} << 22;
  if (most_ == 0 || log.numbers.size() < most) return;
  take();
  // The latest stays: a run that fails ends there.
  log.numbers.erase(log.numbers.begin(),
                    log.numbers.end() - static_cast<std::ptrdiff_t>(log.width));
  first_ = 1;
}

void LoggedRows::deliver() {
  sink_->rows(recorder_->rows());
  recorder_->drop_rows();
}

void LoggedRows::take() {
  const auto begin = std::chrono::steady_clock::now();
  if (sink_ == nullptr) {
    sink_ = make_memory_sink(rows_, most_);
    sink_->begin({recorder_->columns(), "", "", ""});
  }
  constexpr std::size_t piece = 4096;
  Snapshot state;
  for (std::size_t i = first_; i < log.size(); ++i) {
    kernel().measure(log.state(i), state, {});
    recorder_->take(state);
    recorder_->compare(state);
    if (i % piece == 0) deliver();
  }
  deliver();
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void LoggedRows::read(Result& out) {
  std::call_once(taken_, [&] {
    take();
    recorder_->finish(last);
    deliver();
    sink_->finish(out);
    log = {};
    kernel_.reset();
  });
  out.trajectory = rows_;
  static_cast<Measurements&>(out) = recorder_->all();
  out.notes.insert(out.notes.end(), recorder_->notes().begin(), recorder_->notes().end());
  out.comparing_seconds = seconds_;
  if (then) then(out);
}

}  // namespace hamel
