#include <hamel/framework/analysis/exact_brackets.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include <hamel/framework/lie/decompositions.hpp>

namespace hamel::carried {
namespace {

constexpr double kNoise = std::numeric_limits<double>::epsilon();
constexpr double kMargin = 4;    // of the errors, over the difference that noise makes
constexpr double kRank = 1e-10;  // of the rows there
using Index = Eigen::Index;

std::vector<Vector> random_controls(std::mt19937& random, Index fields, int depth) {
  std::vector<Vector> out;
  for (int i = 0; i < depth; ++i) {
    Vector u(fields);
    for (double& entry : u) entry = 2 * (static_cast<double>(random()) / 4294967295.0) - 1;
    out.push_back(u.normalized());
  }
  return out;
}

void append(Matrix& to, const Matrix& more) {
  to.conservativeResize(Eigen::NoChange, to.cols() + more.cols());
  to.rightCols(more.cols()) = more;
}

void add_scaled(double factor, const double* x, size_t size, double* out) {
  if (factor == 0) return;
  for (size_t s = 0; s < size; ++s) out[s] += factor * x[s];
}

}  // namespace

ExactBrackets::ExactBrackets(graph::RowFields rows, const Geometry& geometry, const Vector& units,
                             bool with_drift)
    : formulas_(std::move(rows)),
      units_(units),
      n_(units.size()),
      k_(static_cast<Index>(formulas_.drift.size())),
      drift_(with_drift ? 1 : 0) {
  for (Index x = 0; x < n_; ++x) {  // <mu, ad_x y> = <ad_x^T mu, y>
    for (Index to = 0; to < n_; ++to) {
      const Vector along = Vector::Unit(n_, x), mu = Vector::Unit(n_, to);
      Vector row(n_);
      geometry.ad_transpose(along.data(), mu.data(), row.data());
      for (Index y = 0; y < n_; ++y)
        if (row[y] != 0)
          structure_.push_back({to, x, y, row[y] * units_[x] * units_[y] / units_[to]});
    }
  }
  find_numbers();
}

// The inputs on which the rows depend, and those on which these move, and so on.
void ExactBrackets::find_numbers() {
  const auto n = static_cast<size_t>(n_);
  std::vector<bool> found(formulas_.recording->inputs().size(), false);
  while (true) {
    std::vector<graph::Number> outputs = formulas_.rows;
    outputs.insert(outputs.end(), formulas_.drift.begin(), formulas_.drift.end());
    for (const size_t i : numbers_)
      outputs.insert(outputs.end(), formulas_.moves.begin() + static_cast<std::ptrdiff_t>(i * n),
                     formulas_.moves.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
    evaluation_.emplace(*formulas_.recording, std::move(outputs));
    if (evaluation_->needs() == found) return;
    for (size_t i = 0; i < found.size(); ++i)
      if (evaluation_->needs()[i] && !found[i]) numbers_.push_back(i);
    found = evaluation_->needs();
  }
}

// Random changes of each coefficient, of the size of round-off.
void ExactBrackets::shake(Block& block) {
  if (noise_ == 0) return;
  for (double& x : block.values)
    if (x != 0) x *= 1 + noise_ * evaluation_->random();
}

// At numbers with units; by: the number by which all is differentiated, or -1.
ExactBrackets::Evaluated ExactBrackets::evaluate(const Block& x, Index by) {
  const int units = x.units + (by < 0 ? 0 : 1);
  const size_t size = size_t{1} << units, part = x.size(), behind = by < 0 ? 0 : part;
  Numbers inputs(at_.size() * size, 0.0);
  for (size_t i = 0; i < at_.size(); ++i) inputs[i * size] = at_[i];
  for (size_t l = 0; l < numbers_.size(); ++l) {
    double* const to = inputs.data() + numbers_[l] * size;
    std::copy_n(x(static_cast<Index>(l), 0), part, to);
    if (static_cast<Index>(l) == by) to[part] = 1;
  }
  const Numbers& values = (*evaluation_)(units, inputs, noise_);
  const auto count = static_cast<Index>(numbers_.size());
  Evaluated out{Block(k_, n_, x.units), Block(k_, 1, x.units), Block(count, n_, x.units)};
  const double* from = values.data() + behind;
  const auto take = [&](double scale, double* to) {
    add_scaled(scale, from, part, to);
    from += size;
  };
  for (Index i = 0; i < k_; ++i)
    for (Index j = 0; j < n_; ++j) take(units_[j] / sizes_[i], out.a(i, j));
  for (Index i = 0; i < k_; ++i) take(1 / sizes_[i], out.b(i, 0));
  for (Index l = 0; l < count; ++l)
    for (Index j = 0; j < n_; ++j) take(units_[j], out.t(l, j));
  for (Block* block : {&out.a, &out.b, &out.t}) shake(*block);
  return out;
}

ExactBrackets::Block ExactBrackets::numbers() const {
  Block out(static_cast<Index>(numbers_.size()), 1, 0);
  for (size_t l = 0; l < numbers_.size(); ++l) out.values[l] = at_[numbers_[l]];
  return out;
}

// E and N at at_; false: the rows depend on each other there.
bool ExactBrackets::find_frame() {
  sizes_ = Vector::Ones(k_);
  Evaluated there = evaluate(numbers(), -1);
  Matrix a = Eigen::Map<const Matrix>(there.a.values.data(), k_, n_);
  sizes_ = a.rowwise().norm();
  if (!a.allFinite() || !(sizes_.minCoeff() > 0)) return false;
  a = (sizes_.cwiseInverse().asDiagonal() * a).eval();
  if (dense::rank(a, kRank) < k_) return false;
  const dense::Qr qr = dense::qr(a.transpose());  // A = R^T Q^T
  e_ = qr.q.rightCols(n_ - k_);
  right_ = qr.q.leftCols(k_) * dense::inverse(qr.r.topRows(k_).transpose());
  return true;
}

// rhs = (A N)^-1 rhs: A N is 1, round-off and a nilpotent part.
void ExactBrackets::solve(const Block& a, Block& rhs) const {
  Block part(k_, k_, a.units);
  for (Index i = 0; i < k_; ++i)
    for (Index j = 0; j < k_; ++j) {
      for (Index l = 0; l < n_; ++l) add_scaled(-right_(l, j), a(i, l), a.size(), part(i, j));
      if (i == j) *part(i, j) += 1;
    }
  const Block given = rhs;
  for (int order = 0; order <= a.units; ++order) {
    Block next = given;
    for (Index c = 0; c < rhs.columns; ++c)
      for (Index i = 0; i < k_; ++i)
        for (Index j = 0; j < k_; ++j)
          graph::add_product(a.units, part(i, j), rhs(j, c), next(i, c));
    rhs = std::move(next);
  }
}

// X_0, if it is one of them, and all X_a; the rate of time behind the n components.
ExactBrackets::Block ExactBrackets::fields_at(const Evaluated& at) const {
  const Index fields = e_.cols() + drift_;
  const size_t size = at.a.size();
  Block z(k_, fields, at.a.units), out(n_ + drift_, fields, at.a.units);
  if (drift_ == 1) {
    z.values.assign(at.b.values.begin(), at.b.values.end());
    z.values.resize(size * static_cast<size_t>(k_ * fields));
    *out(n_, 0) = 1;
  }
  for (Index c = 0; c < e_.cols(); ++c)
    for (Index i = 0; i < k_; ++i)
      for (Index l = 0; l < n_; ++l) add_scaled(-e_(l, c), at.a(i, l), size, z(i, c + drift_));
  solve(at.a, z);
  for (Index c = 0; c < fields; ++c)
    for (Index l = 0; l < n_; ++l) {
      if (c >= drift_) *out(l, c) = e_(l, c - drift_);
      for (Index i = 0; i < k_; ++i) add_scaled(right_(l, i), z(i, c), size, out(l, c));
    }
  return out;
}

// K = ad_U - (dU) T at numbers x, of U = u, whose drift has the last component for weight.
ExactBrackets::Block ExactBrackets::transport(const Block& x, const Evaluated& at, const Block& u) {
  const auto count = static_cast<Index>(numbers_.size());
  const size_t size = x.size();
  Block slopes(k_, count, x.units), out(n_ + drift_, n_ + drift_, x.units);
  for (Index l = 0; l < count; ++l) {  // A dU = db - dA U
    const Evaluated d = evaluate(x, l);
    for (Index i = 0; i < k_; ++i) {
      Numbers product(size, 0.0);
      for (Index j = 0; j < n_; ++j)
        graph::add_product(x.units, d.a(i, j), u(j, 0), product.data());
      add_scaled(-1, product.data(), size, slopes(i, l));
      if (drift_ == 1) add_scaled(*u(n_, 0), d.b(i, 0), size, slopes(i, l));
    }
  }
  solve(at.a, slopes);
  Block moved(k_, n_ + drift_, x.units);
  for (Index c = 0; c < n_; ++c)
    for (Index i = 0; i < k_; ++i)
      for (Index l = 0; l < count; ++l)
        graph::add_product(x.units, slopes(i, l), at.t(l, c), moved(i, c));
  for (Index l = 0; l < count; ++l)
    for (Index i = 0; i < k_ && is_time(l); ++i) add_scaled(1, slopes(i, l), size, moved(i, n_));
  for (Index c = 0; c < n_ + drift_; ++c)
    for (Index r = 0; r < n_; ++r)
      for (Index i = 0; i < k_; ++i) add_scaled(-right_(r, i), moved(i, c), size, out(r, c));
  for (const Structure& s : structure_) add_scaled(s.value, u(s.x, 0), size, out(s.to, s.y));
  return out;
}

// x + e T U, with one unit more.
ExactBrackets::Block ExactBrackets::flow(const Block& x, const Evaluated& at,
                                         const Block& u) const {
  Block out(x.rows, 1, x.units + 1);
  for (Index l = 0; l < x.rows; ++l) {
    double* const rate = out(l, 0) + x.size();
    std::copy_n(x(l, 0), x.size(), out(l, 0));
    for (Index j = 0; j < n_; ++j) graph::add_product(x.units, at.t(l, j), u(j, 0), rate);
    if (is_time(l)) add_scaled(1, u(n_, 0), x.size(), rate);
  }
  return out;
}

// V += e K V, e the unit behind those of K.
void ExactBrackets::carry_back(const Block& k, Block& v) const {
  const size_t half = k.size();
  const Block before = v;
  for (Index c = 0; c < v.columns; ++c)
    for (Index r = 0; r < n_; ++r)
      for (Index j = 0; j < v.rows; ++j)
        for (size_t s = 0; s < v.size(); s += 2 * half)
          graph::add_product(k.units, k(r, j), before(j, c) + s, v(r, c) + s + half);
}

// Entry j: the brackets of j + 1 fields.
std::vector<Matrix> ExactBrackets::brackets(const std::vector<Vector>& controls, double noise) {
  noise_ = noise;
  Block x = numbers();
  std::vector<Block> transports;
  for (const Vector& control : controls) {
    const Evaluated at = evaluate(x, -1);
    const Block fields = fields_at(at);
    Block u(n_ + drift_, 1, x.units);
    for (Index c = 0; c < fields.columns; ++c)
      for (Index i = 0; i < fields.rows; ++i)
        add_scaled(control[c], fields(i, c), x.size(), u(i, 0));
    shake(u);
    transports.push_back(transport(x, at, u));
    shake(transports.back());
    x = flow(x, at, u);
  }
  Block v = fields_at(evaluate(x, -1));
  for (auto k = transports.rbegin(); k != transports.rend(); ++k) {
    shake(v);
    carry_back(*k, v);
  }
  std::vector<Matrix> out(controls.size() + 1, Matrix(v.rows, 0));
  for (size_t s = 0; s < v.size(); ++s) {
    Matrix found(v.rows, v.columns);
    for (Index c = 0; c < v.columns; ++c)
      for (Index i = 0; i < v.rows; ++i) found(i, c) = v(i, c)[s];
    append(out[static_cast<size_t>(std::popcount(s))], found);
  }
  return out;
}

// In the length over which the fields are smooth, 1 at most: (e/r)^j of a generation's brackets.
bool ExactBrackets::scale_by_length(std::vector<Generation>& generations,
                                    std::vector<Matrix>& noise) {
  length_ = 1;
  const Matrix& fields = generations[0].brackets;
  for (size_t j = 1; j < generations.size(); ++j) {
    const Matrix& brackets = generations[j].brackets;
    const double ratio =
        fields.norm() / brackets.norm() *
        std::sqrt(static_cast<double>(brackets.cols()) / static_cast<double>(fields.cols()));
    length_ = std::min(length_, std::pow(ratio, 1 / static_cast<double>(j)));
  }
  double scale = 1;
  for (size_t j = 0; j < generations.size(); ++j) {
    Generation& generation = generations[j];
    generation.brackets *= scale;
    noise[j] *= kMargin * scale;
    generation.size = generation.brackets.norm();
    generation.error = noise[j].norm();
    generation.errors = noise[j].rowwise().maxCoeff();
    if (!std::isfinite(generation.size) || !std::isfinite(generation.error)) return false;
    scale *= length_;
  }
  return true;
}

std::vector<Generation> ExactBrackets::generations(const Vector& g, double t, int depth) {
  at_ = formulas_.inputs(g.data(), t);
  noise_ = 0;
  if (!find_frame()) return {};
  std::mt19937 random(1);
  const Index rows = n_ + drift_, fields = e_.cols() + drift_;
  const Index words = (rows + fields - 1) / fields + 1;
  std::vector<Generation> out(static_cast<size_t>(depth), {Matrix(rows, 0), 0, 0, {}});
  std::vector<Matrix> noise(static_cast<size_t>(depth), Matrix(rows, 0));
  for (Index w = 0; w < words; ++w) {
    const std::vector<Vector> controls = random_controls(random, fields, depth - 1);
    const std::vector<Matrix> found = brackets(controls, 0), first = brackets(controls, kNoise),
                              second = brackets(controls, kNoise);
    for (size_t j = 0; j < out.size(); ++j) {
      append(out[j].brackets, found[j]);
      append(noise[j],
             (first[j] - found[j]).cwiseAbs().cwiseMax((second[j] - found[j]).cwiseAbs()));
    }
  }
  return scale_by_length(out, noise) ? out : std::vector<Generation>{};
}

}  // namespace hamel::carried
