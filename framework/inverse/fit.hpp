// Fits: parameters, starts and constant inputs from recordings (`hamel fit`).
//
//   hamel::FitRequest request{.names = {{"offset"}, {"start.v1"}, {"start.omega"}},
//                             .sigma = {{"omega", 0.01}, {"v1", 0.01}}};
//   request.recordings.push_back(hamel::read_recording("sleigh.csv"));
//   hamel::Fit fit = hamel::fit(hamel::simulate("chaplygin_sleigh"), request);
//
//   least  sum_i rho(r_i),  r_i = (q_i(z(t_i)) - d_i) / sigma_i,  rho = r^2/2, or Huber's
// by the method of Levenberg and Marquardt with the tangent of the run (framework/tangent). Where a
// displacement grows along a recording, this is divided into segments, whose first states are
// unknowns too and whose ends are equations (multiple shooting). The stage solver
// (framework/stages) is not used for it: its sweep forms normal equations, in which the growth is
// squared. Covariance (J^T J)^-1 over all changes that keep these equations, which is that of
// single shooting. Directions that the data do not see are singular directions of J with its
// columns scaled to length 1. Sources: More, The Levenberg-Marquardt algorithm (1978); Bock, Recent
// advances in parameter identification techniques for ODE (1983); Huber, Robust estimation of a
// location parameter (1964).
// Standard-library types only.
#pragma once

#include <atomic>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/inverse/recordings.hpp>
#include <hamel/framework/io/export.hpp>
#include <hamel/framework/io/number_matrix.hpp>
#include <hamel/framework/io/table.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

/// Name to fit: a parameter ("mass", "inertia2"), a constant input, "start." and a coordinate or
/// component of the velocity.
struct FitName {
  std::string name;
  std::optional<double> guess = {};  // none: the value that the run would have
  double low = -std::numeric_limits<double>::infinity(),
         high = std::numeric_limits<double>::infinity();
};
/// "offset", "offset=0.2", "offset=0.2:0:1". ConfigError.
HAMEL_API FitName parse_fit_name(const std::string& text);

struct FitRequest {
  std::vector<FitName> names;
  std::vector<Recording> recordings;
  /// Standard deviations of columns; of the others they are estimated from the residuals.
  std::map<std::string, double> sigma = {};
  std::map<std::string, std::string> observe = {};  // column: formula
  std::optional<double> huber = {};                 // rho is linear beyond so many sigma
  std::optional<int> segments = {};  // of each recording; none: by how fast displacements grow
  int iterations = 200;              // at most
};

struct FittedNumber {
  std::string name, unit;
  double value = 0, guess = 0;
  double sigma = 0;  // infinite where it is undetermined
  bool at_bound = false;
};

struct Fit {
  bool converged = false;
  std::string reason;  // unless ok()
  std::vector<FittedNumber> parameters;
  NumberMatrix covariance;
  double chi2 = 0;  // sum of r^2
  long dof = 0;     // data less numbers
  /// Directions that the data do not see: relative changes of the numbers, of length 1.
  std::vector<std::map<std::string, double>> undetermined;
  std::map<std::string, double> sigma;  // of the columns, as given or estimated
  /// Rows of each recording: t, then of each column its datum, the fit and (fit - datum) / sigma.
  std::vector<Table> residuals;
  std::vector<int> segments;  // of each recording
  long iterations = 0, runs = 0;
  double seconds = 0;
  Config run;  // with the fitted numbers; of the first recording
  std::vector<std::string> notes;

  bool ok() const { return converged && undetermined.empty(); }
  explicit operator bool() const { return ok(); }
};

/// With several recordings parameters and inputs are shared, and each has a start of its own:
/// "start.omega@2" of the second. ConfigError with all mistakes before anything runs. progress:
/// iteration, chi2. stop: ends it with the best so far.
HAMEL_API Fit fit(const Simulation& simulation, const FitRequest& request,
                  const std::function<void(long, double)>& progress = {},
                  const std::atomic<bool>* stop = nullptr);

}  // namespace hamel
