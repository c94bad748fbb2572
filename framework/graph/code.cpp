#include <hamel/framework/graph/code.hpp>

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include <hamel/framework/graph/interpret.hpp>
#include <hamel/framework/graph/machine_x86.hpp>

namespace hamel::graph {
namespace {

bool is_switched_off() {
  static const bool off = std::getenv("HAMEL_NO_MACHINE_CODE") != nullptr;
  return off;
}

}  // namespace

struct Code::Insides {
  Insides(std::shared_ptr<const Program> of, int lanes, Machine allowed)
      : program(std::move(of)), width(lanes) {
    if (allowed == Machine::allowed && !is_switched_off()) {
      machine = MachineCode::make(*program, width);
    }
    if (!machine || machine->has_angles()) work_size = Interpreter::work_size(*program, width);
    if (machine) work_size = std::max(work_size, machine->work_size());
  }
  const Interpreter& interpreter() const {  // of machine code: made when an angle is too large
    std::call_once(once, [this] { made.emplace(*program); });
    return *made;
  }
  std::shared_ptr<const Program> program;
  int width;
  std::unique_ptr<const MachineCode> machine;
  size_t work_size = 0;

 private:
  mutable std::once_flag once;
  mutable std::optional<Interpreter> made;
};

Code::Code(std::shared_ptr<const Program> program, int width, Machine machine) {
  if (!program) throw std::invalid_argument("graph::Code: no program");
  if (width != 1 && width != 4 && width != 8) {
    throw std::invalid_argument("graph::Code: a width of 1, 4 or 8, not " + std::to_string(width));
  }
  insides_ = std::make_shared<const Insides>(std::move(program), width, machine);
  if (!insides_->machine) (void)insides_->interpreter();
}
Code::~Code() = default;
Code::Code(const Code&) = default;
Code::Code(Code&&) noexcept = default;
Code& Code::operator=(const Code&) = default;
Code& Code::operator=(Code&&) noexcept = default;

const Program& Code::program() const { return *insides_->program; }
int Code::width() const { return insides_->width; }
bool Code::is_machine_code() const { return insides_->machine != nullptr; }
size_t Code::work_size() const { return insides_->work_size; }

void Code::operator()(const double* x, double* y, double* work) const {
  const Insides& i = *insides_;
  if (i.machine && i.machine->run(x, y, work)) return;
  i.interpreter().run(i.width, x, y, work);
}

std::string machine_code_refused() {
  if (is_switched_off()) return "HAMEL_NO_MACHINE_CODE is set";
  if (std::string reason = machine_code_refusal(); !reason.empty()) return reason;
  const Program empty(Recording(), {});
  return MachineCode::make(empty, 1) ? "" : "the system refuses executable memory";
}

}  // namespace hamel::graph
