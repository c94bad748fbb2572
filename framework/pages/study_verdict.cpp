// A study's verdicts: each sentence is computed from the cells, and states how many of them it
// rests on. Here whether the runs can be relied on; methods against each other in
// study_comparison.cpp.
#include <hamel/framework/pages/study_verdict.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace hamel::pages {
namespace {

constexpr double kLost = 0.3;  // of the motion's extent: an error that is no approximation
constexpr double kGoodEnergy = 1e-3;
constexpr double kSolversAgree = 1e-10;

class StudyJudge {
 public:
  explicit StudyJudge(const StudyResult& result) : view_(result) {}

  std::vector<Verdict> all() {
    counts();
    failures();
    compare_methods(view_, out_);
    saturated();
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
    say(ok == view_.run().size() && view_.result().config.reference ? "ok" : "note", text);
  }

  // Says a sentence for each reason. A cell that fails is a result, and nothing wrong with the
  // study.
  void failures() {
    std::map<std::string, std::vector<size_t>> by_reason;
    for (const size_t i : view_.run())
      if (!view_.metrics(i).ok) by_reason[view_.metrics(i).reason].push_back(i);
    for (const auto& [reason, cells] : by_reason) {
      std::map<std::string, size_t> by_solver;
      for (const size_t i : cells) ++by_solver[view_.cell(i).axes.at("solver")];
      std::string solvers;
      for (const auto& [solver, count] : by_solver)
        if (!solver.empty())
          solvers += fmt::format("{}`{}` {}", solvers.empty() ? " (" : ", ", solver, count);
      say("note", fmt::format("{} failed: {}{}. Where: {}.", plural(cells.size(), "cell"), reason,
                              solvers.empty() ? "" : solvers + ")", view_.where(cells)));
    }
  }

  // Is the error no smaller than the motion itself?
  bool lost(size_t i) const {
    return view_.metrics(i).ok &&
           view_.metrics(i).error > kLost * view_.result().references[view_.cell(i).system].extent;
  }
  void saturated() {
    std::vector<size_t> cells;
    for (const size_t i : view_.run())
      if (lost(i)) cells.push_back(i);
    if (cells.empty()) return;
    say("note",
        fmt::format("{} {} saturated: an error above {} of the motion means that the motion "
                    "is lost, not by how much. Where: {}.",
                    plural(cells.size(), "cell"), cells.size() == 1 ? "is" : "are", kLost,
                    view_.where(cells)));
  }

  void energy() {
    std::vector<size_t> kept;
    double least = std::numeric_limits<double>::infinity();
    for (const size_t i : view_.run()) {
      const StudyMetrics& m = view_.metrics(i);
      if (m.energy_error < kGoodEnergy && lost(i)) {
        kept.push_back(i);
        least = std::min(least, m.energy_error);
      }
    }
    if (kept.empty()) return;
    const bool one = kept.size() == 1;
    say("note",
        fmt::format("Energy proves nothing: {} {} the energy to {:.0e} (the best to {:.1e}) "
                    "and {} off by more than {} of the motion. Where: {}.",
                    plural(kept.size(), "cell"), one ? "keeps" : "keep", kGoodEnergy, least,
                    one ? "is" : "are", kLost, view_.where(kept)));
  }

  // Groups of otherwise equal cells that some solvers solve and others do not.
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
        "Where the solvers end: of {} of otherwise equal cells {} {} solved by all, {} by none, {} "
        "by some.",
        plural(all + none + some, "group"), all, all == 1 ? "is" : "are", none, some);
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
      say("ok", fmt::format("The solvers agree: {} {} within {:.1e} of the first solver's.",
                            plural(count, "run"), count == 1 ? "ends" : "end", largest));
    } else {
      say("failed",
          fmt::format("{} of {} {} more than {:.0e} from the first solver's, at most "
                      "{:.1e}. Where: {}.",
                      apart.size(), plural(count, "run"), apart.size() == 1 ? "ends" : "end",
                      kSolversAgree, largest, view_.where(apart)));
    }
  }

  // Verdicts on the references, whose table is separate (study_tables.cpp).
  void references() {
    if (!view_.result().config.reference) return;
    size_t runs = 0;
    double bound = 0;
    for (size_t i = 0; i < view_.result().references.size(); ++i) {
      const StudyReference& reference = view_.result().references[i];
      if (reference.kind.starts_with("none") || reference.kind.starts_with("not converged"))
        say("note", fmt::format("{} has nothing to compare with: {}.",
                                view_.result().config.systems[i].label, reference.kind));
      if (!reference.kind.starts_with("converged")) continue;
      ++runs;
      bound = std::max(bound, reference.bound);
    }
    if (runs > 0)
      say("note", fmt::format("Of {} errors are distances from a reference run whose own error is "
                              "at most {:.1e}.",
                              plural(runs, "system"), bound));
  }

  StudyView view_;
  std::vector<Verdict> out_;
};

}  // namespace

std::string plural(size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::vector<Verdict> study_verdicts(const StudyResult& result) { return StudyJudge(result).all(); }

}  // namespace hamel::pages
