// The solvers of a module (framework/io/module.hpp), opened when the first of them is made. Not
// installed.
#pragma once

#include <memory>
#include <string>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/module.hpp>
#include <hamel/framework/loop/solver.hpp>

namespace hamel {

/// The entry of such a module: makes its solver of that name.
using MakeSolver = void(const std::string& name, std::shared_ptr<Solver>& out);

/// ConfigError where the module cannot be opened.
inline std::shared_ptr<Solver> make_opened(const Module& module, const std::string& name) {
  if (module.entry == nullptr)
    throw ConfigError({fmt::format("solver '{}': {}", name, module.reason)});
  std::shared_ptr<Solver> out;
  reinterpret_cast<MakeSolver*>(module.entry)(name, out);
  return out;
}

}  // namespace hamel
