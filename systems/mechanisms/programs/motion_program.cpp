// The accelerations of a mechanism in a frame found by elimination (mechanism_programs.hpp).
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <hamel/framework/graph/elimination.hpp>
#include <hamel/systems/mechanisms/programs/recorded_mechanism.hpp>

namespace hamel::mechanisms {
namespace {

using Numbers = std::vector<Number>;

constexpr double kLostPivot = 0.1;  // of its first value

Number product(const Numbers& a, const Numbers& b) {
  Number out = 0;
  for (size_t i = 0; i < a.size(); ++i) out += a[i] * b[i];
  return out;
}

}  // namespace

std::vector<std::vector<double>> states_near(const MechanismParts& parts,
                                             std::span<const double> state) {
  const Geometry& geometry = parts.geometry;
  const auto size = static_cast<size_t>(geometry.size()), n = static_cast<size_t>(geometry.dim());
  std::vector<std::vector<double>> out{{state.begin(), state.end()}};
  for (const double side : {0.1, -0.1}) {
    std::vector<double> eta(n), moved(size), there(state.begin(), state.end());
    for (size_t i = 0; i < n; ++i) eta[i] = side * std::sin(2.0 * static_cast<double>(i) + 1);
    geometry.tau(eta.data(), moved.data());
    geometry.compose(state.data(), moved.data(), there.data());
    parts.find_coupled(there);
    out.push_back(std::move(there));
  }
  return out;
}

Frame find_frame(const MechanismParts& parts, const RecordedMechanism& mechanism,
                 std::span<const double> state, std::vector<Number> c) {
  if (mechanism.rows.empty()) return graph::free_frame(mechanism.xi.size());
  std::vector<Numbers> a;
  for (const RecordedRow& row : mechanism.rows) a.push_back(row.coefficients);
  std::vector<Sample> samples;
  for (std::vector<double>& place : states_near(parts, state))
    samples.emplace_back(std::move(place));
  return eliminate(std::move(a), std::move(c), samples);
}

std::shared_ptr<const graph::Program> MotionProgram::record(const MechanismParts& parts,
                                                            std::span<const double> state) {
  const RecordedMechanism mechanism(parts);
  const Frame frame = find_frame(parts, mechanism, state, mechanism.row_rates());
  const size_t n = mechanism.xi.size(), m = frame.independent.size();
  const BodyFormulas::Matrix inertia = mechanism.bodies.inertia();
  std::vector<Numbers> columns(m, Numbers(n)), momenta(m, Numbers(n));  // of E, I E
  for (size_t j = 0; j < m; ++j) {
    for (size_t i = 0; i < n; ++i) columns[j][i] = frame.e[i][j];
    for (size_t i = 0; i < n; ++i) momenta[j][i] = product(inertia[i], columns[j]);
  }
  std::vector<Numbers> reduced(m, Numbers(m));
  for (size_t i = 0; i < m; ++i)
    for (size_t j = i; j < m; ++j) reduced[i][j] = reduced[j][i] = product(columns[i], momenta[j]);
  Numbers force = mechanism.bodies.efforts(frame.particular);
  for (Number& x : force) x = -x;
  mechanism.add_spring_forces(force);
  mechanism.add_given_forces(force);
  Numbers y;
  for (const Numbers& along : columns) y.push_back(product(along, force));
  solve_symmetric(std::move(reduced), y);

  graph::Program::Outputs outputs;
  for (size_t i = 0; i < n; ++i)
    outputs.emplace_back("rate" + std::to_string(i + 1),
                         frame.particular[i] + product(frame.e[i], y));
  for (size_t i = 0; i < frame.pivots.size(); ++i)
    outputs.emplace_back("pivot" + std::to_string(i + 1), frame.pivots[i]);
  return std::make_shared<graph::Program>(graph::Recording::current(), outputs);
}

MotionProgram::MotionProgram(const MechanismParts& parts, std::span<const double> state)
    : code_(record(parts, state)),
      results_(code_.program().outputs().size()),
      work_(code_.work_size()) {
  code_(state.data(), results_.data(), work_.data());
  pivots_.assign(results_.begin() + parts.geometry.dim(), results_.end());
}

bool MotionProgram::operator()(const double* state, double* xi_rate) {
  code_(state, results_.data(), work_.data());
  const size_t n = results_.size() - pivots_.size();
  for (size_t i = 0; i < pivots_.size(); ++i)
    if (!(results_[n + i] * pivots_[i] >= kLostPivot * pivots_[i] * pivots_[i])) return false;
  std::copy_n(results_.begin(), n, xi_rate);
  return true;
}

}  // namespace hamel::mechanisms
