#include <hamel/framework/analysis/carried_fields.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <hamel/framework/analysis/central_differences.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/mechanics/frame.hpp>

namespace hamel::carried {

Fields::Fields(const Geometry& geometry, const Mechanics& mechanics, const Vector& g,
               const Vector& units, bool with_drift)
    : geometry_(geometry),
      mechanics_(mechanics),
      g_(g),
      at_(g),
      units_(units),
      n_(mechanics.dim()),
      drift_(with_drift ? 1 : 0),
      a_(mechanics.constraint_count(), n_),
      b_(mechanics.constraint_count()) {
  Matrix inertia(n_, n_);
  mechanics.inertia(g.data(), inertia);
  inertia = (units_.asDiagonal() * inertia * units_.asDiagonal()).eval();
  set_rows(0);
  frame_ = hamel_frame(inertia, a_).colwise().normalized();  // of one size, whatever the units
  const Matrix rows = a_.transpose() * a_;
  if (a_.rows() > 0)
    inertia += inertia.trace() / rows.trace() * rows;  // definite with massless links, too
  metric_ = dense::inverse(inertia);
}

void Fields::set_rows(double t) {
  mechanics_.constraints(t, at_.data(), a_, b_);
  a_ = (a_ * units_.asDiagonal()).eval();
  for (Eigen::Index i = 0; i < a_.rows(); ++i) {
    const double size = a_.row(i).norm();
    if (!(size > 0)) continue;
    a_.row(i) /= size;
    b_[i] /= size;
  }
}

const Vector& Fields::element(const Vector& x) {
  const Vector step = units_.cwiseProduct(x.head(n_));
  geometry_.tau(step.data(), at_.data());
  geometry_.compose(g_.data(), at_.data(), at_.data());
  return at_;
}

Matrix Fields::operator()(const Vector& x) {
  const double t = drift_ == 1 ? x[n_] : 0;
  const Vector step = units_.cwiseProduct(x.head(n_));
  element(x);
  set_rows(t);
  raised_.noalias() = metric_ * a_.transpose();
  lambda_.resize(a_.rows(), count());
  lambda_.rightCols(frame_.cols()).noalias() = -a_ * frame_;
  if (drift_ == 1) lambda_.col(0) = b_;
  if (a_.rows() > 0) lambda_ = dense::solve_symmetric(a_ * raised_, lambda_);
  Matrix out = Matrix::Zero(coordinates(), count());
  out.topRows(n_).noalias() = raised_ * lambda_;
  out.topRows(n_).rightCols(frame_.cols()) += frame_;
  for (Eigen::Index i = 0; i < count(); ++i) {
    Vector xi = units_.cwiseProduct(out.col(i).head(n_));
    geometry_.dtau_left_inverse(step.data(), xi.data(), xi.data());
    out.col(i).head(n_) = xi.cwiseQuotient(units_);
  }
  if (drift_ == 1) out(n_, 0) = 1;
  return out;
}

namespace {

// Piece of a path: x' = sum u_a X_a(x) for a while.
struct Piece {
  Vector controls;
  double length;
};
using Path = std::vector<Piece>;

// Path of length 1.
Path random_path(std::mt19937& random, Eigen::Index controls, int pieces) {
  const auto uniform = [&random] { return 2 * (static_cast<double>(random()) / 4294967295.0) - 1; };
  Path out;
  double length = 0;
  for (int i = 0; i < pieces; ++i) {
    Vector u(controls);
    for (double& entry : u) entry = uniform();
    out.push_back({u.normalized(), 0.25 + std::abs(uniform())});
    length += out.back().length;
  }
  for (Piece& piece : out) piece.length /= length;
  return out;
}

// Step of order 8: midpoint rules of 2, 4, 6, 8 substeps, extrapolated (Hairer, Norsett,
// Wanner, II.9).
Vector flow(Fields& fields, const Vector& controls, double length, const Vector& start) {
  constexpr int rules = 4;
  std::array<Vector, rules> table;
  const Vector rate = fields(start) * controls;
  for (int i = 0; i < rules; ++i) {
    const int substeps = 2 * (i + 1);
    const double h = length / substeps;
    Vector before = start, now = start + h * rate;
    for (int k = 1; k < substeps; ++k) {
      before += 2 * h * (fields(now) * controls);
      before.swap(now);
    }
    table[static_cast<size_t>(i)] = 0.5 * (now + before + h * (fields(now) * controls));
  }
  for (int k = 1; k < rules; ++k) {
    for (int i = rules - 1; i >= k; --i) {
      const double ratio = static_cast<double>(i + 1) / (i + 1 - k);
      auto& entry = table[static_cast<size_t>(i)];
      entry += (entry - table[static_cast<size_t>(i - 1)]) / (ratio * ratio - 1);
    }
  }
  return table.back();
}

// V_b(e), column b: the fields at the end of the path scaled with e, carried back along it.
Matrix carried(Fields& fields, const Path& path, double e, const Vector& from, double unit) {
  Vector end = from;
  for (const Piece& piece : path) end = flow(fields, piece.controls, e * piece.length, end);
  const Matrix there = fields(end);
  const auto back = [&](Vector x) {
    for (auto piece = path.rbegin(); piece != path.rend(); ++piece)
      x = flow(fields, piece->controls, -e * piece->length, x);
    return x;
  };
  Matrix out(there.rows(), there.cols());
  for (Eigen::Index b = 0; b < there.cols(); ++b) {
    constexpr double weights[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
    const double shift = unit / there.col(b).norm();
    out.col(b).setZero();
    for (int k = 1; k <= 3; ++k) {
      const Vector step = k * shift * there.col(b);
      out.col(b) += weights[k - 1] / shift * (back(end + step) - back(end - step));
    }
  }
  return out;
}

// Taylor coefficients of e -> V(e) from Chebyshev nodes in [-r, r]: entry j is the coefficient of
// (e/r)^j.
std::vector<Matrix> coefficients(Fields& fields, const Path& path, double r, int degree,
                                 const Vector& from, double unit) {
  Matrix powers(degree + 1, degree + 1), values(degree + 1, fields.coordinates() * fields.count());
  for (int i = 0; i <= degree; ++i) {
    const double node = std::cos(std::numbers::pi * (i + 0.5) / (degree + 1));
    for (int j = 0; j <= degree; ++j) powers(i, j) = std::pow(node, j);
    const Matrix v = carried(fields, path, r * node, from, unit);
    values.row(i) = Eigen::Map<const Vector>(v.data(), v.size()).transpose();
  }
  const Matrix fitted = dense::solve_pivoted(powers, values);
  std::vector<Matrix> out;
  for (int j = 0; j <= degree; ++j) {
    const Vector row = fitted.row(j).transpose();
    out.push_back(Eigen::Map<const Matrix>(row.data(), fields.coordinates(), fields.count()));
  }
  return out;
}

}  // namespace

double own_length(Fields& fields, const Vector& from) {
  double out = 1;
  for (Eigen::Index i = 0; i < fields.coordinates(); ++i) {
    const Vector along = Vector::Unit(fields.coordinates(), i);
    const auto values = [&](double e) { return Vector(fields(from + e * along).reshaped()); };
    const double least = 1e-12 * values(0).lpNorm<Eigen::Infinity>();  // above their round-off
    const Extent extent = CentralDifferences(values, steps_of_scale(1)).extent();
    for (Eigen::Index c = 0; c < extent.length.size(); ++c)
      if (extent.change[c] > least) out = std::min(out, extent.length[c]);
  }
  return out;
}

Generation orbit(Fields& fields, const Vector& from) {
  const Eigen::Index rows = fields.coordinates(), each = fields.count();
  const Eigen::Index paths = 2 * ((rows + each - 1) / each) + 2;
  std::mt19937 random(5);
  const double length = own_length(fields, from);
  Generation out{Matrix(rows, each * paths), 0, 0, {}};
  Matrix coarse = out.brackets;
  for (Eigen::Index w = 0; w < paths; ++w) {
    const Path path = random_path(random, each, 4);
    Path halves;
    for (const Piece& piece : path)
      halves.insert(halves.end(), 2, {piece.controls, piece.length / 2});
    coarse.middleCols(each * w, each) = carried(fields, path, length, from, 0.02 * length);
    out.brackets.middleCols(each * w, each) = carried(fields, halves, length, from, 0.012 * length);
  }
  const Matrix difference = out.brackets - coarse;
  out.size = out.brackets.norm();
  out.error = difference.norm();
  out.errors = difference.cwiseAbs().rowwise().maxCoeff();
  return out;
}

std::vector<Generation> generations(Fields& fields, const Vector& from, int depth) {
  const Eigen::Index rows = fields.coordinates(), each = fields.count();
  const Eigen::Index paths = (rows + each - 1) / each + 1;
  std::mt19937 random(1);
  std::vector<Path> words;
  for (Eigen::Index w = 0; w < paths; ++w)
    words.push_back(random_path(random, each, std::max(2, depth - 1)));
  const int degree = depth > 3 ? 16 : 10;
  constexpr double never = std::numeric_limits<double>::infinity();
  std::vector<Generation> out(static_cast<size_t>(depth), {Matrix::Zero(rows, each * paths), 0,
                                                           never, Vector::Constant(rows, never)});
  std::vector<double> best(out.size(), never);
  std::vector<Matrix> before(out.size(), Matrix(rows, each * paths)), now = before;
  const double length = own_length(fields, from);
  double last = 0, unit = 0.02;  // of the length
  for (const double part : {2.0, 1.4, 1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.12}) {
    const double radius = part * length;
    for (Eigen::Index w = 0; w < paths; ++w) {
      const auto fitted =
          coefficients(fields, words[static_cast<size_t>(w)], radius, degree, from, unit * length);
      for (size_t j = 0; j < out.size(); ++j) now[j].middleCols(each * w, each) = fitted[j];
    }
    bool known = last > 0;
    for (size_t j = 0; j < out.size() && last > 0; ++j) {
      const double ratio = std::pow(last / radius, static_cast<double>(j)), size = before[j].norm();
      const Matrix difference = now[j] * ratio - before[j];
      const double error = difference.norm();
      const double relative = error / std::max(size, kNothing * before[0].norm());
      if (relative < best[j]) {
        best[j] = relative;
        out[j] = {before[j], size, error, difference.cwiseAbs().rowwise().maxCoeff()};
      }
      known = known && best[j] < 1e-7;
    }
    if (known) break;
    before.swap(now);
    last = radius;
    unit = 0.032 - unit;  // 0.02, 0.012: two radii differ by the errors of the differences, too
  }
  return out;
}

}  // namespace hamel::carried
