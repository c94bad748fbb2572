// How far contacts that roll are from what they can hold together, where their rows repeat each
// other's (four wheels of a cart, two on one axle).
//
// Their reactions are l + Z c of one motion, of contact i in units of its bound u_i + V_i c. The
// contacts hold where some c has |u_i + V_i c| <= 1 for all i: where the factor
//   rho = min over c of max_i |u_i + V_i c|                                                     (7)
// is at most 1. Where it passes 1 those begin to slide whose multiplier in (7) is not 0, at once,
// each against its reaction: sum_i y_i^T V_i = 0 of the multipliers y_i, |y_i| = k_i, says that
// slips k_i along these are a motion of the bodies. Source: Drucker, Prager, Greenberg, Extended
// limit design theorems for continuous media, Quart. Appl. Math. 9 (1952).
//   By the minima of rho/m - sum log(rho^2 - |u_i + V_i c|^2) as m falls (Nesterov, Nemirovskii
// 1994, section 2.2): rho is above (7) by 2 k m at most, of k contacts. Nothing is allocated behind
// the constructor.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace hamel {

class LimitLoad {
 public:
  /// rows: tangential, the most that there are.
  explicit LimitLoad(int rows, int contacts);

  /// Forgets all contacts; unknowns: of c.
  void begin(int unknowns);
  /// The next contact, with one row or two.
  void add(int contact, int size);
  /// u and V of the rows in the order of add().
  double& u(int row) { return u_[row]; }
  double& v(int row, int column) { return v_(row, column); }
  int rows() const { return rows_; }

  /// Finds (7). Contacts without V are left out.
  void solve();
  /// Is this contact one of them?
  bool has(int contact) const { return find(contact) != nullptr; }
  double factor() const { return factor_; }
  /// Does it slide where the factor passes 1?
  bool yields(int contact) const;
  /// u + V c, c between 0 and that of (7), as near to 0 as all hold.
  Eigen::Vector2d reaction(int contact) const;

 private:
  struct Part {
    int contact, first, size;
    bool free;  // it has V
  };
  const Part* find(int contact) const;
  Eigen::Vector2d of(const Part& part, const Eigen::VectorXd& rows) const;
  void scale_columns();
  double room(const Part& part) const;
  void add_barrier(const Part& part);
  double centre();
  void step_back();

  std::vector<Part> parts_;
  Eigen::MatrixXd v_, hessian_;
  Eigen::VectorXd u_, w_, x_, gradient_, step_, moved_;
  int rows_ = 0, unknowns_ = 0;
  double m_ = 1, factor_ = 0, part_ = 0;
};

}  // namespace hamel
