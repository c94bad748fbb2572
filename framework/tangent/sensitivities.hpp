// Derivatives of a run by numbers that it depends on, along the run.
//
//   const auto sleigh = hamel::simulate("chaplygin_sleigh").step(0.01).until(4);
//   hamel::Sensitivities along = sleigh.sensitivities({"offset", "start.omega"});
//   along.rows.column("d(omega)/d(offset)");
//   hamel::Gradient of = sleigh.gradient("x^2 + y^2", {"offset", "start.omega"});
//   hamel::Run run = sleigh.build();
//   run.advance_to(2);
//   hamel::RunTangent tangent = run.tangent();
//
// Names are those of parameters ("mass", "inertia2"), of inputs that are constant, and "start."
// with a coordinate or a component of the velocity: the other components follow the rows, nearest
// to the usual ones in the metric I. The run keeps its accepted steps: the choice of h has no
// derivative. Derivatives are products of the tangents of the steps, exact or by extrapolated
// differences of the map of this step alone. Events that end the run or change its state
// (on_event) happen at other times beside it, and impacts are differentiated: their functions are
// called again at states nearby. Standard-library types only.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/io/number_matrix.hpp>
#include <hamel/framework/io/table.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

struct Sensitivities {
  /// Rows at the times of the run's: t, coordinates, velocities, then d(x)/d(name) of each of them,
  /// by each name.
  Table rows;
  std::vector<std::string> names;
  /// Of each column d(x)/d(name), in their order: the largest measured error along the run.
  std::vector<double> errors;
  /// Where an event ended the run: derivatives of its time, by each name. The last row, where rows
  /// are nodes, is the state there, whenever that is.
  std::vector<double> end_time;
  double growth = 0;  // of a displacement by a number of the start, in natural units
  Status status;      // of the run and its tangent; rows before a failure are kept
  int steps = 0;
};

/// The derivative of a number at the end of a run.
struct Gradient {
  double value = 0;
  std::vector<std::string> names;
  std::vector<double> by, errors;  // by each name; its measured error
  Status status;                   // of the run and its tangent; else there are no numbers
};

/// The tangent of a run from its start to its current state.
struct RunTangent {
  /// 2n x 2n: (eta, dxi) now, by (eta, dxi) at the start, dg = g eta^. Variations of the start are
  /// first projected onto the linearised constraints.
  NumberMatrix matrix, errors;
  Status status;
};

}  // namespace hamel
