// Which method of a study is better: the least time at equal error, orders against claims, and
// which value of an axis is worse and by how much.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/pages/study_verdict.hpp>

namespace hamel::pages {
namespace {

// The first ones of a list, and how many more there are.
std::string first_few(const std::vector<std::string>& words, size_t count) {
  std::string out;
  for (size_t i = 0; i < std::min(words.size(), count); ++i)
    out += fmt::format("{}{}", i == 0 ? "" : "; ", words[i]);
  if (words.size() > count) out += fmt::format("; and {} more", words.size() - count);
  return out;
}

class Comparison {
 public:
  Comparison(const StudyView& view, std::vector<Verdict>& out) : view_(view), out_(out) {}

  void all() {
    if (view_.result().config.reference) {
      Verdict fastest{"note",
                      "The least time at equal error, for each system, and the methods behind it:",
                      {"system", "error", "least time [s]", "by", "next", "ratio", "slowest",
                       "ratio", "not reached by"}};
      for (const auto& [system, cells] : view_.groups({"system"})) best(system[0], cells, fastest);
      if (!fastest.rows.empty()) out_.push_back(std::move(fastest));
      orders();
    }
    for (const std::string& axis : view_.varying_without({"system", "step", "rtol"})) worse(axis);
  }

 private:
  void say(const std::string& status, const std::string& text) { out_.push_back({status, text}); }

  // The time at which a method reaches an error, by straight lines between its cells in the
  // diagram; the time of the fastest cell that is good enough when no line crosses. NaN: never.
  double time_at(std::vector<size_t> cells, double error) const {
    std::erase_if(cells, [&](size_t i) {
      return !view_.metrics(i).ok || !(view_.metrics(i).error >= 0) || !(view_.seconds(i) > 0);
    });
    std::sort(cells.begin(), cells.end(),
              [&](size_t a, size_t b) { return view_.seconds(a) < view_.seconds(b); });
    for (size_t k = 0; k < cells.size(); ++k) {
      const double e1 = view_.metrics(cells[k]).error, t1 = view_.seconds(cells[k]);
      if (e1 > error) continue;
      if (k == 0) return t1;
      const double e0 = view_.metrics(cells[k - 1]).error, t0 = view_.seconds(cells[k - 1]);
      if (!(e1 > 0) || !(e0 > e1)) return t1;
      const double part = std::log(e0 / error) / std::log(e0 / e1);
      return t0 * std::pow(t1 / t0, std::clamp(part, 0.0, 1.0));
    }
    return kNotMeasured;
  }

  // Warning about a control, which wins by chance if it does: "" for all others.
  std::string warning(const std::vector<size_t>& cells) const {
    double left = 0;
    for (const size_t i : cells) {
      if (view_.cell(i).claimed_order > 0) return "";
      if (view_.metrics(i).constraint > left) left = view_.metrics(i).constraint;
    }
    if (cells.empty()) return "";
    const std::string control = "a control: it claims no order";
    return left > 1e-9 ? control + fmt::format(", and leaves the constraint by up to {:.1e}", left)
                       : control;
  }

