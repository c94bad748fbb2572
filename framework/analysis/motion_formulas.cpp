#include <hamel/framework/analysis/motion_formulas.hpp>

#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/graph/elimination.hpp>
#include <hamel/framework/run/data/recorded_formulas.hpp>

namespace hamel {
namespace {

using graph::MotionTerms;
using graph::MotionVariables;
using graph::Number;
using Numbers = std::vector<Number>;

constexpr size_t kMostSolved = 12;  // independent velocities

// The state, and places to either side of it: entries that vanish at one of them are no pivots.
std::vector<graph::Sample> samples_near(const Geometry& geometry, const std::vector<double>& g,
                                        const std::vector<double>& velocity, size_t inputs) {
  std::vector<graph::Sample> out;
  for (const double side : {0.0, 0.1, -0.1}) {
    std::vector<double> eta(velocity.size()), moved(g.size()), values = {0};
    for (size_t i = 0; i < eta.size(); ++i)
      eta[i] = side * std::sin(2.0 * static_cast<double>(i) + 1);
    geometry.tau(eta.data(), moved.data());
    geometry.compose(g.data(), moved.data(), moved.data());
    values.resize(1 + static_cast<size_t>(geometry.columns()));
    geometry.coordinates(moved.data(), values.data() + 1);
    values.insert(values.end(), velocity.begin(), velocity.end());
    values.resize(values.size() + inputs);
    out.emplace_back(std::move(values));
  }
  return out;
}

Number product(const Numbers& a, const Numbers& b) {
  Number out = 0;
  for (size_t i = 0; i < a.size(); ++i) out += a[i] * b[i];
  return out;
}

// xi' of the equations in a frame.
Numbers solve_in_frame(const MotionTerms& terms, const graph::Frame& frame) {
  const size_t n = terms.change.size(), m = frame.independent.size();
  std::vector<Numbers> columns(m, Numbers(n)), momenta(m, Numbers(n));  // of E, I E
  for (size_t j = 0; j < m; ++j) {
    for (size_t i = 0; i < n; ++i) columns[j][i] = frame.e[i][j];
    for (size_t i = 0; i < n; ++i) momenta[j][i] = product(terms.inertia[i], columns[j]);
  }
  std::vector<Numbers> reduced(m, Numbers(m));
  for (size_t i = 0; i < m; ++i)
    for (size_t j = i; j < m; ++j) reduced[i][j] = reduced[j][i] = product(columns[i], momenta[j]);
  Numbers force = terms.change, y;
  for (size_t i = 0; i < n; ++i) force[i] -= product(terms.inertia[i], frame.particular);
  for (const Numbers& along : columns) y.push_back(product(along, force));
  solve_symmetric(std::move(reduced), y);
  Numbers out;
  for (size_t i = 0; i < n; ++i) out.push_back(frame.particular[i] + product(frame.e[i], y));
  return out;
}

}  // namespace

graph::GroupShape group_shape(const SystemModel& model, const Geometry& geometry) {
  graph::GroupShape out{factor_shapes(model.group), {}};
  const int n = geometry.dim();
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      Eigen::VectorXd image(n);
      geometry.ad_transpose(Eigen::VectorXd(Eigen::VectorXd::Unit(n, i)).data(),
                            Eigen::VectorXd(Eigen::VectorXd::Unit(n, j)).data(), image.data());
      out.structure.insert(out.structure.end(), image.begin(), image.end());
    }
  }
  return out;
}

graph::MotionTerms recorded_terms(const SystemModel& model, const Mechanics& mechanics,
                                  const double* g, const MotionVariables& at) {
  if (const auto* known = dynamic_cast<const graph::HasMotionTerms*>(&mechanics))
    return known->motion_terms(at);
  const RecordedFormulas formulas = recorded_formulas(model, mechanics, g);
  if (!formulas)
    throw std::domain_error(
        "its formulas are a type in C++ that is compiled for numbers; systems in files, "
        "mechanisms and left-invariant systems have recorded ones");
  return graph::terms_of(formulas(at.all()), at);
}

MotionFormulas record_motion(const SystemModel& model, const Mechanics& mechanics,
                             const Geometry& geometry, const std::vector<double>& element,
                             const std::vector<double>& velocity) {
  const auto recording = std::make_shared<graph::Recording>();
  std::vector<std::string> inputs;
  for (const InputField& input : model.inputs) inputs.push_back(input.name);
  MotionVariables at(group_shape(model, geometry), model.group.columns, model.rates, inputs);
  if (!model.contact_laws.empty())
    throw std::domain_error("the rows that hold depend on which contacts and joints slide");
  const MotionTerms terms = recorded_terms(model, mechanics, element.data(), at);
  if (const size_t m = velocity.size() - terms.rows.size(); m > kMostSolved)
    throw std::domain_error(fmt::format(
        "it has {} independent velocities; at most {} are solved as formulas", m, kMostSolved));
  graph::Frame frame = graph::free_frame(velocity.size()), of_velocities = frame;
  if (!terms.rows.empty()) {
    auto samples = samples_near(geometry, element, velocity, inputs.size());
    frame = eliminate(terms.rows, terms.row_rates, samples);
    of_velocities = eliminate(terms.rows, terms.drift, frame.order);
  }
  MotionFormulas out{recording,    at, solve_in_frame(terms, frame),
                     frame.pivots, {}, frame.independent};
  Numbers y;
  for (const int i : frame.independent) y.push_back(at.velocities[static_cast<size_t>(i)]);
  for (size_t i = 0; i < velocity.size(); ++i)
    out.admissible.push_back(of_velocities.particular[i] + product(of_velocities.e[i], y));
  recording->end();
  return out;
}

}  // namespace hamel
