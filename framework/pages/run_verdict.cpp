#include <hamel/framework/pages/run_verdict.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/figures/run_figures.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel::pages {
namespace {

// The largest distance of the element from its start, and the largest velocity.
struct Sizes {
  double extent = 0, speed = 0;
};

Sizes sizes_of(const Result& r) {
  Sizes out;
  if (r.trajectory.rows() == 0) return out;
  const size_t columns = r.system->group.columns.size(), xi = 1 + columns;
  const auto start = r.trajectory.row(0).subspan(1, columns);
  for (size_t i = 0; i < r.trajectory.rows(); ++i) {
    const auto row = r.trajectory.row(i);
    out.extent = std::max(out.extent, euclidean_distance(row.subspan(1, columns), start));
    double square = 0;
    for (const double v : row.subspan(xi, static_cast<size_t>(r.system->group.dim)))
      square += v * v;
    out.speed = std::max(out.speed, std::sqrt(square));
  }
  return out;
}

// An error of the configuration beside the size of the motion.
std::string part_of(double error, double extent) {
  if (!(extent > 0)) return "";
  const double percent = 100 * error / extent;
  return percent < 1e-3  ? " (below 0.001 % of the motion)"
         : percent < 100 ? fmt::format(" ({:.2g} % of the motion)", percent)
                         : fmt::format(" ({:.3g} times the motion)", error / extent);
}

class Judge {
 public:
  explicit Judge(const Result& r) : r_(r), size_(sizes_of(r)), zero_(figures::round_off(r)) {}

  RunVerdict verdict() {
    std::string text = error();
    text += fmt::format(
        "; {} at most {:.1e}{}, group defect at most {:.1e}. {} steps {} to t = {:.6g}.",
        figures::does_work(r_) ? "defect of the energy balance" : "energy error",
        r_.energy_error_max,
        std::isnan(r_.constraint_max)
            ? ""
            : fmt::format(", constraint residual at most {:.1e}", r_.constraint_max),
        r_.group_defect_max, r_.steps,
        r_.config.chooses_steps() ? "chosen by the error"
                                  : fmt::format("of h = {}", r_.config.step_or_usual()),
        r_.last.time);
    if (!ok_ && !unknown_) text += fmt::format(" **Off by more than {:g} %**.", 100 * kSmallError);
    text += constraint() + energy();
    if (r_.stats.fallbacks > 0) {
      const Fallback& first = r_.stats.first_fallbacks.front();
      text += fmt::format(" {} steps failed and were rescued, the first at t = {:.6g}: {}.",
                          r_.stats.fallbacks, first.time, first.action);
    }
    return {ok_ ? "ok" : "note", text};
  }

 private:
  bool small(double error, double size) const { return error <= kSmallError * size + 1e3 * zero_; }

  // How far off it is, as far as that is known.
  std::string error() {
    if (std::isfinite(r_.exact_error_max)) {
      ok_ = small(r_.exact_error_max, size_.extent) &&
            small(r_.exact_velocity_error_max, size_.speed);
      return fmt::format(
          "Against the exact motion the configuration is off by at most **{:.1e}**{}, the velocity "
          "by at most **{:.1e}**",
          r_.exact_error_max, part_of(r_.exact_error_max, size_.extent),
          r_.exact_velocity_error_max);
    }
    const char* finer = finer_runs(r_.config);
    if (std::isfinite(r_.estimated_error)) {
      ok_ = small(r_.estimated_error, size_.extent);
      if (std::isnan(r_.observed_order)) {
        return fmt::format(
            "By {}, which agree to round-off and show no order, its end is off by less than "
            "**{:.1e}**, unless all stepped over something shorter than a step",
            finer, r_.estimated_error);
      }
      return fmt::format("By {} its end is off by about **{:.1e}**{}", finer, r_.estimated_error,
                         part_of(r_.estimated_error, size_.extent));
    }
    ok_ = false;
    unknown_ = true;
    std::string out = fmt::format("It {}; **its error is not known**: ",
                                  r_.status.reason.empty() ? "ran to the end" : r_.status.reason);
    if (r_.config.check) return out + fmt::format("{} give no estimate", finer);
    if (r_.config.no_exact) out += "the exact motion was left out (`--no-exact`), and ";
    return out + "`--check` estimates it";
  }

  // An estimate does not see it: without the constraint it is the error of another motion.
  std::string constraint() {
    const double floor = zero_ / std::abs(r_.config.step_or_usual());
    if (!(r_.constraint_max > kKeptConstraint * size_.speed + 1e3 * floor)) return "";
    if (!std::isfinite(r_.exact_error_max)) ok_ = false;
    return fmt::format(" **The steps leave the constraint**, by up to {:.1e}.", r_.constraint_max);
  }

  std::string energy() {
    if (figures::does_work(r_) || r_.energy_error_max <= kSmallError) return "";
    ok_ = false;
    return " **The energy changes** though nothing does work.";
  }

  const Result& r_;
  const Sizes size_;
  const double zero_;  // round-off of the coordinates
  bool ok_ = true, unknown_ = false;
};

}  // namespace

RunVerdict run_verdict(const Result& r) {
  if (r.status.ok) return Judge(r).verdict();
  return {
      "failed",
      fmt::format("Failed in step {} at t = {:.6g}: {} (residual {:.2e}). {} good steps are kept.",
                  r.status.step, r.status.time, r.status.reason, r.status.residual, r.steps)};
}

}  // namespace hamel::pages
