// The entry of the module hamel_nlopt.so.
#include <hamel/solvers/nlopt.hpp>
#include <hamel/solvers/opened.hpp>

using namespace hamel;

extern "C" HAMEL_API MakeSolver HAMEL_MODULE_ENTRY;
extern "C" void HAMEL_MODULE_ENTRY(const std::string& name, std::shared_ptr<Solver>& out) {
  for (const Nlopt& algorithm : kNlopt)
    if (name == algorithm.label) out = algorithm.make();
}
