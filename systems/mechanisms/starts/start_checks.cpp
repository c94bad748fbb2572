#include <hamel/systems/mechanisms/starts/start_checks.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/starts/poses.hpp>

namespace hamel::mechanisms {
namespace {

// Contradictions of rows that were dropped, at this place and time.
void add_contradictions(const Multibody& system, const StartChecks& checks, double t,
                        const std::vector<double>& place, std::vector<std::string>& out) {
  for (const ImpliedRow& row : system.implied_rows(t, place.data())) {
    if (!row.contradicts) continue;
    const RowLabel& said = checks.rows[static_cast<size_t>(row.row)];
    const std::string others = in_words(checks.dropped.at(row.row).others, checks.rows);
    out.push_back(fmt::format("{}{} at t = {}: {}; leave one of them out", said.where,
                              contradiction(said, others), t, row.in_words()));
  }
}

}  // namespace

std::vector<std::string> mistakes_at_start(const Multibody& system, const StartChecks& checks,
                                           const Inputs* inputs, double t, const double* g,
                                           std::span<const double> xi) {
  std::vector<double> x(static_cast<size_t>(system.geometry().columns()));
  system.geometry().coordinates(g, x.data());
  const InputValues u = inputs == nullptr ? InputValues() : inputs->at(t);
  const SignalInput now{t, x, xi, {u.data(), static_cast<size_t>(u.size())}};
  std::vector<std::string> out;
  for (const Watched& signal : checks.signals) {
    if (const double value = signal.value(now); !std::isfinite(value))
      out.push_back(fmt::format("{} is {} at the start", signal.what, value));
  }
  for (const Held& held : checks.held) {
    const double value = held.value(t), apart = x[held.column] - value;
    // The start may be the last state of a run, whose scheme keeps the angle to its order.
    if (!(std::abs(held.turns ? std::remainder(apart, 2 * std::numbers::pi) : apart) < 0.01))
      out.push_back(fmt::format("{} is prescribed as {} at t = {}, but {} at the start", held.what,
                                value, t, x[held.column]));
  }
  const std::vector<double> place(g, g + system.drawn().size());
  for (const auto& [row, repeat] : repeated_rows(system, place, system.holding(), {t})) {
    const std::string beyond = in_words(repeat.others, checks.rows);
    const RowLabel& said = checks.rows[static_cast<size_t>(row)];
    if (repeat.contradicts)
      out.push_back(fmt::format("{}{} at the start; start elsewhere, or leave one of them out",
                                said.where, contradiction(said, beyond)));
    else if (beyond.empty())
      out.push_back(
          fmt::format("{}{} constrains nothing at the start; start elsewhere, or leave it out",
                      said.where, said.what));
    else
      out.push_back(
          fmt::format("{}{} is implied by {} at the start; start elsewhere, or take a part "
                      "with fewer rows (a roller for a wheel)",
                      said.where, said.what, beyond));
  }
  add_contradictions(system, checks, t, place, out);
  return out;
}

}  // namespace hamel::mechanisms
