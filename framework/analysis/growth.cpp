#include <hamel/framework/analysis/growth.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>

#include <hamel/framework/analysis/carried_fields.hpp>
#include <hamel/framework/analysis/exact_brackets.hpp>
#include <hamel/framework/lie/decompositions.hpp>

namespace hamel {
namespace {

using namespace carried;

// Part of the size of its generation below which nothing is a new direction; of exact brackets.
constexpr double kNew = 1e-6, kNewExact = 1e-10;
// Times its estimated error, for a bracket that is too small to be a direction not to be zero. At
// round-off the ratio was 0.1 to 3 on six systems and mechanisms, 10.4 on the snakeboard.
constexpr double kSure = 30;
constexpr double kDecided = 1e-3;  // ten times the error of a generation, for a rank to be believed

// The dimensions that the generations reach one after another.
struct Reach {
  std::vector<int> dimensions;
  bool round_off = false;  // what the next one adds cannot be distinguished from round-off
  bool near_zero = false;  // a bracket that is left out is small, but not zero
};
// Is what a generation has outside a span known not to be zero? Each coordinate has its own errors:
// those of z' = 1e-12 y x' are far below those of x'.
bool is_small_only(const Generation& generation, const Matrix& span) {
  const Matrix& b = generation.brackets;
  const Vector size = b.cwiseAbs().rowwise().maxCoeff(), error = generation.errors + 1e-15 * size,
               left = (b - span * (span.transpose() * b)).cwiseAbs().rowwise().maxCoeff();
  const Matrix across = span.cwiseAbs() * span.cwiseAbs().transpose();
  const Vector bound = error + across * error + 1e-15 * (across * size);
  return ((left - kSure * bound).array() > 0).any();
}

// possible: the directions that holonomic rows leave. least: what is smaller is no new direction.
Reach reach_of(const std::vector<Generation>& generations, Eigen::Index fields,
               Eigen::Index possible, double least = kNew) {
  const Eigen::Index rows = generations.front().brackets.rows();
  Matrix span(rows, 0);
  double tilt = 0;  // of the span, by the errors of what is in it
  Reach out;
  const double unit = generations.front().size;
  for (const Generation& generation : generations) {
    const double size = std::max(generation.size, kNothing * unit);
    const double error = generation.error + tilt * size;
    const Matrix outside = generation.brackets - span * (span.transpose() * generation.brackets);
    const dense::Svd svd = dense::svd(outside, Eigen::ComputeThinU);
    Eigen::Index fresh = 0;
    const Vector& sizes = svd.values;
    const Eigen::Index most = std::min(sizes.size(), possible - span.cols());
    while (fresh < most && sizes[fresh] > 10 * error + least * size) ++fresh;
    // A generation at round-off decides nothing, unless no direction is left.
    if (span.cols() + fresh < possible && !(10 * error < kDecided * size)) {
      out.round_off = true;
      break;
    }
    if (span.cols() + fresh < possible) {
      Matrix known(rows, span.cols() + fresh);
      known << span, svd.u.leftCols(fresh);
      out.near_zero = out.near_zero || is_small_only(generation, known);
    }
    if (fresh > 0) {
      tilt = std::max(tilt, error / sizes[fresh - 1]);
      Matrix wider(rows, span.cols() + fresh);
      wider << span, svd.u.leftCols(fresh);
      span = dense::qr(wider).q.leftCols(wider.cols());
    }
    out.dimensions.push_back(static_cast<int>(span.cols()));
    if (span.cols() == possible) break;
  }
  if (out.dimensions.empty())  // not even the rank of the fields is decided
    out.dimensions.push_back(static_cast<int>(std::min(fields, possible)));
  return out;
}

// The dimension once a generation adds nothing: brackets are then closed (ranks are generic); -1:
// further generations may add directions.
int closed_at(const Reach& reach, int possible) {
  const auto& d = reach.dimensions;
  const auto same = std::adjacent_find(d.begin(), d.end());
  return same != d.end() ? *same : d.back() == possible ? possible : -1;
}

// [x, y] of constant fields, left-invariant and constant in time: columns of n, or n + 1 with time,
// in these units.
Vector ad(const Geometry& geometry, const Vector& units, const Vector& x, const Vector& y) {
  const Eigen::Index n = geometry.dim();
  const Vector xi = units.cwiseProduct(x.head(n)), eta = units.cwiseProduct(y.head(n));
  Vector out = Vector::Zero(x.size()), mu = Vector::Zero(n), row(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    mu[i] = 1;
    geometry.ad_transpose(xi.data(), mu.data(), row.data());
    out[i] = row.dot(eta) / units[i];
    mu[i] = 0;
  }
  return out;
}
Reach constant_reach(const Geometry& geometry, const Vector& units, const Matrix& fields) {
  Reach out{{static_cast<int>(fields.cols())}};
  Matrix span = dense::pivoted_q(fields).leftCols(fields.cols()), last = span;
  while (true) {
    Matrix wider(fields.rows(), span.cols() + fields.cols() * last.cols());
    wider.leftCols(span.cols()) = span;
    Eigen::Index next = span.cols();
    for (Eigen::Index i = 0; i < fields.cols(); ++i) {
      for (Eigen::Index j = 0; j < last.cols(); ++j)
        wider.col(next++) = ad(geometry, units, fields.col(i).normalized(), last.col(j));
    }
    const Matrix outside = wider - span * (span.transpose() * wider);
    const dense::Svd svd = dense::svd(outside, Eigen::ComputeThinU);
    Eigen::Index fresh = 0;
    const Vector& sizes = svd.values;
    while (fresh < sizes.size() && sizes[fresh] > 1e-10) ++fresh;
    out.near_zero = out.near_zero || (fresh < sizes.size() && sizes[fresh] > 1e-13);
    if (fresh == 0) return out;
    last = svd.u.leftCols(fresh);
    Matrix both(fields.rows(), span.cols() + fresh);
    both << span, last;
    span = both;
    out.dimensions.push_back(static_cast<int>(span.cols()));
  }
}

// Is there an X_0: is b not 0, or do A and b change with time, at a small number of configurations?
bool has_drift(const Geometry& geometry, const Mechanics& mechanics, const Vector& g) {
  const Eigen::Index n = mechanics.dim(), k = mechanics.constraint_count();
  Matrix a(k, n), later(k, n);
  Vector b(k), b_later(k), x = Vector::Zero(n), at(g.size());
  std::mt19937 random(2);
  for (int i = 0; i < 5; ++i) {
    geometry.tau(x.data(), at.data());
    geometry.compose(g.data(), at.data(), at.data());
    mechanics.constraints(0, at.data(), a, b);
    for (const double t : {0.0, 0.37, 1.3}) {
      mechanics.constraints(t, at.data(), later, b_later);
      if (b_later.norm() > 0 || (later - a).norm() > 1e-12 * a.norm()) return true;
    }
    for (double& entry : x) entry = static_cast<double>(random()) / 4294967295.0 - 0.5;
  }
  return false;
}

// Brackets of one to `depth` fields at places beside g, in the coordinates of Fields.
class Source {
 public:
  virtual ~Source() = default;
  virtual std::vector<Generation> generations(const Vector& place, int depth) = 0;
  /// A place nearby: within the length over which the fields are smooth at g.
  virtual double length() = 0;
};
class ByDifferences final : public Source {
 public:
  explicit ByDifferences(Fields& fields) : fields_(fields) {}
  std::vector<Generation> generations(const Vector& place, int depth) override {
    return carried::generations(fields_, place, depth);
  }
  double length() override { return own_length(fields_, Vector::Zero(fields_.coordinates())); }

