// ceres: Levenberg-Marquardt on 1/2|F|^2 by ceres::Solve, the problem kept between solves.
//
// A trust-region step by dense QR of [J; sqrt(u) D]. Function, gradient and parameter tolerance are
// 0 (the defaults leave 2e-10) and the radius starts at 1e16, so that the first step is Newton's; a
// callback stops it at the residual. It is silent and uses one thread. Of its 8 us 3.5 are the
// set-up of each call. Source: Agarwal, Mierle, Ceres Solver 2.1; Madsen, Nielsen, Tingleff 2004.
#pragma once

#include <memory>
#include <string>

#include <hamel/framework/loop/solver.hpp>

namespace hamel {

struct Ceres {
  static std::string name() { return "ceres"; }
  static std::string package() { return "libceres-dev"; }
  static std::string summary() { return "Levenberg-Marquardt on |F|^2/2, ceres::Solve"; }
  static std::string method() { return "trust-region step by dense QR of [J; sqrt(u) D]"; }
  static std::string stops() {
    return "the residual at two digits below the tolerance; 50 iterations";
  }
  static std::string source() { return "Ceres Solver 2.1; Madsen, Nielsen, Tingleff 2004"; }
  /// False where it is a module that is not there (framework/io/module.hpp).
  static bool found();
  static std::shared_ptr<Solver> make();
};

}  // namespace hamel
