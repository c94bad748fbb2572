// The bug that this matrix is for: an Eigen vector that one side makes and the other frees. The
// side of the library is planted_library.cpp, compiled plainly.
#include <Eigen/Core>

Eigen::VectorXd planted(int n);

int main() {
  for (int n = 1; n < 100; ++n) {
    if (planted(n).sum() != n) return 1;
  }
}
