#include <hamel/framework/run/run/run.hpp>

#include <stdexcept>
#include <string>
#include <utility>

#include <hamel/framework/run/run/driver.hpp>

namespace hamel {
namespace {

Driver& present(const std::unique_ptr<Driver>& driver, const char* member) {
  if (driver == nullptr)
    throw std::logic_error(std::string("Run::") + member + ": this run was moved from");
  return *driver;
}

// Looks at the run, whose steps it leaves alone.
Driver& seen(const std::unique_ptr<Driver>& driver, const char* member) {
  Driver& out = present(driver, member);
  out.occupancy().look(member);
  return out;
}

// A change of the run. It outlives the Run, which one of its functions may destroy.
class Change {
 public:
  Change(const std::unique_ptr<Driver>& driver, const char* member)
      : driver_(present(driver, member)) {
    driver_.occupancy().enter(member);
  }
  ~Change() {
    if (driver_.occupancy().leave()) delete &driver_;
  }
  Change(const Change&) = delete;
  Change& operator=(const Change&) = delete;
  Driver* operator->() { return &driver_; }

 private:
  Driver& driver_;
};

void release(std::unique_ptr<Driver>& driver) {
  if (driver != nullptr && driver->occupancy().abandon()) (void)driver.release();
}

}  // namespace

Run::Run(std::unique_ptr<Driver> driver, std::shared_ptr<const Simulation> of)
    : driver_(std::move(driver)), of_(std::move(of)) {}
Run::Run(Run&& other) noexcept : driver_(std::move(other.driver_)), of_(std::move(other.of_)) {
  if (driver_ != nullptr) driver_->occupancy().move();
}
Run& Run::operator=(Run&& other) noexcept {
  if (this == &other) return *this;
  release(driver_);
  driver_ = std::move(other.driver_);
  of_ = std::move(other.of_);
  if (driver_ != nullptr) driver_->occupancy().move();
  return *this;
}
Run::~Run() { release(driver_); }

Status Run::step(long count) { return Change(driver_, "step")->step(count); }
Status Run::step_towards(double t) { return Change(driver_, "step_towards")->step_towards(t); }
Status Run::advance_to(double t) { return Change(driver_, "advance_to")->advance_to(t); }
Status Run::complete() { return Change(driver_, "complete")->complete(); }
void Run::turn_back() { Change(driver_, "turn_back")->turn_back(); }
void Run::restart(const Start& start) { Change(driver_, "restart")->restart(start); }
Result Run::finish() { return Change(driver_, "finish")->finish(); }

void Run::input(const std::string& name, double value) {
  seen(driver_, "input").input(name, value);
}
const Snapshot& Run::at(double t) { return seen(driver_, "at").at(t); }
const Snapshot& Run::state(const StateParts& parts) { return seen(driver_, "state").state(parts); }
double Run::time() { return seen(driver_, "time").time(); }
const std::vector<EventMet>& Run::events() const { return seen(driver_, "events").events(); }
bool Run::over() const { return seen(driver_, "over").over(); }
const SolverStats& Run::stats() const { return seen(driver_, "stats").stats(); }

const Config& Run::config() const { return driver().plan().config; }
const SystemModel& Run::system() const { return *driver().plan().system; }
const std::vector<std::string>& Run::notes() const { return driver().plan().notes; }
const std::shared_ptr<Inputs>& Run::inputs() const { return driver().plan().setup.inputs; }
Driver& Run::driver() { return present(driver_, "driver"); }
const Driver& Run::driver() const { return present(driver_, "driver"); }

}  // namespace hamel
