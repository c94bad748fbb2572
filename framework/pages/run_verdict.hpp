// The first statement of a page about a run: whether it is right, as far as that is known.
#pragma once

#include <string>

#include <hamel/framework/run/record/result.hpp>

namespace hamel::pages {

/// An error above this part of the motion is not small.
constexpr double kSmallError = 0.01;
/// A constraint residual above this part of the velocity is no round-off.
constexpr double kKeptConstraint = 1e-6;

struct RunVerdict {
  std::string status;  // "ok", "note" or "failed"
  std::string text;
};

/// "ok" only where the error is known, against the exact motion or as an estimate, and small, the
/// energy is kept where nothing does work, and the constraint where the exact motion is not known.
/// "note" where one of these is not so or not known.
RunVerdict run_verdict(const Result& result);

}  // namespace hamel::pages