  void best(const std::string& system, const std::vector<size_t>& of_system, Verdict& fastest) {
    const std::vector<std::string> axes = view_.varying_without({"system", "step", "rtol"});
    if (axes.empty()) return;
    std::map<std::string, std::vector<size_t>> methods;
    for (const size_t i : of_system) methods[view_.words(i, axes)].push_back(i);
    const auto called = [&](const std::string& name) {
      const std::string remark = warning(methods.at(name));
      return name + (remark.empty() ? "" : " (" + remark + ")");
    };
    // The error that a third of the methods reach, as a power of ten.
    std::vector<double> reached;
    for (const auto& [name, cells] : methods) {
      double least = std::numeric_limits<double>::infinity();
      for (const size_t i : cells)
        if (view_.metrics(i).ok && view_.metrics(i).error >= 0)
          least = std::min(least, std::max(view_.metrics(i).error, 1e-14));
      reached.push_back(least);
    }
    std::sort(reached.begin(), reached.end());
    const double third = reached[(reached.size() - 1) / 3];
    if (!std::isfinite(third)) return;
    double extent = 0;  // nothing above a tenth of it is worth comparing
    for (const size_t i : of_system)
      extent = view_.result().references[view_.cell(i).system].extent;
    const double target = std::min(std::pow(10.0, std::ceil(std::log10(third))),
                                   std::pow(10.0, std::floor(std::log10(kAsymptotic * extent))));
    if (!(target > 0)) return;  // nothing moves
    std::vector<std::pair<double, std::string>> ranked;
    std::vector<std::string> never;
    for (const auto& [name, cells] : methods) {
      const double time = time_at(cells, target);
      if (time > 0) {
        ranked.emplace_back(time, name);
      } else {
        never.push_back(name);
      }
    }
    std::sort(ranked.begin(), ranked.end());
    std::vector<Cell>& row = fastest.rows.emplace_back(std::vector<Cell>{system, target});
    const auto add = [&](bool there, size_t k) {
      row.emplace_back(there ? called(ranked[k].second) : "");
      row.emplace_back(there ? ranked[k].first / ranked[0].first : kNotMeasured);
    };
    row.emplace_back(ranked.empty() ? kNotMeasured : ranked[0].first);
    row.emplace_back(ranked.empty() ? "" : called(ranked[0].second));
    add(ranked.size() > 1, 1);
    add(ranked.size() > 2, ranked.size() - 1);
    row.emplace_back(first_few(never, 4));
  }

  // Methods by what was measured of the order that their scheme claims.
  struct Orders {
    size_t measured = 0, reach = 0;
    double worst = std::numeric_limits<double>::infinity();  // order less claim of those that reach
    std::vector<std::string> short_of, late, unsettled, unknown;
  };

  Orders measured_orders() const {
    std::vector<std::string> axes = study_axes();
    std::erase_if(axes, [](const std::string& axis) { return axis == "step" || axis == "rtol"; });
    Orders out;
    for (const auto& [key, cells] : view_.groups(axes)) {
      const StudyMetrics& m = view_.metrics(cells.front());
      const std::string name = "`" + view_.name(cells.front()) + "`";
      const int claim = view_.cell(cells.front()).claimed_order;
      if (m.order_of < 2 || claim == 0) continue;
      const std::string verdict = view_.order_verdict(cells);
      if (verdict == "not measured") {
        out.unknown.push_back(name);
        continue;
      }
      ++out.measured;
      if (verdict == "ok") {
        ++out.reach;
        out.worst = std::min(out.worst, m.order - claim);
        continue;
      }
      auto& list = verdict == "finest only"       ? out.late
                   : verdict == "below its claim" ? out.short_of
                                                  : out.unsettled;
      list.push_back(fmt::format("{} {:.2f} of {} ({} of {} steps; the two finest {:.2f})", name,
                                 m.order, claim, m.order_points, m.order_of, m.order_finest));
    }
    return out;
  }

  void say_measured(const Orders& found) {
    std::string text =
        found.measured == 1
            ? fmt::format("The one measured order {} the claim of its scheme to {}",
                          found.reach == 1 ? "reaches" : "does not reach", kShortOfClaim)
            : fmt::format("{} of {} measured orders {} the claim of their scheme to {}",
                          found.reach, found.measured, found.reach == 1 ? "reaches" : "reach",
                          kShortOfClaim);
    if (found.reach > 0) text += fmt::format(" (at worst {:+.2f})", found.worst);
    text += ".";
    if (!found.late.empty())
      text += " Only with the finest steps: " + first_few(found.late, 6) + ".";
    if (!found.short_of.empty()) text += " Below it: " + first_few(found.short_of, 8) + ".";
    say(!found.short_of.empty() ? "failed" : found.unsettled.empty() ? "ok" : "note", text);
    if (!found.unsettled.empty())
      say("note", "Not in the asymptotic range, no order is derived: " +
                      first_few(found.unsettled, 8) + ".");
  }

  void orders() {
    const Orders found = measured_orders();
    if (found.measured > 0) say_measured(found);
    if (!found.unknown.empty())
      say("note",
          fmt::format("{}: fewer than two steps have an error above the floor and below {} of "
                      "the motion: {}.",
                      plural(found.unknown.size(), "method") + " without an order", kAsymptotic,
                      first_few(found.unknown, 6)));
  }

