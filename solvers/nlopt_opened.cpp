// The solvers of NLopt, of the module hamel_nlopt.so.
#include <hamel/solvers/nlopt.hpp>
#include <hamel/solvers/opened.hpp>

namespace hamel {

bool Nlopt::found() {
  static const bool there = !module_path("nlopt").empty();
  return there;
}
std::shared_ptr<Solver> Nlopt::make() const {
  static const Module module = open_module("nlopt");
  return make_opened(module, label);
}

}  // namespace hamel
