#include <hamel/groups/product_retraction.hpp>
#include <hamel/systems/ball_on_turntable.hpp>
#include <hamel/systems/chaplygin_ball.hpp>
#include <hamel/systems/kernels/units.hpp>
#include <hamel/systems/rolling_ball.hpp>
#include <hamel/systems/routh_sphere.hpp>

namespace hamel {

void add_balls(Registry& registry) {
  add_compiled<BallOnTurntable>(registry);
  add_compiled<ChaplyginBall>(registry);
  add_compiled<RollingBall>(registry);
  add_compiled<RouthSphere>(registry);
}

}  // namespace hamel
