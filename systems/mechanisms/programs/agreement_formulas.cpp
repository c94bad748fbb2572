#include <hamel/systems/mechanisms/programs/agreement_formulas.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/systems/mechanisms/programs/recorded_mechanism.hpp>

namespace hamel::mechanisms {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNoEntry = 1e-9;      // of a row of length 1
constexpr double kPivot = 0.3;         // of the largest entry of its row
constexpr size_t kMostFactors = 5;     // of a term: with more, the earliest divide
constexpr double kIndependent = 1e-6;  // of a direction of length 1

struct Entry {
  int row, velocity;
};

// The pivot of a rank-revealing elimination with the fewest others in its row and column.
std::optional<Entry> cheapest_pivot(const MatrixXd& a, const std::vector<bool>& taken) {
  std::optional<Entry> out;
  Eigen::Index least = 0;
  const auto entries = [](const auto& line) { return (line.array().abs() > kNoEntry).count() - 1; };
  for (int i = 0; i < a.rows(); ++i) {
    const double most = a.row(i).lpNorm<Eigen::Infinity>();
    if (taken[static_cast<size_t>(i)] || most <= kNoEntry) continue;
    for (int j = 0; j < a.cols(); ++j) {
      if (std::abs(a(i, j)) < kPivot * most) continue;
      const Eigen::Index cost = entries(a.row(i)) * entries(a.col(j));
      if (out && cost >= least) continue;
      out = {i, j};
      least = cost;
    }
  }
  return out;
}

// By the first row; zeros of the formula cost nothing.
Number determinant(std::span<const std::vector<Number>> rows, const std::vector<size_t>& columns) {
  if (columns.empty()) return 1;
  Number out = 0;
  for (size_t j = 0; j < columns.size(); ++j) {
    const Number& entry = rows.front()[columns[j]];
    if (entry.is(0)) continue;
    std::vector<size_t> others = columns;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(j));
    const Number minor = entry * determinant(rows.subspan(1), others);
    out += j % 2 == 0 ? minor : -minor;
  }
  return out;
}

// Part of a vector that no orthonormal row covers.
VectorXd beyond(const std::vector<VectorXd>& rows, VectorXd v) {
  for (int pass = 1; pass <= 2; ++pass)
    for (const VectorXd& row : rows) v -= row.dot(v) * row;
  return v;
}

}  // namespace

Agreement::Formula Agreement::formula(std::span<const RecordedRow> rows) const {
  std::vector<std::vector<Number>> a;
  for (const auto& [i, j] : pivots) a.push_back(rows[static_cast<size_t>(i)].coefficients);
  a.push_back(rows[static_cast<size_t>(row)].coefficients);
  std::vector<size_t> left(pivots.size());
  std::iota(left.begin(), left.end(), 0);
  const auto entry = [&](size_t k) { return a[k][static_cast<size_t>(pivots[k].second)]; };
  while (!left.empty()) {
    auto next = std::ranges::find_if(
        left, [&](size_t k) { return entry(k).constant() && !entry(k).is(0); });
    if (next == left.end() && left.size() > kMostFactors) next = left.begin();
    if (next == left.end()) break;
    const size_t k = *next;
    left.erase(next);
    const auto column = static_cast<size_t>(pivots[k].second);
    std::vector<size_t> others = left;
    others.push_back(pivots.size());
    for (const size_t other : others) {
      if (a[other][column].is(0)) continue;
      const Number factor = a[other][column] / a[k][column];
      for (size_t j = 0; j < a[k].size(); ++j) a[other][j] -= factor * a[k][j];
      a[other][column] = 0;
    }
  }
  Formula out;
  std::vector<std::vector<Number>> factors;
  std::vector<size_t> columns;
  for (const size_t k : left) {
    factors.push_back(a[k]);
    columns.push_back(static_cast<size_t>(pivots[k].second));
    out.factors.push_back(pivots[k]);
  }
  factors.push_back(a.back());
  columns.push_back(static_cast<size_t>(velocity));
  out.psi = determinant(factors, columns);
  return out;
}

RecordedRow agreement_row(const Agreement& agreement, std::span<const RecordedRow> rows,
                          const BodyFormulas& bodies, const ConstraintRows& kinds,
                          const RowInputs& inputs) {
  RecordedRow out;
  out.phi = agreement.formula(rows).psi;
  std::vector<Number> places(inputs.g.begin(), inputs.g.end());
  places.insert(places.end(), inputs.coupled.begin(), inputs.coupled.end());
  const std::vector<Number> slopes = graph::gradient({out.phi}, {1}, places);
  const std::vector<Number> xi(inputs.xi.begin(), inputs.xi.end());
  for (size_t i = 0; i < xi.size(); ++i) {
    std::vector<Number> unit(xi.size());
    unit[i] = 1;
    const std::vector<Number> moves = graph::along(bodies.element_rates(), xi, unit);
    Number coefficient = 0;
    for (size_t k = 0; k < moves.size(); ++k) coefficient += slopes[k] * moves[k];
    for (size_t k = 0; k < kinds.coupled_links.size(); ++k)
      if (bodies.tree().first(kinds.coupled_links[k]) == static_cast<int>(i))
        coefficient += slopes[moves.size() + k];
    out.coefficients.push_back(coefficient);
    out.value += coefficient * xi[i];
  }
  return out;
}

