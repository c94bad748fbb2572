// Assembly: the inertia of bodies that are welded together.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/systems/mechanisms/assembly/assembly.hpp>

namespace hamel {

using namespace mechanisms;

// Moments are judged for the whole, about its mass centre c: sum of J_i + m_i (|a_i - c|^2 - (a_i -
// c)(a_i - c)^T). Parts of which the whole is a rigid body may have any: a part drawn in one piece
// whose mass was distributed by hand, a sensor of one milligram.
Inertia Assembly::inertia_of(const std::vector<const Mechanism::BodyPart*>& bodies) {
  double mass = 0;
  Vec3 first = Vec3::Zero();
  std::vector<Mat<3, 3>> parts;
  Inertia out;
  for (const Mechanism::BodyPart* body : bodies) {
    parts.push_back(moments_of(*body));
    out += inertia_at(body->mass, vec(body->at), parts.back());
    mass += body->mass;
    first += body->mass * vec(body->at);
  }
  const bool alone = bodies.size() == 1;
  const Vec3 centre = mass > 0 && !alone ? Vec3(first / mass) : vec(bodies.front()->at);
  Mat<3, 3> central = Mat<3, 3>::Zero();
  for (size_t i = 0; i < bodies.size(); ++i) {
    const Vec3 off = vec(bodies[i]->at) - centre;
    central += parts[i];
    if (!alone) central += bodies[i]->mass * parallel_axis(off, off);
  }
  // Round-off of a moment: of the largest of the whole, and of m L^2 of one whose moments are all
  // that, L the extent of the mechanism.
  const Vec3 moments = dense::symmetric_eigenvalues(central);
  const double size = moments.cwiseAbs().maxCoeff() + mass * extent_ * extent_;
  const double round_off = 1e-12 * size;
  const auto least = [&](const Mat<3, 3>& m) { return dense::symmetric_eigenvalues(m)[0]; };
  const auto worst =
      static_cast<size_t>(std::ranges::min_element(parts, {}, least) - parts.begin());
  const Mechanism::BodyPart& body = *bodies[worst];
  if (!(moments[0] >= -round_off)) {
    wrong(body, "body",
          fmt::format("inertia: a moment of {} about some axis{}, expected none below 0",
                      moments[0], alone ? "" : ", that of all that it is welded to included"));
  } else if (moments[2] > (1 + 1e-9) * (moments[0] + moments[1]) + round_off) {
    model_.notes.push_back(
        fmt::format("{}body '{}'{}: no rigid body has the principal moments {}, since {} > {} + {}",
                    body.where, body.name, alone ? "" : " with all that it is welded to",
                    join(std::vector<double>(moments.begin(), moments.end())), moments[2],
                    moments[1], moments[0]));
  } else if (const double own = least(parts[worst]); !alone && own < -round_off) {
    model_.notes.push_back(fmt::format(
        "{}body '{}': a moment of {} about some axis; with all that it is welded to none is below "
        "0",
        body.where, body.name, own));
  }
  if (!(moments[0] < 0)) return out;
  const dense::SymmetricEigen principal = dense::symmetric_eigen(central);  // to none below 0
  const Eigen::VectorXd clipped = principal.values.cwiseMax(0);
  return inertia_at(mass, centre,
                    principal.vectors * clipped.asDiagonal() * principal.vectors.transpose());
}

}  // namespace hamel
