#include <hamel/solvers/newton.hpp>

namespace hamel {

void SmallLu::compute(const Matrix& matrix) { lu_.compute(matrix); }
SmallLu::Vector SmallLu::solve(const Vector& f) const { return lu_.solve(f); }

}  // namespace hamel
