// Analysis of a system: frame, brackets, conserved quantities (`hamel describe --analyse`).
//
// Frame and brackets at the start. X_a(g) = P(g) e_a, e_a the Hamel frame at g0 and P(g) the
// projection onto ker A(g) along I^-1 A^T; in left trivialisation
//   [X, Y](g) = dY(g) X - dX(g) Y + ad_{X(g)} Y(g).
// At the start dX_a is orthogonal to d in the metric: structure constants are those of ad.
// The growth of d, d + [d, d], ... decides whether the constraint is integrable (no growth) and how
// many brackets span the tangent space (Chow). growth.hpp has it, the drift of affine rows and the
// tolerances. Conserved quantities are found numerically, not proved: combinations of energy, body
// velocities and spatial momenta Ad*_{g^-1} mu that change by 1e-9 of their terms at most along
// eight motions of 1 and 20 s, each of which ends after 10,000 steps (a note says so).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/analysis/growth.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

struct Analysis {
  // In analysis.cpp, since it holds memory that Eigen took (lie/types.hpp).
  Analysis();
  Analysis(const Analysis&);
  Analysis& operator=(const Analysis&);
  ~Analysis();

  int n = 0, rows = 0, rank = 0, m = 0;  // of A at the start
  int holonomic_rows = 0;
  bool left_invariant = false;
  Eigen::MatrixXd frame;                   // E at the start, n x m
  std::vector<Eigen::MatrixXd> structure;  // c^d_ab: entry d, at (a, b): [X_a, X_b] along X_d, on d
  Growth growth;  // dim d, dim (d + [d, d]), ...; affine rows with their drift
  /// Are the rows integrable, spanned by differentials of functions of g (of g and t with a drift)?
  /// Empty: not decided.
  std::optional<bool> integrable() const;
  struct Conserved {
    std::string expression;  // "E", "0.5 J3 - ..."
    double change;           // largest seen, in units of the largest of its terms
  };
  std::vector<Conserved> conserved;
  std::vector<std::string> notes;  // how the start was projected
};

/// verdict: by brackets of up to 3 fields, and without what is conserved: no motion is followed,
/// and it is not always decided.
enum class AnalysisOf { all, verdict };

/// Throws ConfigError as Simulation::run does, and above dimension 100.
Analysis analyse(const Registry& registry, const std::string& system,
                 const Parameters& parameters = {}, AnalysisOf what = AnalysisOf::all);

}  // namespace hamel
