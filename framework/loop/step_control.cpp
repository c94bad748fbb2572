#include <hamel/framework/loop/step_control.hpp>

namespace hamel {
namespace {

// G, by a symmetric difference along the motion: odd whatever its error, and wide, so that
// round-off does not show.
double growth(MotionRate& motion) {
  const double size = motion.here(), d = 0.01 / size;
  const double before = motion.beside(-d), after = motion.beside(d);
  return size > 0 ? (std::log(after) - std::log(before)) / (2 * d) : 0;
}

}  // namespace

double ReversibleControl::next(MotionRate& motion, double epsilon, double direction) {
  epsilon = std::copysign(epsilon, direction);
  if (!started_) {
    density_ = motion.here() + epsilon / 2 * growth(motion);
    started_ = true;
  } else if (direction * direction_ < 0) {
    direction_ = direction;
    return direction;  // the last step, cut or not
  } else {
    density_ += epsilon * growth(motion);
  }
  direction_ = direction;
  if (!(density_ > 0)) density_ = motion.here();  // (a rate that falls faster than the steps see)
  return density_ > 0 ? epsilon / density_ : direction;  // at rest: of the last size
}

}  // namespace hamel
