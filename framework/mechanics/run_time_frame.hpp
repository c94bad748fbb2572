// The frame of admissible_frame.hpp with sizes known at run time only, along the entries that are
// not 0.
//
// The rows of A end at the last velocity that moves their part. Reflection j takes the velocities
// from j to the last that one of the rows up to j has: few where the rows come in the order of
// their links, as along a train.
#pragma once

#include <vector>

namespace hamel {

/// Functions of pointers, compiled once: Eigen's vectors stay in the caller's code, whose flags may
/// align them differently.
class RunTimeFrame {
 public:
  RunTimeFrame(int n, int k);

  /// same_frame: the reflections keep their signs.
  void set(const double* inertia, const double* a, bool same_frame);
  void assemble(const double* r, const double* c, double* f);
  void weigh(double* mu) const;
  double size(const double* mu) const;
  void velocity(const double* mu, const double* c, double* xi);
  void expand(double* z);
  void multipliers(const double* reaction, double* lambda);

 private:
  void find_weights(const double* inertia);
  void factor_rows(const double* a, bool keep_signs);
  template <int P>
  void weigh_rows(const double* a);
  template <int P>
  void reflect_rows(int j, int first, bool keep_signs);
  void find_frame();
  void reduce_inertia(const double* inertia);
  void factor_reduced();
  void reflect(int j, double* y) const;
  void reduce(const double* mu, double* to) const;
  void solve_reduced();
  void combine(const double* c, double* xi);

  int n_, k_, m_;
  bool diagonal_ = false;
  std::vector<double> weights_;                        // D^-1/2
  std::vector<double> rows_;                           // D^-1/2 A^T, above its diagonal L^T
  std::vector<double> reflections_;                    // vector j in row j, from its entry j
  std::vector<int> ends_;                              // of the entries of a vector that are not 0
  std::vector<double> l_inverse_diagonal_;             // of L
  std::vector<double> row_weights_, factors_, signs_;  // 2/|v|^2
  std::vector<double> frame_, momenta_;                // E, I E
  std::vector<double> reduced_inertia_;
  std::vector<double> few_, work_, y_, sums_;
};

}  // namespace hamel