 private:
  Fields& fields_;
};
class ByFormulas final : public Source {
 public:
  ByFormulas(Fields& fields, ExactBrackets& exact) : fields_(fields), exact_(exact) {}
  std::vector<Generation> generations(const Vector& place, int depth) override {
    const double t = fields_.with_drift() ? place[fields_.coordinates() - 1] : 0;
    return exact_.generations(fields_.element(place), t, depth);
  }
  double length() override { return exact_.length(); }

 private:
  Fields& fields_;
  ExactBrackets& exact_;
};

// Reach of fields that change with the place. nearby: what brackets span beside `here`, if that is
// decided; near_zero: as of Growth.
struct Reached {
  Reach here;
  int nearby = -1;
  bool near_zero = false;
};
// least: what is smaller is no new direction. Empty: the source has no brackets.
std::optional<Reached> reach_by_brackets(Source& source, const Fields& fields, int possible,
                                         int most, double least) {
  const auto all = static_cast<int>(fields.coordinates());
  Reached out;
  const int deepest = std::min(std::max(all, 4), most);
  int looked = 0;
  for (const int depth : {std::min(3, deepest), std::min(5, deepest), deepest}) {
    if (depth == looked) break;
    looked = depth;
    const std::vector<Generation> found = source.generations(Vector::Zero(all), depth);
    if (found.empty()) return std::nullopt;
    out.here = reach_of(found, fields.count(), possible, least);
    if (out.here.dimensions.back() == possible) out.nearby = possible;
    else if (out.nearby < 0 && (depth == deepest || closed_at(out.here, possible) >= 0)) {
      const double length = source.length();
      Vector there(all);
      for (int i = 0; i < all; ++i) there[i] = 0.3 * length * std::cos(1.0 + 2.0 * i);
      const std::vector<Generation> beside = source.generations(there, depth);
      if (beside.empty()) return std::nullopt;
      const Reach generic = reach_of(beside, fields.count(), possible, least);
      out.near_zero = generic.near_zero;
      out.nearby = closed_at(generic, possible);
    }
    if (out.here.dimensions.back() == out.nearby) break;
  }
  return out;
}

// With paths, which decide what nested brackets leave to round-off.
Reached reach_by_differences(Fields& fields, int possible, int most) {
  ByDifferences source(fields);
  Reached out = *reach_by_brackets(source, fields, possible, most, kNew);
  if (out.nearby < 0 && !out.near_zero && !out.here.near_zero) {
    const Vector here = Vector::Zero(fields.coordinates());
    const Reach whole = reach_of({orbit(fields, here)}, fields.count(), possible, 0);
    out.near_zero = whole.near_zero;
    if (!whole.round_off) out.nearby = whole.dimensions.back();
  }
  return out;
}

}  // namespace

Growth growth_of(const Geometry& geometry, const Mechanics& mechanics, const double* at, int most,
                 const std::vector<double>& given, const graph::RowFields* formulas) {
  Vector units = Vector::Ones(geometry.dim());
  if (!given.empty()) units = Eigen::Map<const Vector>(given.data(), geometry.dim());
  const Vector g = Eigen::Map<const Vector>(at, geometry.size());
  Growth out;
  out.with_drift = has_drift(geometry, mechanics, g);
  Fields fields(geometry, mechanics, g, units, out.with_drift);
  const auto all = static_cast<int>(fields.coordinates()),
             possible = all - mechanics.holonomic_rows();
  const Vector here = Vector::Zero(all);
  const int own = out.with_drift ? 1 : 0;
  Reached reached{{{static_cast<int>(fields.count())}}};
  if (fields.count() == possible || fields.count() == 0) {
    reached.nearby = static_cast<int>(fields.count());
  } else if (mechanics.constant_constraints()) {
    reached.here = constant_reach(geometry, units, fields(here));
    reached.nearby = reached.here.dimensions.back();
  } else {
    std::optional<Reached> exactly;
    if (formulas != nullptr) {
      ExactBrackets exact(*formulas, geometry, units, out.with_drift);
      ByFormulas source(fields, exact);
      exactly = reach_by_brackets(source, fields, possible, most, kNewExact);
    }
    reached = exactly ? std::move(*exactly) : reach_by_differences(fields, possible, most);
  }
  out.looked_at = static_cast<int>(reached.here.dimensions.size());
  out.round_off = reached.here.round_off;
  out.near_zero = (reached.near_zero || reached.here.near_zero) && reached.nearby < possible;
  if (out.near_zero) reached.nearby = -1;
  auto& d = reached.here.dimensions;
  while (d.size() > 1 && d.back() == d[d.size() - 2]) d.pop_back();
  for (const int dimension : d) out.dimensions.push_back(dimension - own);
  out.nearby = reached.nearby < 0 ? reached.nearby : reached.nearby - own;
  return out;
}

}  // namespace hamel
