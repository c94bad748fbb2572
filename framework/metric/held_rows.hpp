// Rows of positions, phi(g) = 0, that hold to the round-off of a configuration.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace hamel {

/// The round-off of a configuration, rad and m.
inline constexpr double kPlaceRoundOff = 1e-14;

/// The entries of c, in the equation F(r, c) = 0 of a step, that are rows phi of positions, whose
/// differentials are the last rows of A, less what the round-off of a configuration does to them.
/// That does not shrink with the momenta, relative to which F is judged: a motion that comes to
/// rest would else fail.
template <class A, class Phi, class Rows>
void drop_round_off(const A& a, const Phi& phi, Rows& c) {
  const Eigen::Index before = a.rows() - phi.size();
  for (Eigen::Index i = 0; i < phi.size(); ++i) {
    const double own = kPlaceRoundOff * a.row(before + i).template lpNorm<1>(),
                 size = std::abs(phi[i]);
    c[before + i] *= size <= own ? 0 : 1 - own / size;
  }
}

}  // namespace hamel
