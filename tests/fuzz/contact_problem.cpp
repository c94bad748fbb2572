// Fuzz target: the contact problem. Every solution of one contact satisfies the law to round-off,
// as does that of several where there is said to be one; G = B B^T of numbers of few digits, of any
// rank, or any matrix beside it.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>

#include <hamel/framework/contact/contact_problem.hpp>

namespace {

using namespace hamel;

// Bytes one after the other; 0 behind the last.
class Bytes {
 public:
  Bytes(const uint8_t* data, size_t size) : data_(data), size_(size) {}
  uint8_t next() { return at_ < size_ ? data_[at_++] : 0; }
  // A multiple of 1/16 below 8.
  double number() { return static_cast<int8_t>(next()) / 16.0; }
  Eigen::MatrixXd matrix(int rows, int columns) {
    Eigen::MatrixXd out(rows, columns);
    for (double& x : out.reshaped()) x = number();
    return out;
  }

 private:
  const uint8_t* data_;
  size_t size_, at_ = 0;
};

// Relative to P: round-off of its products.
void require_law(const Eigen::MatrixXd& g, const Eigen::VectorXd& c,
                 const std::vector<ContactBlock>& blocks, const Eigen::VectorXd& p) {
  constexpr double round_off = 1e-11;
  const double left = contact_residual(g, c, blocks, p);
  if (left <= round_off) return;
  fmt::print(stderr, "expected: a residual of at most {:g}, got {:g}\n", round_off, left);
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  Bytes bytes(data, size);
  const uint8_t kind = bytes.next();
  const int contacts = 1 + kind % 4, d = 1 + kind / 4 % 2, n = contacts * (d + 1);
  const int rank = 1 + kind / 8 % n;
  const double mu = bytes.next() / 64.0;
  const Eigen::MatrixXd b = bytes.matrix(n, rank);
  Eigen::MatrixXd g = b * b.transpose();
  const bool any = contacts == 1 && kind / 128 != 0;
  if (any) g += bytes.matrix(n, n);
  const Eigen::VectorXd c =
      any ? Eigen::VectorXd(bytes.matrix(n, 1)) : Eigen::VectorXd(b * bytes.matrix(rank, 1));
  std::vector<ContactBlock> blocks;
  for (int i = 0; i < contacts; ++i)
    blocks.push_back({.first = i * (d + 1), .normal = true, .tangential = d, .friction = mu});
  if (contacts > 1) {
    ContactProblem problem(n, contacts);
    if (problem.solve(g, c, blocks) == ContactProblem::Outcome::one)
      require_law(g, c, blocks, problem.p());
    return 0;
  }
  Eigen::Matrix3d g3 = Eigen::Matrix3d::Zero();
  Eigen::Vector3d c3 = Eigen::Vector3d::Zero();
  g3.topLeftCorner(n, n) = g;
  c3.head(n) = c;
  ContactSolutions all;
  solve_contact(g3, c3, blocks[0], all);
  for (int i = 0; i < all.count(); ++i) require_law(g, c, blocks, all[i].p.head(n));
  return 0;
}
