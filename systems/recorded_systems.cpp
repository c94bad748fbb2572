#include <hamel/systems/recorded_systems.hpp>

#include <stdexcept>
#include <tuple>

#include <hamel/framework/graph/system_formulas.hpp>
#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/groups/heisenberg.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/rn.hpp>
#include <hamel/systems/ball_on_turntable.hpp>
#include <hamel/systems/chaplygin_ball.hpp>
#include <hamel/systems/contact_oscillator.hpp>
#include <hamel/systems/differential_drive.hpp>
#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/knife_edge_on_incline.hpp>
#include <hamel/systems/nonholonomic_particle.hpp>
#include <hamel/systems/rattleback.hpp>
#include <hamel/systems/rolling_ball.hpp>
#include <hamel/systems/routh_sphere.hpp>
#include <hamel/systems/segway.hpp>
#include <hamel/systems/snakeboard.hpp>
#include <hamel/systems/suslov_in_potential.hpp>
#include <hamel/systems/veselova.hpp>

namespace hamel {
namespace {

using graph::FormulaPlace;
using graph::Number;
using Numbers = std::vector<Number>;

// Elements of numbers as their groups lay them out (FormulaPlace::element).
void take(const Number*& from, SO2Element<Number>& out) {
  out.c = from[0];
  out.s = from[1];
  from += 3;  // turns: no formula depends on them
}
void take(const Number*& from, SE2Element<Number>& out) {
  take(from, out.rotation);
  for (int i = 0; i < 2; ++i) out.translation[i] = *from++;
}
template <int rows, int columns>
void take(const Number*& from, MatT<Number, rows, columns>& out) {
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) out(i, j) = *from++;
}
void take(const Number*& from, SE3Element<Number>& out) {
  take(from, out.rotation);
  take(from, out.translation);
}
template <class... Gs>
void take(const Number*& from, ProductElement<Number, Gs...>& out) {
  std::apply([&from](auto&... parts) { (take(from, parts), ...); }, out.parts);
}

template <class Matrix>
std::vector<Numbers> rows_of(const Matrix& m) {
  std::vector<Numbers> out;
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    out.emplace_back();
    for (Eigen::Index j = 0; j < m.cols(); ++j) out.back().emplace_back(m(i, j));
  }
  return out;
}
template <class Vector>
Numbers entries_of(const Vector& v) {
  Numbers out;
  for (Eigen::Index i = 0; i < v.size(); ++i) out.emplace_back(v[i]);
  return out;
}

// B u, of inputs whose effect is constant and linear in them: read off at unit inputs.
template <class Effect>
void add_inputs(const FormulaPlace& at, const Effect& effect, Numbers& out) {
  const auto count = static_cast<Eigen::Index>(at.inputs.size());
  for (Eigen::Index j = 0; j < count; ++j) {
    const auto column = effect(InputValues(Eigen::VectorXd::Unit(count, j)));
    out.resize(static_cast<size_t>(column.size()));
    for (size_t i = 0; i < out.size(); ++i)
      out[i] += column[static_cast<Eigen::Index>(i)] * at.inputs[static_cast<size_t>(j)];
  }
}

template <class S>
graph::SystemFormulas formulas_of_type(const Parameters& given, const FormulaPlace& at) {
  S system;
  detail::FieldWriter writer{given};
  detail::tell_fields(system, writer);
  typename S::Group::template Element<Number> g;
  const Number* from = at.element.data();
  take(from, g);
  const auto identity = S::Group::template identity<double>();

  graph::SystemFormulas out;
  if constexpr (requires { system.inertia(); }) out.inertia = rows_of(system.inertia());
  else out.inertia = rows_of(system.inertia(g));
  if constexpr (requires { system.constraints(); }) out.rows = rows_of(system.constraints());
  else if constexpr (requires { system.constraints(g); }) out.rows = rows_of(system.constraints(g));
  else
    static_assert(
        !requires { system.constraints(identity); }, "rows of doubles alone");
  if constexpr (requires { system.drift(at.t, g); }) out.drift = entries_of(system.drift(at.t, g));
  else if constexpr (requires { system.drift(g); }) out.drift = entries_of(system.drift(g));
  else static_assert(!has_drift<S>(), "b of doubles alone");
  if constexpr (requires { system.holonomic(g); }) out.holonomic = entries_of(system.holonomic(g));
  if constexpr (requires { system.potential(g); }) out.potential = system.potential(g);
  if constexpr (has_input_drift<S>())
    add_inputs(
        at, [&](const InputValues& u) { return system.drift(0, identity, u); }, out.drift);
  if constexpr (has_input_force<S>()) {
    const auto rest = Vec<S::Group::dim>::Zero();
    add_inputs(
        at, [&](const InputValues& u) { return system.force(0, identity, rest, u); }, out.force);
  }
  return out;
}

template <class S>
void add_recorded() {
  graph::add_system_formulas(problem_key(typeid(TypedMechanics<S>)), formulas_of_type<S>);
  if constexpr (has_inputs<S>())
    graph::add_system_formulas(problem_key(typeid(TypedMechanics<WithInputs<S>>)),
                               formulas_of_type<S>);
}

}  // namespace

void add_recorded_systems() {
  add_recorded<BallOnTurntable>();
  add_recorded<ChaplyginBall>();
  add_recorded<ContactOscillator>();
  add_recorded<DifferentialDrive>();
  add_recorded<FallingDisk>();
  add_recorded<KnifeEdgeOnIncline>();
  add_recorded<NonholonomicParticle>();
  add_recorded<Rattleback>();
  add_recorded<RollingBall>();
  add_recorded<RouthSphere>();
  add_recorded<Segway>();
  add_recorded<Snakeboard>();
  add_recorded<SuslovInPotential>();
  add_recorded<Veselova>();
}

}  // namespace hamel
