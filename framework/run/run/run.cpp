#include <hamel/framework/run/run/run.hpp>

#include <utility>

#include <hamel/framework/run/run/driver.hpp>

namespace hamel {

Run::Run(std::unique_ptr<Driver> driver) : driver_(std::move(driver)) {}
Run::Run(Run&&) noexcept = default;
Run& Run::operator=(Run&&) noexcept = default;
Run::~Run() = default;

Status Run::step(long count) { return driver_->step(count); }
Status Run::step_towards(double t) { return driver_->step_towards(t); }
Status Run::advance_to(double t) { return driver_->advance_to(t); }
Status Run::complete() { return driver_->complete(); }
void Run::turn_back() { driver_->turn_back(); }
void Run::input(const std::string& name, double value) { driver_->input(name, value); }
void Run::restart(const Start& start) { driver_->restart(start); }
const Snapshot& Run::at(double t) { return driver_->at(t); }
const Snapshot& Run::state() { return driver_->state(); }
double Run::time() { return driver_->time(); }
const std::vector<EventMet>& Run::events() const { return driver_->events(); }
bool Run::over() const { return driver_->over(); }
const SolverStats& Run::stats() const { return driver_->stats(); }
const Config& Run::config() const { return driver_->plan().config; }
const SystemModel& Run::system() const { return *driver_->plan().system; }
const std::vector<std::string>& Run::notes() const { return driver_->plan().notes; }
const std::shared_ptr<Inputs>& Run::inputs() const { return driver_->plan().setup.inputs; }

Result Run::finish() {
  Result& result = driver_->end();
  driver_->close();
  return std::move(result);
}

}  // namespace hamel
