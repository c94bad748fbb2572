// Contacts of a run, checked before it.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/run/run/plan/plan.hpp>
#include <hamel/framework/schemes/nonsmooth.hpp>

namespace hamel {
namespace {

void check_law(const SystemModel& system, const ContactLaw& law, Mistakes& mistakes) {
  const auto wrong = [&](const char* what, double got, const char* expected) {
    mistakes.add(fmt::format("contact '{}' of {}: {}: got {}, expected {}", law.name, system.name,
                             what, got, expected));
  };
  if (!(law.friction >= 0 && std::isfinite(law.friction)))
    wrong("friction", law.friction, "a number of at least 0");
  if (!(law.static_friction >= 0 && std::isfinite(law.static_friction)))
    wrong("static_friction", law.static_friction, "a number of at least 0");
  if (!(law.tangential_restitution >= 0 && law.tangential_restitution <= 1))
    wrong("tangential_restitution", law.tangential_restitution, "a number in [0, 1]");
  if (!(law.restitution >= 0 && law.restitution <= 1))
    wrong("restitution", law.restitution, "a number in [0, 1]");
  if (!law.normal && !(law.load >= 0 && std::isfinite(law.load)))
    wrong("load", law.load, "a number of at least 0, N");
  const int rows = system.mechanics->constraint_count(),
            first = rows - system.mechanics->holonomic_rows();
  const auto is_row = [&](int row) { return row >= 0 && row < first; };
  if (law.tangential.size() > 2 || !std::ranges::all_of(law.tangential, is_row)) {
    mistakes.add(
        fmt::format("contact '{}' of {}: tangential: expected at most two rows of A from 0 to {}, "
                    "which are not "
                    "holonomic",
                    law.name, system.name, first - 1));
  }
  if (law.normal && !(*law.normal >= first && *law.normal < rows)) {
    mistakes.add(fmt::format("contact '{}' of {}: normal: got {}, expected a holonomic row, {}",
                             law.name, system.name, *law.normal,
                             rows > first ? fmt::format("{} to {}", first, rows - 1)
                                          : std::string("of which there is none")));
  }
}

}  // namespace

void check_contacts(const SystemModel& system, const Config& config, const SchemeInfo* scheme,
                    Mistakes& mistakes) {
  const auto& laws = system.contact_laws;
  if (laws.empty()) {
    if (config.slip)
      mistakes.add(fmt::format("slip: no contact of {} may slide: give friction where it has it",
                               system.name));
    return;
  }
  if (mistakes.none())  // else its parameters are refused already
    for (const ContactLaw& law : laws) check_law(system, law, mistakes);
  const bool nonsmooth = scheme != nullptr && scheme->name == Nonsmooth::name();
  if (nonsmooth) {
    if (config.compose != "none")
      mistakes.add(fmt::format(
          "compose: {}: with impulses of contacts nonsmooth has no compositions", config.compose));
    if (config.on_failure != "stop")
      mistakes.add(
          fmt::format("on_failure: got '{}', expected stop: nonsmooth takes its steps as "
                      "they are",
                      config.on_failure));
  } else if (scheme != nullptr && !scheme->estimates_error) {
    mistakes.add(
        fmt::format("scheme: {} has no dense output, on which contacts switch; with friction "
                    "dop853, dopri5 and tsit5 are offered, and nonsmooth, of steps of one size",
                    scheme->name));
  } else if (!config.chooses_steps()) {
    mistakes.add(
        fmt::format("step: got {}, expected rtol: with friction the steps are chosen by the error",
                    config.step_or_usual()));
  }
  if (config.until < config.from)
    mistakes.add(fmt::format(
        "until: got {}, expected a time behind from, {}: a motion with friction or impacts is not "
        "determined backwards in time",
        config.until, config.from));
}

}  // namespace hamel
