#include <hamel/systems/mechanisms/programs/agreement_formulas.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/systems/mechanisms/programs/recorded_mechanism.hpp>

namespace hamel::mechanisms {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNoEntry = 1e-9;  // of a row of length 1
constexpr double kPivot = 0.3;     // of the largest entry of its row
constexpr size_t kExpanded = 2;    // pivots: the velocities of a base but one

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

// Pivots but the last ones divide: what is left is a determinant, in which none may vanish.
Number Agreement::formula(std::span<const RecordedRow> rows) const {
  std::vector<std::vector<Number>> a;
  for (const auto& [i, j] : pivots) a.push_back(rows[static_cast<size_t>(i)].coefficients);
  a.push_back(rows[static_cast<size_t>(row)].coefficients);
  const size_t divided = pivots.size() - std::min(pivots.size(), kExpanded);
  for (size_t k = 0; k < divided; ++k) {
    const auto column = static_cast<size_t>(pivots[k].second);
    for (size_t below = k + 1; below < a.size(); ++below) {
      if (a[below][column].is(0)) continue;
      const Number factor = a[below][column] / a[k][column];
      for (size_t j = 0; j < a[k].size(); ++j) a[below][j] -= factor * a[k][j];
      a[below][column] = 0;
    }
  }
  std::vector<size_t> columns;
  for (size_t k = divided; k < pivots.size(); ++k)
    columns.push_back(static_cast<size_t>(pivots[k].second));
  columns.push_back(static_cast<size_t>(velocity));
  return determinant(std::span(a).subspan(divided), columns);
}

RecordedRow agreement_row(const Agreement& agreement, std::span<const RecordedRow> rows,
                          const BodyFormulas& bodies, const ConstraintRows& kinds,
                          const RowInputs& inputs) {
  RecordedRow out;
  out.phi = agreement.formula(rows);
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

std::vector<Agreement> find_agreements(const MechanismParts& parts,
                                       const std::vector<std::vector<double>>& states,
                                       const VectorXd& units) {
  const RecordedMechanism mechanism(parts);
  std::vector<Sample> samples;
  for (const std::vector<double>& state : states) samples.emplace_back(state);
  Sample& here = samples.front();
  const auto k = static_cast<Eigen::Index>(mechanism.rows.size()), n = units.size();
  MatrixXd a(k, n);
  for (Eigen::Index i = 0; i < k; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      a(i, j) =
          units[j] *
          here.value(mechanism.rows[static_cast<size_t>(i)].coefficients[static_cast<size_t>(j)]);
  for (Eigen::Index i = 0; i < k; ++i) a.row(i) /= std::max(a.row(i).norm(), 1e-300);

  Agreement base;
  std::vector<bool> taken(static_cast<size_t>(k), false);
  std::vector<VectorXd> covered;
  while (const auto pivot = cheapest_pivot(a, taken)) {
    const auto [row, column] = *pivot;
    base.pivots.emplace_back(parts.kept[static_cast<size_t>(row)], column);
    taken[static_cast<size_t>(row)] = true;
    covered.push_back(beyond(covered, a.row(row).transpose()).normalized());
    for (Eigen::Index i = 0; i < k; ++i)
      if (!taken[static_cast<size_t>(i)]) {
        a.row(i) -= a(i, column) / a(row, column) * a.row(row);
        a(i, column) = 0;
      }
  }

  // The rows in the order of ConstraintRows::each().
  std::vector<RecordedRow> rows;
  for (size_t i = 0; i < parts.kept.size(); ++i) {
    const auto at = static_cast<size_t>(parts.kept[i]);
    if (rows.size() <= at) rows.resize(at + 1);
    rows[at] = mechanism.rows[i];
  }
  std::vector<Agreement> out;
  for (size_t i = 0; i < taken.size(); ++i) {
    if (taken[i]) continue;
    Agreement one = base;
    one.row = parts.kept[i];
    for (one.velocity = 0; one.velocity < n; ++one.velocity) {
      const RecordedRow psi =
          agreement_row(one, rows, mechanism.bodies, parts.rows, mechanism.row_inputs());
      const auto size_of_row = [&](Sample& sample) {
        double sum = 0;
        for (Eigen::Index j = 0; j < n; ++j)
          sum += std::abs(units[j] * sample.value(rows[static_cast<size_t>(one.row)]
                                                      .coefficients[static_cast<size_t>(j)]));
        return sum;
      };
      if (std::ranges::all_of(samples, [&](Sample& sample) {
            return std::abs(units[one.velocity] * sample.value(psi.phi)) <=
                   kNoEntry * size_of_row(sample);
          }))
        continue;
      VectorXd slope(n);
      for (Eigen::Index j = 0; j < n; ++j)
        slope[j] = units[j] * here.value(psi.coefficients[static_cast<size_t>(j)]);
      const double size = slope.norm();
      if (!(size > 0)) continue;
      const VectorXd rest = beyond(covered, slope / size);
      if (rest.norm() < 1e-6) continue;
      covered.push_back(rest.normalized());
      out.push_back(one);
    }
  }
  return out;
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
