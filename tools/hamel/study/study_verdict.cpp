// A study's verdicts: each sentence is computed from the cells, and says how many of them it rests on. Here
// whether the runs can be relied on; methods against each other in study_comparison.cpp.
#include "study_verdict.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace hamel::tools {
namespace {

constexpr double kLost = 0.3;  // of the motion's extent: an error that is no approximation
constexpr double kGoodEnergy = 1e-3;
constexpr double kSolversAgree = 1e-10;

class Judge {
 public:
  explicit Judge(const StudyResult& result) : view_(result) {}

  std::vector<Verdict> all() {
    counts();
    failures();
    compare_methods(view_, out_);
    energy();
    solvers();
    references();
    return std::move(out_);
  }

 private:
  void say(const std::string& status, const std::string& text) { out_.push_back({status, text}); }

  void counts() {
    std::map<std::string, size_t> skipped;
    for (const StudyCell& cell : view_.result().cells)
      if (!cell.runs()) ++skipped[cell.skipped];
    const auto ok = static_cast<size_t>(std::count_if(
        view_.run().begin(), view_.run().end(), [&](size_t i) { return view_.metrics(i).ok; }));
    std::string text = fmt::format("{} run: {} ok, {} failed.", plural(view_.run().size(), "cell"),
                                   ok, view_.run().size() - ok);
    if (!skipped.empty()) {
      std::string words;
      for (const auto& [kind, count] : skipped)
        words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, kind);
      text += fmt::format(" Not run, each listed below with its reason: {}.", words);
    }
    say(ok == view_.run().size() ? "ok" : "note", text);
  }

  // One sentence for each reason and solver, if one was used.
  void failures() {
    std::map<std::pair<std::string, std::string>, std::vector<size_t>> by_reason;
    for (const size_t i : view_.run())
      if (!view_.metrics(i).ok)
        by_reason[{view_.metrics(i).reason, view_.cell(i).axes.at("solver")}].push_back(i);
    for (const auto& [key, cells] : by_reason)
      say("failed", fmt::format("{} failed{}: {}. Where: {}.", plural(cells.size(), "cell"),
                                key.second.empty() ? "" : ", `" + key.second + "`", key.first,
                                view_.where(cells)));
  }

  void energy() {
    std::vector<size_t> lost;
    double least = std::numeric_limits<double>::infinity();
    for (const size_t i : view_.run()) {
      const StudyMetrics& m = view_.metrics(i);
      if (m.ok && m.energy_error < kGoodEnergy &&
          m.error > kLost * view_.result().references[view_.cell(i).system].extent) {
        lost.push_back(i);
        least = std::min(least, m.energy_error);
      }
    }
    if (lost.empty()) return;
    say("note",
        fmt::format("Energy proves nothing: {} keep the energy to {:.0e} (the best to {:.1e}) "
                    "and are off by more than {} of the motion. Where: {}.",
                    plural(lost.size(), "cell"), kGoodEnergy, least, kLost, view_.where(lost)));
  }

  // Where some solvers find a step's solution and others do not.
  void basins() {
    std::map<std::string, size_t> failed;
    std::vector<size_t> mixed;
    size_t all = 0, none = 0, some = 0;
    for (const auto& cells : view_.otherwise_equal("solver")) {
      const auto good = static_cast<size_t>(
          std::count_if(cells.begin(), cells.end(), [&](size_t i) { return view_.metrics(i).ok; }));
      ++(good == cells.size() ? all : good == 0 ? none : some);
      if (good == 0 || good == cells.size()) continue;
      for (const size_t i : cells)
        if (!view_.metrics(i).ok) {
          ++failed[view_.cell(i).axes.at("solver")];
          mixed.push_back(i);
        }
    }
    if (none + some == 0) return;
    std::string text = fmt::format(
        "Where the solvers end: of {} otherwise equal cells {} are solved by "
        "all, {} by none, {} by some.",
        all + none + some, all, none, some);
    if (some > 0) {
      std::string words;
      for (const std::string& solver : view_.values("solver"))
        words += fmt::format("{}`{}` {}", words.empty() ? "" : ", ", solver, failed[solver]);
      text +=
          fmt::format(" Of those, failed by: {}. Where: {}.", words, view_.where(mixed, "solver"));
    }
    say("note", text);
  }

  void solvers() {
    if (!view_.varies("solver")) return;
    basins();
    double largest = 0;
    std::vector<size_t> apart;
    size_t count = 0;
    for (const size_t i : view_.run()) {
      const double d = view_.metrics(i).solver_difference;
      if (std::isnan(d)) continue;
      ++count;
      largest = std::max(largest, d);
      if (d > kSolversAgree) apart.push_back(i);
    }
    if (count == 0) return;
    if (apart.empty()) {
      say("ok", fmt::format("The solvers agree: {} end within {:.1e} of the first solver's.",
                            plural(count, "run"), largest));
    } else {
      say("failed", fmt::format("{} of {} end more than {:.0e} from the first solver's, at most "
                                "{:.1e}. Where: {}.",
                                apart.size(), plural(count, "run"), kSolversAgree, largest,
                                view_.where(apart)));
    }
  }

  void references() {
    for (size_t i = 0; i < view_.result().references.size(); ++i) {
      const StudyReference& reference = view_.result().references[i];
      const std::string& label = view_.result().config.systems[i].label;
      if (reference.kind.starts_with("none") || reference.kind.starts_with("not converged"))
        say("failed", fmt::format("{} has nothing to compare with: {}.", label, reference.kind));
      else if (reference.kind.starts_with("converged"))
        say("note", fmt::format("{}: errors are distances from a {} whose own error is at most "
                                "{:.1e}.",
                                label, "reference run (" + reference.kind + ")", reference.bound));
    }
  }

  StudyView view_;
  std::vector<Verdict> out_;
};

}  // namespace

std::string plural(size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::vector<Verdict> study_verdicts(const StudyResult& result) { return Judge(result).all(); }

}  // namespace hamel::tools
