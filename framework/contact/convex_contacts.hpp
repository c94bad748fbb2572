// The contact problem (1) of contact_problem.hpp where it is that of a convex function.
//
// Contacts with given bounds B, and normal reactions without friction (stops, walls), minimise
//   f(P) = 1/2 P^T G P + c^T P   over   |P_t| <= B,   P_n >= 0,                                 (6)
// G symmetric: (1) is the condition of its minimum, gamma its gradient. There always is one where
// no P_n is without bound; gamma is unique, P is not where rows repeat each other (two wheels on
// one axle, G singular). P is then that of the least sum of (P/B)^2, whatever the order of
// contacts: f has 1e-7 of it added, or less where bounds differ so much that this moves the answer.
//   A path along the minima of f - m sum log(1 - |P_t/B|^2) - m sum log P_n as m falls tells which
// contacts slide, with Newton's method, damped by 1/(1 + decrement), which converges from
// everywhere. Source: Nesterov, Nemirovskii, Interior-Point Polynomial Algorithms in Convex
// Programming (1994), section 2.2.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/contact/contact_block.hpp>

namespace hamel {

class ConvexContacts {
 public:
  using Matrix = Eigen::Ref<const Eigen::MatrixXd>;
  using Vector = Eigen::Ref<const Eigen::VectorXd>;
  using Blocks = std::vector<ContactBlock>;

  /// unknowns: the most that a problem has.
  explicit ConvexContacts(int unknowns);
  static bool applies(const Matrix& g, const Blocks& blocks);

  /// least: weight of sum (P/B)^2, f being of size 1.
  void begin(const Matrix& g, const Vector& c, const Blocks& blocks, double least);
  /// The next m, a tenth of the last. False where the last one was, 1e-13.
  bool follow();
  /// P and what each contact does, once m is small enough to tell. wary: a contact that is on its
  /// rim for the least sum alone slides (with a slip of 0).
  bool tells() const;
  void tell(bool wary, Eigen::Ref<Eigen::VectorXd> p, std::vector<ContactAnswer>& answers) const;
  /// |log(multiplier/room)| of a block: 0 where tell() could say either.
  double certainty(std::size_t block) const;

 private:
  // 1 - |x|^2 of a contact with a bound.
  double room(const ContactBlock& block) const;
  double left(const ContactBlock& block) const;     // room, or a normal reaction
  double pressed(const ContactBlock& block) const;  // multiplier of what is left
  void add_barrier(const ContactBlock& block);
  double centre();  // a step of Newton; the decrement before it

  Eigen::MatrixXd q_, hessian_;
  Eigen::VectorXd x_, unit_, linear_, gradient_, step_;
  const Blocks* blocks_ = nullptr;
  int size_ = 0;
  double m_ = 1, least_ = 0;
};

}  // namespace hamel
