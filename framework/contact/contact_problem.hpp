// The contact problem: impulses, or reactions, P of contacts with Coulomb's friction, with
// gamma = G P + c the velocities, or accelerations, that they leave,
//   0 <= P_n  _|_  gamma_n >= 0,   |P_t| <= mu P_n,   gamma_t = -k P_t, k >= 0,                (1)
// k > 0 only on the rim |P_t| = mu P_n of the cone.
//
// G need not be symmetric: in the columns of a contact that slides already its friction belongs to
// the normal reaction (contact_dynamics.hpp). A contact without P_n has a given bound in place of
// mu P_n. One contact is solved exactly, with all of its solutions; several with given bounds as
// the convex problem that theirs is (convex_contacts.hpp), which finds a solution always; others by
// sweeps of Gauss-Seidel over the exact ones of each. The equations of the active set end both: by
// P - gamma/G_ii of their solution a contact that would do otherwise turns, until none does.
// Nothing is to be tuned, and nothing is allocated behind the constructor.
// Source: Leine, Glocker, A set-valued force law for spatial Coulomb-Contensou friction, Eur. J.
// Mech. A 22 (2003); Klarbring, Mathematical programming and augmented Lagrangian methods for
// frictional contact problems (1992), for the sweeps; Hueeber, Stadler, Wohlmuth, A primal-dual
// active set algorithm for three-dimensional contact problems with Coulomb friction, SIAM J. Sci.
// Comput. 30 (2008).
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/contact/contact_block.hpp>
#include <hamel/framework/contact/convex_contacts.hpp>
#include <hamel/framework/contact/pivots.hpp>

namespace hamel {

struct ContactSolution {
  ContactAnswer answer = ContactAnswer::opens;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  // the first size() of them
};

/// All solutions of one contact; those that differ by round-off are one.
class ContactSolutions {
 public:
  int count() const { return count_; }
  const ContactSolution& operator[](int i) const { return all_[static_cast<std::size_t>(i)]; }
  void clear() { count_ = 0; }
  /// scale: of P, whose round-off is no difference.
  void add(const ContactSolution& one, double scale);

 private:
  std::array<ContactSolution, 8> all_;
  int count_ = 0;
};
/// g and c: the first block.size() rows and columns.
void solve_contact(const Eigen::Matrix3d& g, const Eigen::Vector3d& c, const ContactBlock& block,
                   ContactSolutions& out);

class ContactProblem {
 public:
  using Matrix = Eigen::Ref<const Eigen::MatrixXd>;
  using Vector = Eigen::Ref<const Eigen::VectorXd>;

  /// unknowns: the most that a problem has.
  explicit ContactProblem(int unknowns, int contacts);
  /// several and none are exact of one contact; of several contacts none says that no solution was
  /// found.
  enum class Outcome { one, several, none };
  Outcome solve(const Matrix& g, const Vector& c, const std::vector<ContactBlock>& blocks);
  /// From the P that solve() found for a problem next to this one.
  Outcome solve_next(const Matrix& g, const Vector& c, const std::vector<ContactBlock>& blocks);

  /// From there too, without a search: false where what the contacts do is another.
  bool refine(const Matrix& g, const Vector& c, const std::vector<ContactBlock>& blocks);

  /// Nothing is next to a problem that was before.
  void forget() { size_ = 0; }

  /// Behind solve(): P, and what each contact does.
  auto p() const { return p_.head(size_); }
  const std::vector<ContactAnswer>& answers() const { return answers_; }
  /// The solutions of one contact.
  int count() const { return solutions_.count(); }

 private:
  using Blocks = std::vector<ContactBlock>;
  bool sweep(const Matrix& g, const Vector& c, const Blocks& blocks);
  void look_at_block(const Matrix& g, const Vector& c, const ContactBlock& block);
  void equations(const Matrix& g, const Vector& c, const Blocks& blocks);
  bool improve(const Matrix& g, const Vector& c, const Blocks& blocks, double most_left);
  bool settle(const Matrix& g, const Vector& c, const Blocks& blocks, double most_left);
  bool turn_contacts(const Matrix& g, const Vector& c, const Blocks& blocks, bool all);
  bool find_correction();
  void shorten(int rank);
  Outcome sweeps(const Matrix& g, const Vector& c, const Blocks& blocks, int first_look);
  bool turn_some(const Matrix& g, const Vector& c, const Blocks& blocks);
  bool minimise(const Matrix& g, const Vector& c, const Blocks& blocks);

  Eigen::VectorXd p_, before_, residual_, kept_, start_;
  Eigen::MatrixXd jacobian_, null_;
  Eigen::VectorXd squares_;
  std::vector<ContactAnswer> answers_, told_;
  std::vector<size_t> doubtful_;
  Pivots pivots_;
  Eigen::Matrix3d block_g_;
  Eigen::Vector3d block_c_;
  ContactSolutions solutions_;
  ConvexContacts convex_;
  int size_ = 0;
  double left_ = 0;  // of the equations of the active set, which no P solves, beside their terms
};

/// The largest violation of (1), relative to the sizes of gamma and P.
double contact_residual(const ContactProblem::Matrix& g, const ContactProblem::Vector& c,
                        const std::vector<ContactBlock>& blocks, const ContactProblem::Vector& p);

}  // namespace hamel
