// ceres_tiny: Levenberg-Marquardt on 1/2|F|^2, ceres::TinySolver.
//
//   (J'J + u D) dx = -J'F,   u the inverse of the trust region's radius, D = diag(J'J).
// Its tolerances are absolute: with the defaults it stops after one step on an equation scaled by
// h, at 2e-10. Here F is scaled, the cost threshold is 1/2 target^2, function and gradient
// tolerance are 0 and the radius starts at 1e16, so that the first step is Newton's. The normal
// equations square the condition number: the equation must be well conditioned. Source: Madsen,
// Nielsen, Tingleff, Methods for non-linear least squares problems, 2004; Ceres 2.1.
#pragma once

#include <memory>
#include <string>

#include <hamel/framework/loop/solver.hpp>
#include <hamel/solvers/ceres.hpp>

namespace hamel {

struct CeresTiny {
  static std::string name() { return "ceres_tiny"; }
  static std::string package() { return "libceres-dev"; }
  static std::string summary() { return "Levenberg-Marquardt on |F|^2/2, ceres::TinySolver"; }
  static std::string method() { return "(J'J + u D) dx = -J'F, first radius 1e16"; }
  static std::string stops() {
    return "the residual at two digits below the tolerance; a step of round-off size; 50 "
           "iterations";
  }
  static std::string source() { return "Madsen, Nielsen, Tingleff 2004; Ceres Solver 2.1"; }
  /// False where it is a module that is not there (framework/io/module.hpp).
  static bool found() { return Ceres::found(); }
  static std::shared_ptr<Solver> make();
};

}  // namespace hamel
