// Columns of different units are compared as numbers without one: each is divided by its largest
// value over all motions. A combination is kept when it changes by 1e-9 at most along every motion,
// with each motion's largest value of its terms for unit. Combinations zero on every motion
// (the rows, and what follows from them) are no more than identities; combinations that differ by
// one count once, in the form with the fewest terms.
#include <hamel/framework/analysis/conserved.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <fmt/format.h>

#include <hamel/framework/lie/decompositions.hpp>

namespace hamel {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kKept = 1e-9;               // change of a term's unit along a motion
constexpr double kIdentity = 1e-10;          // of a term's unit: zero
constexpr double kShort = 1, kLong = 20;     // s
constexpr int kMotions = 4;                  // of either length
constexpr int kRows = 40;                    // of each
constexpr long kMostStepsOfMotion = 10'000;  // of each

class Search {
 public:
  Search(const Registry& registry, const Config& start, const Matrix& frame,
         const Geometry& geometry)
      : registry_(registry),
        first_(followed(start)),
        frame_(frame),
        geometry_(geometry),
        n_(frame.rows()) {
    names_ = {"E"};
    for (const Component& component : components_of(*first_.system))
      names_.push_back(component.name);
    for (Eigen::Index i = 1; i <= n_; ++i) names_.push_back(fmt::format("J{}", i));
    values_.resize(0, width());
    changes_ = values_;
  }

  std::vector<Analysis::Conserved> all() {
    for (int i = 0; i < kMotions; ++i) follow(i, 0, kShort, first_.config.start.configuration);
    for (int i = 0; i < kMotions; ++i)
      follow(i + 1, first_.last.time, kLong, first_.last.coordinates);
    if (values_.rows() == 0) return {};
    find_scales();
    const Vector units = scale_.cwiseInverse();
    values_ = (values_ * units.asDiagonal()).eval();
    changes_ = (changes_ * units.asDiagonal()).eval();
    known_ = identities();
    count();
    for (int terms = 1; terms <= 3 && left_ > 0; ++terms) combinations_of(terms);
    rest();
    return std::move(out_);
  }
  /// Motions that were cut after kMostStepsOfMotion.
  int cut() const { return cut_; }

 private:
  Eigen::Index width() const { return static_cast<Eigen::Index>(names_.size()); }

  // A run to its end, or as far as so many steps lead.
  Result followed(const Config& config) {
    Run run = Simulation(registry_, config.system).config(config).build();
    long steps = 0;
    while (run.time() < config.until && run.step_towards(config.until) &&
           ++steps < kMostStepsOfMotion) {
    }
    if (steps == kMostStepsOfMotion) ++cut_;
    return run.finish();
  }

  // A motion, from the time of its place on; of one that fails the first half, far from where it
  // did.
  void follow(int motion, double from, double length, const std::vector<double>& at) {
    Config config = first_.config;
    config.from = from;
    config.until = from + length;
    config.output_step = length / kRows;
    config.start.configuration = at;
    if (motion > 0) perturb(config.start.velocity);
    const Result run = followed(config);
    const size_t columns = run.system->group.columns.size();
    const size_t rows = run.status.ok ? run.trajectory.rows() : run.trajectory.rows() / 2;
    if (rows < 2) return;
    Matrix found(static_cast<Eigen::Index>(rows), width());
    Vector g(geometry_.size()), inverse(geometry_.size()), spatial(n_);
    const size_t energy = run.trajectory.index("energy"), mu = run.trajectory.index("mu1");
    for (size_t i = 0; i < rows; ++i) {
      const auto row = run.trajectory.row(i);
      geometry_.from_coordinates(row.subspan(1, columns), g.data());
      geometry_.inverse(g.data(), inverse.data());
      geometry_.Ad_transpose(inverse.data(), row.data() + mu, spatial.data());
      auto to = found.row(static_cast<Eigen::Index>(i));
      to[0] = row[energy];
      to.segment(1, n_) = Eigen::Map<const Vector>(row.data() + 1 + columns, n_).transpose();
      to.tail(n_) = spatial.transpose();
    }
    if (!found.allFinite()) return;
    const Eigen::Index before = values_.rows();
    values_.conservativeResize(before + found.rows(), width());
    values_.bottomRows(found.rows()) = found;
    changes_.conservativeResize(before + found.rows(), width());
    changes_.bottomRows(found.rows()) = found.rowwise() - found.row(0);
  }
  // By a random admissible velocity of a third of its energy's root, of length 1/3 at rest.
  void perturb(std::vector<double>& velocity) {
    Eigen::Map<Vector> xi(velocity.data(), n_);
    Vector y(frame_.cols());
    for (double& entry : y) entry = normal_(random_);
    const Snapshot& last = first_.last;
    const double twice_energy =
        std::inner_product(last.velocity.begin(), last.velocity.end(), last.momentum.begin(), 0.0);
    const Vector direction = frame_ * y;
    xi += 0.3 * (twice_energy > 0 ? std::sqrt(twice_energy) : 1 / direction.norm()) * direction;
  }

