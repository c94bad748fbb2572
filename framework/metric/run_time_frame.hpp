// A frame of the admissible velocities with sizes known at run time only.
//
// k of the velocities, one for each row, follow from the m = n - k others. By the columns of both
//   A = [A_d A_f],   xi_d = A_d^-1 c - B xi_f,   B = A_d^-1 A_f,
// and E, of n x m, is -B in the rows d and 1 in the rows f: A E = 0. The equations of a step are
//   (c_i / |D^-1/2 a_i|, D_f^-1/2 E^T r) = 0,                                                   (*)
// D_f the part of D = diag(I), a massless direction taken as the lightest other: square roots of an
// energy. The
// velocity with A xi = c, E^T I xi = y has xi_f = (E^T I E)^-1 (y - N^T A_d^-1 c), N the rows d of
// I E.
//
// A_d^-1 is that of Gauss and Jordan, row by row of A, which for rows in the order of their links
// fill in nothing: of a train of n trailers this takes n^2 operations. The velocity that follows
// from a row is the one with the largest entry of A D^-1/2 when it is chosen, and is kept while its
// pivot stays near to what it was: the frame turns smoothly with the configuration. Source: Golub,
// Van Loan, Matrix Computations, 3.4 (partial pivoting); Gill, Murray, Wright, Practical
// Optimization, 5.1.2 (variable reduction).
#pragma once

#include <vector>

namespace hamel {

/// Functions of pointers, compiled once: Eigen's vectors stay in the caller's code, whose flags may
/// align them differently.
class RunTimeFrame {
 public:
  RunTimeFrame(int n, int k);

  /// same_frame: within a step; other velocities are chosen only where these would not do.
  void set(const double* inertia, const double* a, bool same_frame);
  /// (*).
  void assemble(const double* r, const double* c, double* f);
  /// D^-1/2 mu, in place, and its length.
  void weigh(double* mu) const;
  double size(const double* mu) const;
  /// A xi = c, E^T I xi = E^T mu.
  void velocity(const double* mu, const double* c, double* xi);
  /// (c_i / |D^-1/2 a_i|, D_f^-1/2 E^T I dxi) -> dxi, in place.
  void expand(double* z);
  /// The lambda of a reaction A^T lambda.
  void multipliers(const double* reaction, double* lambda);

 private:
  void find_weights(const double* inertia);
  template <int P>
  void take_rows(const double* a);
  template <int P>
  bool eliminate(double least);
  void choose(int j);
  template <int P>
  void reduce_inertia(const double* inertia);
  void factor_reduced();
  void reduce(const double* mu);
  void solve_reduced();
  void move(const double* c);
  void spread(double* xi);
  // Column i of B.
  const double* following(int i) const;
  // D_f^-1/2.
  double unit(int i) const;

  int n_, k_, m_;
  bool chosen_ = false;
  std::vector<int> order_;       // the velocities d, each in the place of its row, then those f
  std::vector<double> pivots_;   // as they were when chosen, of rows of length 1, in units of D
  std::vector<double> weights_;  // D^-1/2
  std::vector<double> row_weights_;
  std::vector<double> rows_;     // A^T by order_; once eliminated its rows f are B^T
  std::vector<double> steps_;    // of the elimination: what row j takes from the others, 1/pivot
  std::vector<double> momenta_;  // (I E)^T
  std::vector<double> reduced_;  // E^T I E, then its Cholesky factor
  std::vector<double> d_, y_, few_;
};

}  // namespace hamel
