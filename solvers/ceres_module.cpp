// The entry of the module hamel_ceres.so.
#include <hamel/solvers/ceres.hpp>
#include <hamel/solvers/ceres_tiny.hpp>
#include <hamel/solvers/opened.hpp>

using namespace hamel;

extern "C" HAMEL_API MakeSolver HAMEL_MODULE_ENTRY;
extern "C" void HAMEL_MODULE_ENTRY(const std::string& name, std::shared_ptr<Solver>& out) {
  out = name == Ceres::name() ? Ceres::make() : CeresTiny::make();
}
