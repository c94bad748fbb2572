#include <hamel/groups/product_retraction.hpp>
#include <hamel/systems/contact_oscillator.hpp>
#include <hamel/systems/kernels/units.hpp>
#include <hamel/systems/knife_edge_on_incline.hpp>
#include <hamel/systems/nonholonomic_particle.hpp>
#include <hamel/systems/suslov_in_potential.hpp>
#include <hamel/systems/veselova.hpp>

namespace hamel {

void add_particles(Registry& registry) {
  add_compiled<ContactOscillator>(registry);
  add_compiled<KnifeEdgeOnIncline>(registry);
  add_compiled<NonholonomicParticle>(registry);
  add_compiled<SuslovInPotential>(registry);
  add_compiled<Veselova>(registry);
}

}  // namespace hamel
