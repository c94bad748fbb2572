// Rows that were dropped: a = sum x_j a_j of rows that are kept holds as long as b = sum x_j b_j.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/starts/poses.hpp>

namespace hamel::mechanisms {
namespace {

constexpr double kNoPart = 1e-9, kApart = 1e-6, kRoundOff = 1e-12;

// "fl.rate - 2 fr.rate"
void append(std::string& sum, double factor, const std::string& name) {
  if (std::abs(factor) < kNoPart) return;
  const double size = std::abs(factor);
  sum += sum.empty() ? (factor < 0 ? "-" : "") : (factor < 0 ? " - " : " + ");
  if (std::abs(size - 1) > kNoPart) sum += fmt::format("{:.6g} ", size);
  sum += name;
}

}  // namespace

void Multibody::imply(std::vector<int> rows) { implied_ = std::move(rows); }

// Where nothing is prescribed but what stands still, b of all rows is that of the ground.
bool Multibody::rates_may_contradict() const {
  return !implied_.empty() && std::ranges::any_of(rows_.prescribed, [](const Prescribed& p) {
    return p.driven || p.time_dependent || p.rate(0) != 0;
  });
}

std::vector<ImpliedRow> Multibody::implied_rows(double t, const double* g) const {
  std::vector<ImpliedRow> out;
  if (implied_.empty()) return out;
  const RowValues at(*this, std::vector<double>(g, g + drawn().size()), t);
  const std::vector<int> holding = this->holding();
  const Eigen::MatrixXd kept = at.a(holding, Eigen::all).transpose();
  const Eigen::Index first =
      at.b.size() - static_cast<Eigen::Index>(rows_.prescribed.size());  // of the prescribed
  const auto name = [&](int row) {
    const auto i = static_cast<size_t>(row - first);
    return row < first ? row_info_[static_cast<size_t>(row)].name
                       : rows_.prescribed[i].name + ".rate";
  };
  const double ground = rows_.ground.velocity.norm() + std::abs(rows_.ground.rate);
  for (const int row : implied_) {
    const Eigen::VectorXd parts = least(kept, at.a.row(row).transpose());
    ImpliedRow implied{row, name(row), "", at.b[row], 0, false};
    double size = std::abs(implied.is);
    for (Eigen::Index j = 0; j < parts.size(); ++j) {
      const int other = holding[static_cast<size_t>(j)];
      const double part = parts[j] * at.b[other];
      implied.has_to_be += part;
      size += std::abs(part);
      if (other >= first) append(implied.sum, parts[j], name(other));
    }
    const double round_off = kRoundOff * (ground + at.b.lpNorm<Eigen::Infinity>());
    implied.contradicts = std::abs(implied.is - implied.has_to_be) > kApart * size + round_off;
    out.push_back(std::move(implied));
  }
  return out;
}

std::string Multibody::contradiction(double t, const double* g) const {
  if (!rates_may_contradict()) return "";
  for (const ImpliedRow& row : implied_rows(t, g))
    if (row.contradicts)
      return fmt::format("rows contradict each other at t = {:.6g}: {}", t, row.in_words());
  return "";
}

std::string ImpliedRow::in_words() const {
  const std::string rest = sum.empty() ? std::string("0") : sum;
  return fmt::format("{} has to be {} = {:.6g}: got {:.6g}", name, rest, has_to_be, is);
}

}  // namespace hamel::mechanisms