  // Sums over the groups of otherwise equal cells that a value of an axis is in; error and time as
  // logarithms of their ratio to the best of the group.
  struct Tally {
    double error = 0, time = 0;
    size_t groups = 0, timed = 0, worst = 0, failed = 0;
    std::vector<size_t> cells;
  };
  using Tallies = std::map<std::string, Tally>;  // by value

  // Error of a cell; all below the floor are equal.
  double error(size_t i) const {
    const StudyMetrics& m = view_.metrics(i);
    return std::isnan(m.floor) ? m.floor : std::max(m.error, m.floor);
  }

  // Adds a group of otherwise equal cells. False where fewer than two of them have an error: there
  // only failures are counted.
  bool add_group(const std::string& axis, const std::vector<size_t>& cells,
                 Tallies& tallies) const {
    const auto tally_of = [&](size_t i) -> Tally& { return tallies[view_.cell(i).axes.at(axis)]; };
    double least = std::numeric_limits<double>::infinity(), fastest = least, largest = 0;
    std::vector<size_t> good;
    for (const size_t i : cells) {
      if (!view_.metrics(i).ok) {
        ++tally_of(i).failed;
      } else if (std::isfinite(error(i))) {
        good.push_back(i);
        least = std::min(least, error(i));
        largest = std::max(largest, error(i));
        if (view_.seconds(i) > 0) fastest = std::min(fastest, view_.seconds(i));
      }
    }
    if (good.size() < 2) return false;
    for (const size_t i : good) {
      Tally& tally = tally_of(i);
      ++tally.groups;
      tally.cells.push_back(i);
      tally.error += std::log(error(i) / least);
      if (view_.seconds(i) > 0) {
        ++tally.timed;
        tally.time += std::log(view_.seconds(i) / fastest);
      }
      if (error(i) == largest && largest > 1.05 * least) ++tally.worst;
    }
    return true;
  }

  // Which value of an axis is worse at otherwise equal cells: geometric means of the factor over
  // the best.
  void worse(const std::string& axis) {
    Tallies tallies;
    size_t compared = 0;
    for (const auto& cells : view_.otherwise_equal(axis))
      if (add_group(axis, cells, tallies)) ++compared;
    if (compared == 0) return;
    const auto mean = [](double sum, size_t n) {
      return n == 0 ? kNotMeasured : std::exp(sum / static_cast<double>(n));
    };
    std::pair<double, std::string> wrong = {1.05, ""}, slow = {1.05, ""};
    Verdict verdict{"note", "", {axis, "error ratio", "time ratio", "worst in"}};
    const auto values = view_.values(axis);
    const bool controls =
        axis == "scheme" && std::any_of(values.begin(), values.end(), [&](const auto& v) {
          return !warning(tallies[v].cells).empty();
        });
    const bool failures = std::any_of(values.begin(), values.end(),
                                      [&](const auto& v) { return tallies[v].failed > 0; });
    if (failures) verdict.columns.emplace_back("failed");
    if (controls) verdict.columns.emplace_back("remark");
    for (const std::string& value : values) {
      const Tally& tally = tallies[value];
      if (tally.groups + tally.failed == 0) continue;
      const double error = mean(tally.error, tally.groups), time = mean(tally.time, tally.timed);
      if (error > wrong.first) wrong = {error, value};
      if (time > slow.first) slow = {time, value};
      std::vector<Cell>& row = verdict.rows.emplace_back(
          std::vector<Cell>{value, error, time, static_cast<double>(tally.worst)});
      if (failures) row.emplace_back(static_cast<double>(tally.failed));
      if (controls) row.emplace_back(warning(tally.cells));
    }
    verdict.text = fmt::format(
        "**{}**, {} of otherwise equal cells: {}{}. Error and time over the best of the group, as "
        "geometric means:",
        axis, plural(compared, "group"),
        wrong.second.empty() ? "none is worse in error" : "worst in error `" + wrong.second + "`",
        slow.second.empty() ? "" : ", slowest `" + slow.second + "`");
    out_.push_back(std::move(verdict));
  }

  const StudyView& view_;
  std::vector<Verdict>& out_;
};

}  // namespace

void compare_methods(const StudyView& view, std::vector<Verdict>& out) {
  Comparison(view, out).all();
}

}  // namespace hamel::pages
