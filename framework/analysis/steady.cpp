// The eigenvalues about a steady motion, and how well they are known.
#include <hamel/framework/analysis/steady.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <hamel/framework/analysis/matching.hpp>
#include <hamel/framework/analysis/steady_equations.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel {
namespace reduced {
namespace {

std::vector<Complex> eigenvalues_of(const Matrix& m) {
  const Eigen::VectorXcd values = dense::eigenvalues(m);
  return {values.begin(), values.end()};
}

// How far each eigenvalue moves when the linearisation changes by its own errors: three times the
// most. Eigenvalues of a Jordan block move like a root of them, whatever their condition. noise:
// of the entries, at least round-off.
std::vector<double> measured_round_off(const ReducedLinearisation& linear, double noise,
                                       const std::vector<Complex>& values) {
  constexpr double safety = 3;
  std::vector<double> out(values.size(), safety * noise);
  const auto compare = [&](const Matrix& changed) {
    const std::vector<Complex> moved = eigenvalues_of(changed);
    const std::vector<int> to = matched(values, moved);
    for (size_t i = 0; i < values.size(); ++i)
      out[i] = std::max(out[i], safety * std::abs(values[i] - moved[static_cast<size_t>(to[i])]));
  };
  std::mt19937 random(1);
  for (int k = 0; k < 3; ++k) {
    Matrix changed = linear.flow;
    for (double& entry : changed.reshaped()) entry += random() % 2 == 0 ? noise : -noise;
    compare(changed);
  }
  for (const Matrix& again : linear.again) compare(again);
  return out;
}

// The velocities that take part in a mode (delta, nu), largest first, then the coordinates of the
// shape that do, all beside the largest velocity.
std::vector<ModePart> parts_of(const Eigen::VectorXcd& mode, const ModeNames& names) {
  const auto n = static_cast<Eigen::Index>(names.velocities.size());
  const double largest = mode.tail(n).cwiseAbs().maxCoeff(),
               size = largest > 0 ? largest : mode.cwiseAbs().maxCoeff();
  std::vector<ModePart> out;
  const auto add = [&](const std::vector<std::string>& of, Eigen::Index from) {
    const auto before = std::ssize(out);
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::string& name = of[static_cast<size_t>(i)];
      const double part = std::abs(mode[from + i]) / size;
      if (part > 0.05 && !name.empty()) out.push_back({name, part});
    }
    std::stable_sort(out.begin() + before, out.end(),
                     [](const auto& a, const auto& b) { return a.size > b.size; });
  };
  add(names.velocities, n);
  add(names.coordinates, 0);
  return out;
}

}  // namespace

SteadyMotion SteadyEquations::motion(const SteadyPoint& at, int family) const {
  SteadyMotion out;
  out.found = at.residual < kGood;
  out.residual = at.residual;
  out.velocity.assign(at.xi.begin(), at.xi.end());
  out.element.resize(static_cast<size_t>(geometry_->columns()));
  geometry_->coordinates(at.g.data(), out.element.data());
  if (!out.found) return out;
  const ReducedLinearisation linear = linearise(at);
  const dense::Eigensystem solver = dense::eigen(linear.flow);
  const std::vector<Complex> values(solver.values.begin(), solver.values.end());
  const double most = linear.flow.size() > 0 ? linear.flow.cwiseAbs().maxCoeff() : 0;
  const std::vector<double> round_off =
      measured_round_off(linear, (1e-15 + at.residual) * std::max(1.0, most), values);
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(),
            [&](auto i, auto j) { return std::abs(values[i]) < std::abs(values[j]); });
  if (family < 0) {
    const double size = order.empty() ? 0 : std::abs(values[order.back()]);
    const auto is_zero = [&](size_t i) {
      return std::abs(values[i]) < std::max(1e-7 * std::max(1.0, size), round_off[i]);
    };
    out.family =
        static_cast<int>(std::find_if_not(order.begin(), order.end(), is_zero) - order.begin());
  } else {
    out.family = std::min(family, static_cast<int>(order.size()));
  }
  order.erase(order.begin(), order.begin() + out.family);
  std::sort(order.begin(), order.end(), [&](auto i, auto j) {
    return std::pair(values[i].real(), values[i].imag()) >
           std::pair(values[j].real(), values[j].imag());
  });
  out.neutral = static_cast<int>(linear.orbit.cols()) + out.family;
  for (const size_t i : order) {
    out.eigenvalues.push_back(values[i]);
    out.round_off.push_back(round_off[i]);
    out.modes.push_back(parts_of(
        linear.basis.cast<Complex>() * solver.vectors.col(static_cast<Eigen::Index>(i)), names_));
  }
  return out;
}

}  // namespace reduced

