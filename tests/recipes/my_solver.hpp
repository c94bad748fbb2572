// Newton without any care, for a recipe.
#pragma once

#include <memory>
#include <string>

#include <hamel/framework/loop/solver.hpp>

namespace hamel {

struct MySolver {
  static std::string name() { return "my_solver"; }
  static std::string summary() { return "Newton, ten times"; }
  static std::string method() { return "Newton"; }
  static std::string stops() { return "the residual; else ten steps"; }
  static std::string source() { return "Newton 1669"; }
  static std::shared_ptr<Solver> make();
};

}  // namespace hamel
