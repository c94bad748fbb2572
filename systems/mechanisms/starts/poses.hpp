// Poses that satisfy the rows of a mechanism, to look at it away from the drawn pose; rows that
// repeat others.
#pragma once

#include <map>
#include <vector>

#include <Eigen/Core>

#include <hamel/systems/mechanisms/multibody.hpp>

namespace hamel::mechanisms {

/// All rows of each() at a pose and a time: A, b, phi.
struct RowValues {
  Eigen::MatrixXd a;
  Eigen::VectorXd b, phi;
  RowValues(const Multibody& system, const std::vector<double>& g, double t = 0);
};

/// The least x of those with the least |a x - b|.
Eigen::VectorXd least(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Poses that share nothing, near g: g tau(eta), the rows left aside.
std::vector<std::vector<double>> poses_around(const Multibody& system,
                                              const std::vector<double>& g);
/// Poses near g on phi = 0 of all rows that always hold, reached by moves that satisfy the rows,
/// but for prescribed rates: these move to where the joint is at other times. g first. Rows may be
/// dependent.
std::vector<std::vector<double>> poses_on_rows(const Multibody& system,
                                               const std::vector<double>& g);

/// Moves g onto phi(g) = 0 of all rows by the least change of the velocities that are free to
/// change, but for the prescribed row of a velocity; returns the largest |phi| left. touching: with
/// contacts that may open, and are drawn on the ground, there.
double satisfy(const Multibody& system, const std::vector<bool>& fixed, std::vector<double>& g,
               int but_for = -1, bool touching = false);

/// The rows of which a row is a combination.
struct Repeat {
  std::vector<int> others;
  bool contradicts = false;  // its b is not the same combination of theirs
};
/// The given rows that are combinations of others at g, and whether they agree with them at
/// these times.
std::map<int, Repeat> repeated_rows(const Multibody& system, const std::vector<double>& g,
                                    std::vector<int> rows, const std::vector<double>& times);

/// The rows of each() that are independent, and for each of the others those it repeats.
struct Redundancy {
  std::vector<int> rows;          // independent at one of the poses at least
  std::map<int, Repeat> repeats;  // those that are not
};
/// The rows that are not zero at all poses near one: in the plane no contact changes its height.
std::vector<int> rows_that_constrain(const Multibody& system, const std::vector<double>& drawn);
/// RowValues for near these places, on phi = 0; the first is the drawn pose. left_out: rows that
/// are no part of it.
Redundancy find_redundancy(const Multibody& system, const std::vector<std::vector<double>>& places,
                           const std::vector<int>& left_out);

}  // namespace hamel::mechanisms
