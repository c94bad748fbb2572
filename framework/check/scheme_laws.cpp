// The claims of a scheme, measured on every registered system.
#include <hamel/framework/check/scheme_laws.hpp>

#include <map>
#include <set>

#include <fmt/format.h>

namespace hamel {
namespace {

constexpr double kUntil = 0.8;        // of the runs whose order is measured
constexpr double kRoundOff = 1e-10;   // of the reference: no order is measured below it
constexpr double kHolonomic = 1e-13;  // phi, in metres
constexpr double kNotReversible =
    1e-9;  // how far a step that is not reversible ends from its start

std::vector<double> end_of(const Result& result) {
  std::vector<double> out = result.last.coordinates;
  out.insert(out.end(), result.last.velocity.begin(), result.last.velocity.end());
  return out;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// Steps until kUntil in the coarser of two runs: an error of order 1 shows its order late.
long coarse_steps(int order) { return order <= 1 ? 800 : order == 2 ? 160 : order == 3 ? 80 : 24; }
double order_bound(int order) {
  return order == 2 ? 0.05 : order <= 3 ? 0.1 : order == 4 ? 0.2 : 0.6;
}

class SchemeSuite {
 public:
  SchemeSuite(const Registry& registry, const SchemeInfo& scheme)
      : registry_(registry), scheme_(scheme) {}

  LawReport run() {
    for (const std::string& name : registry_.systems()) measure(name);
    for (const auto& [order, least] : least_order_) {
      report_.push_back({"order not above " + std::to_string(order) + " on every system",
                         std::max(0.0, least - order), order_bound(order),
                         fmt::format("at least order {:.3g}, expected {} on some", least, order)});
    }
    for (const auto& [order, error] : largest_return_) {
      report_.push_back(
          {"order " + std::to_string(order) +
               ": does not return to the start on some system, as it claims",
           error > 0 ? kNotReversible / error : 2, 1,
           fmt::format("ends {:.3g} from it, expected at least {:g}", error, kNotReversible)});
    }
    return std::move(report_);
  }

 private:
  // A system from its own start, with one retraction for each claim.
  void measure(const std::string& name) {
    SystemModel model = registry_.system(name)->make({});
    const bool left_invariant = model.mechanics->left_invariant();
    if (!scheme_.defined(left_invariant)) return;
    if (model.start.velocity.empty() && model.start.momentum.empty()) return;
    const bool free = model.mechanics->constraint_count() == 0;
    if (!scheme_.adapted && !free) return;
    exact_.clear();
    const std::vector<double> all = {0, 0.5, 1}, fixed = {scheme_.fixed_s};
    for (const double s : scheme_.uses_s ? all : fixed) {
      std::set<std::pair<int, bool>> seen;
      for (const std::string& retraction : registry_.retractions_or_common(model.group.name)) {
        const TauTraits tau = registry_.geometry(model.group.name, retraction)->traits();
        const ClaimedOrder claim = scheme_.claim(s, tau, *model.mechanics, Config().force_at);
        if (claim.order == 0 || !seen.insert({claim.order, claim.reversible}).second) continue;
        if (exact_.empty() && !find_exact(name)) return;
        where_ = ": " + name + ", " + retraction + named(s);
        Simulation simulation(registry_, name);
        simulation.scheme(scheme_.name).s(s).retraction(retraction).until(kUntil);
        check(simulation, claim, exact_);
      }
    }
  }
  bool find_exact(const std::string& name) {
    const Result reference = Simulation(registry_, name)
                                 .scheme("dop853")
                                 .tolerance({.relative = 1e-13})
                                 .until(kUntil)
                                 .run();
    if (reference.status.ok) exact_ = end_of(reference);
    else report_.push_back({"the reference by dop853: " + name, 1, 0, reference.status.reason});
    return reference.status.ok;
  }
  std::string named(double s) const {
    if (!scheme_.uses_s) return "";
    return s == 0 ? ", s = 0" : s == 1 ? ", s = 1" : ", s = 1/2";
  }

  static std::string order_seen(double order, bool shown, int claimed) {
    if (!shown) return "no error above round-off to measure an order of";
    return fmt::format("order {:.3g}, expected at least {}", order, claimed);
  }
  void add(const std::string& law, double measured, double bound) {
    report_.push_back({law + where_, measured, bound});
  }

  void check(Simulation& simulation, ClaimedOrder claim, const std::vector<double>& exact) {
    long steps = coarse_steps(claim.order);
    const auto run = [&](long count) {
      return simulation.step(kUntil / static_cast<double>(count)).every(count).run();
    };
    Result result = run(steps);
    const double bound = order_bound(claim.order);
    double coarse = distance(end_of(result), exact), order = claim.order;
    bool shown = false;  // has the error an order to measure?
    for (int k = 0; k < 3 && result.status.ok; ++k) {
      result = run(steps *= 2);
      const double fine = distance(end_of(result), exact);
      if (!(fine > kRoundOff) || !result.status.ok) break;
      order = std::log2(coarse / fine);
      shown = true;
      coarse = fine;
      if (order > claim.order - bound) break;
    }
    add("the run ends", result.status.ok ? 0 : 1, 0);
    report_.back().seen = result.status.reason;
    if (!result.status.ok) return;
    add("order at least " + std::to_string(claim.order), std::max(0.0, claim.order - order), bound);
    report_.back().seen = order_seen(order, shown, claim.order);
    if (shown) {
      const auto [at, first] = least_order_.try_emplace(claim.order, order);
      if (!first) at->second = std::min(at->second, order);
    }
    add("group defect", result.group_defect_max, 1e-14);
    if (scheme_.steps_admissible) {
      add("constraint residual, recovered from the configurations", result.constraint_max,
          constraint_floor(result));
      if (!std::isnan(result.holonomic_max))
        add("holonomic rows", result.holonomic_max, kHolonomic);
    }
    simulation.step(kUntil / static_cast<double>(coarse_steps(claim.order)));
    const double returned = reversal_error(simulation, 24);
    if (claim.reversible) add("a run with h and one with -h return to the start", returned, 1e-10);
    else if (claim.order <= 2) {
      double& largest = largest_return_[claim.order];
      largest = std::max(largest, returned);
    }
  }

  const Registry& registry_;
  const SchemeInfo& scheme_;
  LawReport report_;
  std::string where_;
  std::vector<double> exact_;  // the end of the system's motion
  std::map<int, double> least_order_, largest_return_;
};

}  // namespace

LawReport check_scheme(const Registry& registry, const std::string& scheme) {
  const SchemeInfo* info = registry.scheme(scheme);
  if (info == nullptr) throw ConfigError({unknown_name("scheme", scheme, registry.schemes())});
  return SchemeSuite(registry, *info).run();
}

}  // namespace hamel
