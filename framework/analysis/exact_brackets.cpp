#include <hamel/framework/analysis/exact_brackets.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include <hamel/framework/lie/decompositions.hpp>

namespace hamel::carried {
namespace {

constexpr double kNoise = std::numeric_limits<double>::epsilon();
constexpr double kMargin = 4;  // of the errors, over the difference that noise makes

std::vector<Vector> random_controls(std::mt19937& random, Eigen::Index fields, int depth) {
  std::vector<Vector> out;
  for (int i = 0; i < depth; ++i) {
    Vector u(fields);
    for (double& entry : u) entry = 2 * (static_cast<double>(random()) / 4294967295.0) - 1;
    out.push_back(u.normalized());
  }
  return out;
}

}  // namespace

ExactBrackets::ExactBrackets(const graph::VectorFields& fields, const Vector& g,
                             const Vector& units)
    : n_(units.size()),
      m_(static_cast<Eigen::Index>(fields.velocities.size()) / units.size()),
      velocities_(*fields.recording, fields.velocities),
      moves_(*fields.recording, fields.moves),
      rates_(*fields.recording, fields.rates),
      units_(units),
      possible_(velocities_.possible() && moves_.possible() && rates_.possible()) {
  if (!possible_) return;
  const Matrix e = units.cwiseInverse().asDiagonal() * evaluate(velocities_, g, n_);
  possible_ = e.allFinite();
  if (possible_) combination_ = dense::inverse(dense::qr(e).r.topRows(m_));  // E C: orthonormal
}

Matrix ExactBrackets::evaluate(graph::NilpotentEvaluation& evaluation, const Vector& g,
                               Eigen::Index rows) const {
  Numbers out = evaluation(0, {g.data(), static_cast<size_t>(g.size())});
  return Eigen::Map<const Matrix>(out.data(), rows, static_cast<Eigen::Index>(out.size()) / rows);
}

// x += sign e_unit U(x), U = sum of the fields with these controls.
void ExactBrackets::flow(const Vector& controls, int units, int unit, double sign, double noise,
                         Numbers& x) {
  const size_t size = size_t{1} << units, bit = size_t{1} << unit;
  const Numbers rates = rates_(units, x, noise);
  const size_t numbers = x.size() / size;
  const Vector weights = sign * (combination_ * controls);
  for (size_t k = 0; k < numbers; ++k)
    for (size_t s = 0; s < size; ++s) {
      if ((s & bit) != 0) continue;
      double sum = 0;
      for (Eigen::Index a = 0; a < m_; ++a)
        sum += weights[a] * rates[(static_cast<size_t>(a) * numbers + k) * size + s];
      x[k * size + (s | bit)] += sum;
    }
}

// Entry j: the brackets of j + 1 fields.
std::vector<Matrix> ExactBrackets::brackets(const Vector& g, const std::vector<Vector>& controls,
                                            double noise) {
  const auto depth = static_cast<int>(controls.size()), units = depth + 1;
  const auto numbers = static_cast<size_t>(g.size());
  const size_t size = size_t{1} << units, sets = size / 2;  // delta is the last unit
  Numbers x(numbers * size);
  for (size_t k = 0; k < numbers; ++k) x[k * size] = g[static_cast<Eigen::Index>(k)];
  for (int i = 0; i < depth; ++i) flow(controls[static_cast<size_t>(i)], units, i, 1, noise, x);
  const Matrix moves = evaluate(moves_, g, g.size());
  std::vector<Matrix> out(static_cast<size_t>(depth) + 1, Matrix(n_, 0));
  for (Eigen::Index b = 0; b < m_; ++b) {
    Numbers y = x;
    flow(Vector::Unit(m_, b), units, depth, 1, noise, y);
    for (int i = depth - 1; i >= 0; --i)
      flow(controls[static_cast<size_t>(i)], units, i, -1, noise, y);
    Matrix moved(g.size(), static_cast<Eigen::Index>(sets));
    for (size_t k = 0; k < numbers; ++k)
      for (size_t s = 0; s < sets; ++s)
        moved(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(s)) = y[k * size + sets + s];
    const Matrix velocities =
        units_.cwiseInverse().asDiagonal() * dense::solve_pivoted(moves, moved);
    for (size_t s = 0; s < sets; ++s) {
      Matrix& generation = out[static_cast<size_t>(std::popcount(s))];
      generation.conservativeResize(Eigen::NoChange, generation.cols() + 1);
      generation.rightCols(1) = velocities.col(static_cast<Eigen::Index>(s));
    }
  }
  return out;
}

std::vector<Generation> ExactBrackets::generations(const Vector& g, int depth) {
  std::mt19937 random(1);
  const Eigen::Index words = (n_ + m_ - 1) / m_ + 1;
  std::vector<Generation> out;
  std::vector<Matrix> noise(static_cast<size_t>(depth), Matrix(n_, 0));
  for (int j = 0; j < depth; ++j) out.push_back({Matrix(n_, 0), 0, 0, {}});
  const auto append = [](Matrix& to, const Matrix& more) {
    to.conservativeResize(Eigen::NoChange, to.cols() + more.cols());
    to.rightCols(more.cols()) = more;
  };
  for (Eigen::Index w = 0; w < words; ++w) {
    const std::vector<Vector> controls = random_controls(random, m_, depth - 1);
    const std::vector<Matrix> found = brackets(g, controls, 0),
                              first = brackets(g, controls, kNoise),
                              second = brackets(g, controls, kNoise);
    for (size_t j = 0; j < out.size(); ++j) {
      append(out[j].brackets, found[j]);
      append(noise[j],
             (first[j] - found[j]).cwiseAbs().cwiseMax((second[j] - found[j]).cwiseAbs()));
    }
  }
  // In the length over which the fields are smooth, 1 at most: (e/r)^j of a generation's brackets.
  double length = 1;
  for (size_t j = 1; j < out.size(); ++j) {
    const double ratio = out[0].brackets.norm() / out[j].brackets.norm() *
                         std::sqrt(static_cast<double>(out[j].brackets.cols()) /
                                   static_cast<double>(out[0].brackets.cols()));
    length = std::min(length, std::pow(ratio, 1 / static_cast<double>(j)));
  }
  double scale = 1;
  for (size_t j = 0; j < out.size(); ++j) {
    Generation& generation = out[j];
    generation.brackets *= scale;
    noise[j] *= kMargin * scale;
    generation.size = generation.brackets.norm();
    generation.error = noise[j].norm();
    generation.errors = noise[j].rowwise().maxCoeff();
    scale *= length;
  }
  return out;
}

}  // namespace hamel::carried