  // The largest values; those of a column at round-off of its kind are zero.
  void find_scales() {
    scale_ = values_.cwiseAbs().colwise().maxCoeff().transpose();
    for (const auto& [from, columns] :
         {std::pair<Eigen::Index, Eigen::Index>{0, 1}, {1, n_}, {1 + n_, n_}}) {
      auto kind = scale_.segment(from, columns);
      const double largest = kind.maxCoeff();
      for (double& s : kind)
        if (!(s > 1e-13 * largest)) s = largest > 0 ? largest : 1;
    }
  }
  // An orthonormal basis of the combinations that are zero on all motions.
  Matrix identities() const {
    const dense::Svd svd = dense::svd(values_, Eigen::ComputeFullV);
    const double floor = kIdentity * std::sqrt(static_cast<double>(values_.rows()));
    Eigen::Index rank = 0;
    while (rank < svd.values.size() && svd.values[rank] > floor) ++rank;
    return svd.v.rightCols(width() - rank);
  }
  // How many independent combinations are kept; a basis of them.
  void count() {
    const Matrix others = complement(known_);
    const Matrix reduced = changes_ * others;
    const dense::Svd svd = dense::svd(reduced, Eigen::ComputeFullV);
    kept_.resize(width(), 0);
    for (Eigen::Index i = 0; i < others.cols(); ++i) {
      const Vector v = others * svd.v.col(i);
      if (change(v) <= kKept) append(kept_, v);
    }
    left_ = kept_.cols();
    // Small enough for combinations: R of the changes.
    small_ = dense::qr(changes_).r;
  }
  static Matrix complement(const Matrix& basis) {
    return dense::qr(basis).q.rightCols(basis.rows() - basis.cols());
  }
  static void append(Matrix& basis, const Vector& v) {
    basis.conservativeResize(v.size(), basis.cols() + 1);
    basis.rightCols<1>() = v;
  }
  // The change of a combination, in units of the largest sum of its terms.
  double change(const Vector& v) const {
    const double unit = (values_ * v.asDiagonal()).cwiseAbs().rowwise().sum().maxCoeff();
    return (changes_ * v).cwiseAbs().maxCoeff() / std::max(unit, 1e-300);
  }
  // The part of v orthogonal to the combinations already known.
  Vector fresh(const Vector& v) const { return v - known_ * (known_.transpose() * v); }

  void take(const Vector& v) {
    out_.push_back({words(v), change(v)});
    append(known_, fresh(v).normalized());
    --left_;
  }

