// Derivatives of order 1 to 3 of a function known by its values only, with their errors. For
// sources of analysis/, not installed.
//
//   O(h) = (f(h) - f(-h)) / 2h        = f' + h^2 f'''/6 + ...
//   E(h) = (f(h) + f(-h) - 2 f(0)) / h^2 = f'' + h^2 f''''/12 + ...
// are polynomials in h^2, extrapolated to 0 from up to five steps h, 4h, 16h, ... (Richardson);
// f''' is 6 times the slope of O. The error of such an estimate is its round-off, (sum of weights)
// times the noise of one value, and its difference from the estimate with one step less.
//
// Steps grow from `least` to `most`, no scale of f is assumed: the estimates of small steps are
// coarse but local, and the first larger step whose estimate contradicts one of them has left the
// neighbourhood in which f is smooth (Lepski's rule). The best estimate before that is returned.
// So a narrow well in a wide one is found, where a rule that halves steps until two agree takes
// the wide one. The noise of a value is 4 epsilon of it, the change of f over `grain`, and where
// estimates contradict each other or decide, what fourth differences of five neighbours show
// (Hamming; More, Wild, Estimating computational noise, SIAM J. Sci. Comput. 33, 2011).
//
// Each component of f is differentiated for itself. At a kink the error has half of its jump.
// Sources: Ridders, Accurate computation of F'(x) and F'(x)F''(x), Adv. Eng. Softw. 4 (1982);
// Lepski, Theory Probab. Appl. 35 (1990).
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace hamel {

/// Steps of a difference, in units of the argument.
struct StepRange {
  double least = 0x1p-64, most = 0x1p24;
  double grain = 0;            // the resolution of the argument: smaller changes are round-off
  Eigen::VectorXd noise = {};  // of the values, if known; else it is measured where it decides
};
/// Steps of an argument whose scale is known: an angle (1), a length beside the size of the system.
StepRange steps_of_scale(double scale, double grain = 0);
/// Steps of an argument of unknown scale.
StepRange steps_of_any_scale(double grain = 0);

/// A derivative by component, its error, and the largest step at which f is smooth enough for it.
struct Derivative {
  Eigen::VectorXd value, error, reach;
};

/// By component the length over which f is smooth, about its radius of convergence, the largest
/// step where it has no end; and how much f changes where it is not, to compare with its round-off.
struct Extent {
  Eigen::VectorXd length, change;
};

/// Four deviations of the round-off of values along a curve that is smooth over 2^20 steps.
Eigen::VectorXd noise_of(const std::function<Eigen::VectorXd(double)>& f, double step);

class CentralDifferences {
 public:
  using Vector = Eigen::VectorXd;
  /// f(x) at a displacement x from the point; not finite: f is not defined there.
  using Curve = std::function<Vector(double)>;
  CentralDifferences(Curve f, const StepRange& steps);

  /// d^order f/dx^order at 0, order 1 to 3. Values are shared by the calls. An error is infinite
  /// where f has no values beside the point.
  Derivative derivative(int order);
  Extent extent();
  long evaluations() const { return evaluations_; }

 private:
  struct Level {
    double h = 0;
    Vector plus, minus;
    Vector odd, even;  // O and E
    Vector noise;      // of a value: its round-off, and what the grain does
    Vector measured;   // empty: not measured
  };
  struct Estimate {
    double value = 0, error = 0, round_off = 0;
    Eigen::Index inner = -1;  // the level of its smallest step
    Eigen::Index outer = -1;
    bool rough = false;  // it does not converge, and not for round-off
  };
  struct Track;

  const Level& at(Eigen::Index k) const { return levels_[static_cast<size_t>(k)]; }
  bool is_measured(Eigen::Index k) const {
    return k < 0 || steps_.noise.size() > 0 || at(k).measured.size() > 0;
  }
  Vector value_at(double x);
  bool has_level(Eigen::Index k);
  void measure_noise(Eigen::Index k);
  double noise(Eigen::Index k, Eigen::Index component) const;
  Estimate estimate(int order, Eigen::Index k, Eigen::Index component);
  bool changes(int order, Eigen::Index k, Eigen::Index component) const;
  void advance(int order, Eigen::Index k, Eigen::Index component, Track& track);
  bool is_enough(Eigen::Index k, const Track& track, double largest) const;
  std::vector<Track> sweep(int order, bool whole = false);
  void settle_flat(int order, Eigen::Index component, Track& track);
  bool measure_where_decided(const std::vector<Track>& tracks);
  double kink(Eigen::Index component, Eigen::Index last) const;

  Curve f_;
  StepRange steps_;
  Vector here_;
  std::vector<Level> levels_;
  bool ended_ = false;  // no level beyond the last one
  long evaluations_ = 0;
};

}  // namespace hamel