SteadyMotion steady_motion(const Registry& registry, const SystemModel& model, const Start& guess) {
  const reduced::SteadyEquations equations(registry, model, guess);
  bool held = true;
  return equations.motion(equations.find_near_guess(held), -1);
}

SteadyMotion steady_motion(const Registry& registry, const Simulation& run) {
  const Run built = run.build();
  return steady_motion(registry, built.system(), reduced::guess_of(run, built));
}

int SteadyMotion::growing() const {
  int count = 0;
  for (size_t i = 0; i < eigenvalues.size(); ++i) count += eigenvalues[i].real() > round_off[i];
  return count;
}

std::string name_of(Bifurcation kind) {
  switch (kind) {
    case Bifurcation::pitchfork: return "pitchfork";
    case Bifurcation::transcritical: return "transcritical";
    case Bifurcation::fold: return "fold";
    case Bifurcation::family: return "family";
    case Bifurcation::hopf: return "hopf";
    case Bifurcation::hamiltonian_hopf: return "hamiltonian_hopf";
    case Bifurcation::none: return "none";
    case Bifurcation::undecided: return "undecided";
    case Bifurcation::unknown: break;
  }
  return "unknown";
}

std::vector<std::vector<int>> eigenvalue_curves(const std::vector<SteadyMotion>& motions) {
  std::vector<std::vector<int>> out;
  for (size_t k = 0; k < motions.size(); ++k) {
    const auto& now = motions[k].eigenvalues;
    std::vector<bool> continued(now.size(), false);
    // Curves present before are extended along the line through their last two values.
    std::vector<size_t> alive;
    std::vector<reduced::Complex> expected;
    for (size_t c = 0; c < out.size() && k > 0; ++c) {
      if (out[c][k - 1] < 0) continue;
      const auto last = motions[k - 1].eigenvalues[static_cast<size_t>(out[c][k - 1])];
      const bool two = k > 1 && out[c][k - 2] >= 0;
      const auto before =
          two ? motions[k - 2].eigenvalues[static_cast<size_t>(out[c][k - 2])] : last;
      alive.push_back(c);
      expected.push_back(2.0 * last - before);
    }
    for (auto& curve : out) curve.push_back(-1);
    const std::vector<int> to = reduced::matched(expected, now);
    for (size_t i = 0; i < alive.size(); ++i) {
      if (to[i] < 0) continue;
      out[alive[i]][k] = to[i];
      continued[static_cast<size_t>(to[i])] = true;
    }
    for (size_t j = 0; j < now.size(); ++j) {
      if (continued[j]) continue;
      out.emplace_back(k + 1, -1);
      out.back()[k] = static_cast<int>(j);
    }
  }
  return out;
}

int known_decimals(double round_off) {
  constexpr int most = 15;
  if (!(round_off > 0)) return most;
  return std::clamp(static_cast<int>(std::floor(-std::log10(round_off))), 0, most);
}

double round_to_known(double x, double round_off) {
  const double unit = std::pow(10.0, known_decimals(round_off));
  return std::abs(x) * unit < 1e15 ? std::round(x * unit) / unit + 0.0 : x;
}

}  // namespace hamel