  // Takes the combinations of so many terms, the first names first.
  void combinations_of(int terms) {
    constexpr double most = 4000;
    double all = 1;
    for (int i = 0; i < terms; ++i) all *= static_cast<double>(width() - i) / (i + 1);
    if (all > most) return;
    std::vector<Eigen::Index> chosen(static_cast<size_t>(terms));
    choose(chosen, 0, 0);
  }
  void choose(std::vector<Eigen::Index>& chosen, size_t at, Eigen::Index from) {
    if (at == chosen.size()) return look_at(chosen);
    for (Eigen::Index i = from; i < width() && left_ > 0; ++i) {
      chosen[at] = i;
      choose(chosen, at + 1, i + 1);
    }
  }
  void look_at(const std::vector<Eigen::Index>& chosen) {
    const auto count = static_cast<Eigen::Index>(chosen.size());
    Matrix columns(small_.rows(), count);
    for (Eigen::Index i = 0; i < count; ++i)
      columns.col(i) = small_.col(chosen[static_cast<size_t>(i)]);
    const dense::Svd svd = dense::svd(columns, Eigen::ComputeFullV);
    const Vector weights = svd.v.col(count - 1);
    Vector v = Vector::Zero(width());
    for (Eigen::Index i = 0; i < count; ++i) v[chosen[static_cast<size_t>(i)]] = weights[i];
    if (weights.cwiseAbs().minCoeff() > 1e-6 && fresh(v).norm() > 1e-6 && change(v) <= kKept)
      take(v);
  }
  // Takes the combinations that need more terms, in echelon form.
  void rest() {
    Matrix rows(0, width());
    for (Eigen::Index i = 0; i < kept_.cols() && rows.rows() < left_; ++i) {
      Vector v = fresh(kept_.col(i));
      v -= rows.transpose() * (rows * v);
      if (v.norm() < 1e-6) continue;
      rows.conservativeResize(rows.rows() + 1, width());
      rows.bottomRows<1>() = v.normalized().transpose();
    }
    Eigen::Index lead = 0;
    for (Eigen::Index j = 0; j < width() && lead < rows.rows(); ++j) {
      Eigen::Index pivot = 0;
      if (rows.col(j).tail(rows.rows() - lead).cwiseAbs().maxCoeff(&pivot) < 1e-6) continue;
      rows.row(lead).swap(rows.row(lead + pivot));
      rows.row(lead) /= rows(lead, j);
      for (Eigen::Index i = 0; i < rows.rows(); ++i)
        if (i != lead) rows.row(i) -= rows(i, j) * rows.row(lead);
      ++lead;
    }
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const Vector v = rows.row(i).transpose();
      if (change(v) <= kKept) out_.push_back({words(v), change(v)});
    }
  }

  // In the units of the names, the largest term with the factor 1.
  std::string words(const Vector& v) const {
    Eigen::Index largest = 0;
    const double size = v.cwiseAbs().maxCoeff(&largest);
    std::string out;
    for (Eigen::Index i = 0; i < width(); ++i) {
      if (std::abs(v[i]) < 1e-9 * size) continue;
      const double w = v[i] / scale_[i] / (v[largest] / scale_[largest]);
      const std::string factor =
          std::abs(std::abs(w) - 1) < 1e-9 ? "" : fmt::format("{:.6g} ", std::abs(w));
      out += fmt::format("{}{}{}", out.empty() ? (w < 0 ? "-" : "") : (w < 0 ? " - " : " + "),
                         factor, names_[static_cast<size_t>(i)]);
    }
    return out;
  }

  int cut_ = 0;
  const Registry& registry_;
  const Result first_;
  const Matrix& frame_;
  const Geometry& geometry_;
  Eigen::Index n_;
  std::vector<std::string> names_;
  Matrix values_, changes_;  // a row for each state, a column for each name
  Vector scale_;
  Matrix known_, kept_, small_;
  Eigen::Index left_ = 0;
  std::mt19937 random_{1};
  std::normal_distribution<double> normal_;
  std::vector<Analysis::Conserved> out_;
};

}  // namespace

std::vector<Analysis::Conserved> find_conserved(const Registry& registry, const Config& start,
                                                const Matrix& frame, const Geometry& geometry,
                                                std::vector<std::string>& notes) {
  Search search(registry, start, frame, geometry);
  std::vector<Analysis::Conserved> out = search.all();
  if (search.cut() > 0)
    notes.push_back(fmt::format(
        "{} of the motions along which the conserved quantities were sought ended after "
        "{} steps",
        search.cut(), kMostStepsOfMotion));
  return out;
}

}  // namespace hamel
