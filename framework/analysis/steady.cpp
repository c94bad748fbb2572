// The eigenvalues about a steady motion, and how well they are known.
#include <hamel/framework/analysis/steady.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <hamel/framework/analysis/matching.hpp>
#include <hamel/framework/analysis/state_units.hpp>
#include <hamel/framework/analysis/steady_equations.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel {
namespace reduced {
namespace {

// Eigenvalues with what they may be off, and eigenvectors as columns.
struct Spectrum {
  std::vector<Complex> values;
  std::vector<double> errors;
  Eigen::MatrixXcd vectors;
};

// |w_i| E |v_i|, w_i v_i = 1, to first order in the errors E of the entries, with left and right
// eigenvectors (Golub, Van Loan, Matrix Computations, 7.2.2). Eigenvalues of a Jordan block move
// like a root of E, (2 |M| + |E|)^(1 - 1/n) |E|^(1/n) at most (Elsner 1985), and by three times
// what random changes of that size do at least.
Spectrum spectrum_of(const Matrix& flow, const Matrix& error) {
  // An entry that is none is no size: vectors would be scaled by round-off (Watkins, A case where
  // balancing is harmful, ETNA 23, 2006).
  const Matrix sizes = (flow.array().abs() > error.array()).select(flow.cwiseAbs(), 0);
  const Vector d = balanced(sizes).unaryExpr([](double x) {
    return std::ldexp(1.0, std::ilogb(x));  // without round-off
  });
  const Matrix to_own = d.cwiseInverse().asDiagonal();
  const Matrix m = to_own * flow * d.asDiagonal();
  if (m.rows() == 0) return {};
  const auto count = static_cast<double>(m.rows());
  const double most = m.cwiseAbs().maxCoeff();
  // The solver's own error: of the size of the matrix.
  const Matrix e = (to_own * error * d.asDiagonal()).array() +
                   count * std::numeric_limits<double>::epsilon() * most;
  const dense::Eigensystem system = dense::eigen(m);
  Spectrum out{.values = {system.values.begin(), system.values.end()}, .errors = {}, .vectors = {}};
  if (!e.allFinite()) {  // no derivative there
    out.errors.assign(out.values.size(), std::numeric_limits<double>::infinity());
    out.vectors = d.cast<Complex>().asDiagonal() * system.vectors;
    return out;
  }
  const double change = e.norm(), size = 2 * m.norm() + change,
               elsner = std::pow(size, 1 - 1 / count) * std::pow(change, 1 / count);
  const Eigen::MatrixXcd left = dense::left_eigenvectors(system);
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    const Vector w = left.col(i).cwiseAbs(), v = system.vectors.col(i).cwiseAbs();
    const double moves = w.dot(e * v);
    out.errors.push_back(moves < elsner ? moves : elsner);
  }
  constexpr double safety = 3;
  std::mt19937 random(1);
  for (int k = 0; k < 3; ++k) {
    Matrix changed = m;
    for (Eigen::Index i = 0; i < m.size(); ++i)
      changed.reshaped()[i] += random() % 2 == 0 ? e.reshaped()[i] : -e.reshaped()[i];
    const Eigen::VectorXcd values = dense::eigenvalues(changed);
    const std::vector<Complex> moved(values.begin(), values.end());
    const std::vector<int> to = matched(out.values, moved);
    for (size_t i = 0; i < out.values.size(); ++i) {
      const double apart = std::abs(out.values[i] - moved[static_cast<size_t>(to[i])]);
      if (apart > out.errors[i]) out.errors[i] = safety * apart;
    }
  }
  out.vectors = d.cast<Complex>().asDiagonal() * system.vectors;
  return out;
}

// At rest and with a(g, xi) = a(g, -xi) the squares are eigenvalues of a real matrix: those whose
// imaginary part is within its error are real, if no other square is so near that both may be
// conjugates. A negative one is a pair on the axis, a positive one has no imaginary part.
void place_on_axis(Spectrum& spectrum, bool real_squares, std::vector<bool>& on_axis) {
  const size_t count = spectrum.values.size();
  const std::vector<Complex> values = spectrum.values;
  for (size_t i = 0; i < count; ++i) {
    const Complex square = values[i] * values[i];
    const double error = (2 * std::abs(values[i]) + spectrum.errors[i]) * spectrum.errors[i];
    if (std::abs(square.imag()) > error || std::abs(square.real()) <= error) continue;
    size_t near = 0;  // itself and its mate among them
    for (size_t j = 0; j < count; ++j) {
      const double other = (2 * std::abs(values[j]) + spectrum.errors[j]) * spectrum.errors[j];
      near += std::abs(values[j] * values[j] - square) <= error + other;
    }
    if (near > 2 && !real_squares) continue;
    on_axis[i] = square.real() < 0;
    spectrum.values[i] = on_axis[i] ? Complex(0, values[i].imag()) : Complex(values[i].real(), 0);
  }
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
  const int n = dim();
  const ReducedLinearisation linear = linearise(at);
  Spectrum spectrum = spectrum_of(linear.flow, linear.error);
  std::vector<bool> on_axis(spectrum.values.size(), false);
  const bool rests = at.xi.cwiseQuotient(linear.sizes.tail(n)).lpNorm<Eigen::Infinity>() < 1e-12;
  if (rests && flow_.is_reversible()) place_on_axis(spectrum, flow_.is_conservative(), on_axis);
  const std::vector<Complex>& values = spectrum.values;
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(),
            [&](auto i, auto j) { return std::abs(values[i]) < std::abs(values[j]); });
  if (family < 0) {
    const auto is_zero = [&](size_t i) {
      return std::abs(values[i]) < std::max(1e-12 * linear.rate, spectrum.errors[i]);
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
    out.round_off.push_back(spectrum.errors[i]);
    out.on_axis.push_back(on_axis[i]);
    const Eigen::VectorXcd mode =
        linear.basis.cast<Complex>() * spectrum.vectors.col(static_cast<Eigen::Index>(i));
    out.modes.push_back(parts_of(mode, names_));
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

std::optional<int> SteadyMotion::decided_growing() const {
  if (!found) return std::nullopt;
  for (size_t i = 0; i < eigenvalues.size(); ++i)
    if (!on_axis[i] && !(std::abs(eigenvalues[i].real()) > round_off[i])) return std::nullopt;
  return growing();
}

double SteadyMotion::largest_growth() const {
  double out = 0;
  for (size_t i = 0; i < eigenvalues.size(); ++i)
    if (!on_axis[i]) out = std::max(out, eigenvalues[i].real() + round_off[i]);
  return out;
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