namespace {

class AgreementSearch {
 public:
  AgreementSearch(const MechanismParts& parts, const std::vector<std::vector<double>>& states,
                  const VectorXd& units)
      : parts_(parts), mechanism_(parts), units_(units) {
    for (const std::vector<double>& state : states) samples_.emplace_back(state);
    // As ConstraintRows::each() counts them.
    for (size_t i = 0; i < parts.kept.size(); ++i) {
      const auto at = static_cast<size_t>(parts.kept[i]);
      if (rows_.size() <= at) rows_.resize(at + 1);
      rows_[at] = mechanism_.rows[i];
    }
  }

  std::vector<Agreement> operator()() {
    find_base();
    std::vector<Agreement> out;
    for (const int row : others_) {
      base_.row = row;
      for (base_.velocity = 0; base_.velocity < units_.size(); ++base_.velocity)
        if (adds()) out.push_back(base_);
    }
    return out;
  }

 private:
  // Coefficients of a row at a sample, in units of the velocities.
  VectorXd at(Sample& sample, const RecordedRow& row) const {
    VectorXd out(units_.size());
    for (Eigen::Index j = 0; j < out.size(); ++j)
      out[j] = units_[j] * sample.value(row.coefficients[static_cast<size_t>(j)]);
    return out;
  }
  const RecordedRow& row(int i) const { return rows_[static_cast<size_t>(i)]; }

  // Pivots at the first sample; the rows that are left.
  void find_base() {
    others_ = parts_.kept;
    MatrixXd a(static_cast<Eigen::Index>(others_.size()), units_.size());
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const VectorXd here = at(samples_.front(), row(others_[static_cast<size_t>(i)]));
      a.row(i) = here.transpose() / std::max(here.norm(), 1e-300);
    }
    std::vector<bool> taken(others_.size(), false);
    while (const auto pivot = cheapest_pivot(a, taken)) {
      const auto [i, column] = *pivot;
      taken[static_cast<size_t>(i)] = true;
      base_.pivots.emplace_back(parts_.kept[static_cast<size_t>(i)], column);
      std::erase(others_, parts_.kept[static_cast<size_t>(i)]);
      covered_.push_back(beyond(covered_, a.row(i).transpose()).normalized());
      for (Eigen::Index k = 0; k < a.rows(); ++k) {
        if (taken[static_cast<size_t>(k)]) continue;
        a.row(k) -= a(k, column) / a(i, column) * a.row(i);
        a(k, column) = 0;
      }
    }
  }

  // Is psi zero at a sample, beside the product of its rows?
  bool vanishes(const Number& psi, Sample& sample) const {
    double size = at(sample, row(base_.row)).lpNorm<1>();
    double unit = units_[base_.velocity];
    for (const auto& [i, column] : base_.formula(rows_).factors) {
      size *= at(sample, row(i)).lpNorm<1>();
      unit *= units_[column];
    }
    return std::abs(unit * sample.value(psi)) <= kNoEntry * size;
  }

  // Is psi an equation, independent of the rows and of those before?
  bool adds() {
    const RecordedRow psi =
        agreement_row(base_, rows_, mechanism_.bodies, parts_.rows, mechanism_.row_inputs());
    if (std::ranges::all_of(samples_, [&](Sample& sample) { return vanishes(psi.phi, sample); }))
      return false;
    const VectorXd slope = at(samples_.front(), psi);
    const double size = slope.norm();
    if (!(size > 0)) return false;
    const VectorXd rest = beyond(covered_, slope / size);
    if (rest.norm() < kIndependent) return false;
    covered_.push_back(rest.normalized());
    return true;
  }

  const MechanismParts& parts_;
  const RecordedMechanism mechanism_;
  const VectorXd& units_;
  std::vector<RecordedRow> rows_;
  std::vector<Sample> samples_;
  Agreement base_;
  std::vector<int> others_;
  std::vector<VectorXd> covered_;  // orthonormal
};

}  // namespace

std::vector<Agreement> find_agreements(const MechanismParts& parts,
                                       const std::vector<std::vector<double>>& states,
                                       const VectorXd& units) {
  return AgreementSearch(parts, states, units)();
}

FilledProgram record_agreements(const MechanismParts& parts) {
  const ConstraintRows& kinds = parts.rows;
  size_t first = kinds.couplings.size();
  for (const Contact& contact : kinds.contacts) first += contact.row_count();
  for (const Loop& loop : kinds.loops) first += loop.row_count();
  std::vector<int> rows;
  for (size_t i = 0; i < kinds.agreements.size(); ++i) rows.push_back(static_cast<int>(first + i));
  const MechanismParts agreements{parts.tree, parts.rows, parts.forces, rows, 0, parts.geometry};
  const RecordedMechanism mechanism(agreements);
  std::vector<Number> out;
  for (const RecordedRow& row : mechanism.rows) out.push_back(row.phi);
  for (const RecordedRow& row : mechanism.rows)
    out.insert(out.end(), row.coefficients.begin(), row.coefficients.end());
  return {mechanism.recording(), out};
}

}  // namespace hamel::mechanisms
