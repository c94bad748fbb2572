// The solvers of Ceres, of the module hamel_ceres.so.
#include <hamel/solvers/ceres.hpp>
#include <hamel/solvers/ceres_tiny.hpp>
#include <hamel/solvers/opened.hpp>

namespace hamel {
namespace {

std::shared_ptr<Solver> made(const std::string& name) {
  static const Module module = open_module("ceres");
  return make_opened(module, name);
}

}  // namespace

bool Ceres::found() {
  static const bool there = !module_path("ceres").empty();
  return there;
}
std::shared_ptr<Solver> Ceres::make() { return made(name()); }
std::shared_ptr<Solver> CeresTiny::make() { return made(name()); }

}  // namespace hamel
