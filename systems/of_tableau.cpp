#include <hamel/systems/kernels.hpp>

namespace hamel {

KernelFactory of_tableau(std::unique_ptr<Kernel> (*make)(const KernelSetup&),
                         const Tableau& tableau) {
  return [make, &tableau](const KernelSetup& setup) {
    KernelSetup with_tableau = setup;
    with_tableau.tableau = &tableau;
    return make(with_tableau);
  };
}

}  // namespace hamel
