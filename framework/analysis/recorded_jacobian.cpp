#include <hamel/framework/analysis/recorded_jacobian.hpp>

#include <algorithm>
#include <memory>
#include <vector>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/framework/graph/substitute.hpp>

namespace hamel {
namespace {

using graph::Number;
using Numbers = std::vector<Number>;

}  // namespace

RecordedJacobian::RecordedJacobian(const MotionFormulas& motion, const std::string& of) {
  graph::Recording recording;
  Numbers inputs;
  for (const std::string& name : motion.recording->inputs())
    inputs.push_back(recording.input(name));
  const auto q = motion.variables.coordinates.size(), n = motion.rates.size();
  const auto slice = [&inputs](size_t first, size_t count) {
    const auto from = inputs.begin() + static_cast<std::ptrdiff_t>(first);
    return Numbers(from, from + static_cast<std::ptrdiff_t>(count));
  };
  const Numbers coordinates = slice(1, q), velocities = slice(1 + q, n);
  const Numbers rates = substituted(*motion.recording, motion.rates, inputs);
  const Numbers moves = substituted(*motion.recording, motion.variables.coordinate_rates, inputs);
  graph::Program::Outputs outputs;
  const auto add = [&](const Numbers& of_inputs, const Numbers& direction) {
    for (const Number& x : graph::along(rates, of_inputs, direction)) outputs.emplace_back("", x);
  };
  const bool by_velocity = of == "velocity", by_configuration = of == "configuration";
  for (size_t j = 0; j < n && (by_velocity || by_configuration); ++j) {
    Numbers unit(n);
    unit[j] = 1;
    if (by_velocity) add(velocities, unit);
    else add(coordinates, graph::along(moves, velocities, unit));
  }
  if (!by_velocity && !by_configuration) {
    const auto& names = motion.recording->inputs();
    const auto input =
        of == "time"
            ? names.begin()
            : std::find(names.begin() + static_cast<std::ptrdiff_t>(1 + q + n), names.end(), of);
    add(slice(static_cast<size_t>(input - names.begin()), 1), {1});
  }
  code_.emplace(std::make_shared<const graph::Program>(recording, outputs));
}

std::vector<double> RecordedJacobian::operator()(const std::vector<double>& at) const {
  std::vector<double> out(code_->program().outputs().size()), work(code_->work_size());
  (*code_)(at.data(), out.data(), work.data());
  return out;
}

}  // namespace hamel
