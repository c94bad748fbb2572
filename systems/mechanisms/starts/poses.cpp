#include <hamel/systems/mechanisms/starts/poses.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <hamel/framework/lie/decompositions.hpp>

namespace hamel::mechanisms {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Numbers in [-1, 1] without a pattern, the same in every run.
VectorXd scattered(int n, int seed) {
  VectorXd out(n);
  for (int i = 0; i < n; ++i) out[i] = std::sin(12.9898 * (i + 1) + 78.233 * seed);
  return out;
}

std::vector<double> move(const Multibody& system, const std::vector<double>& g,
                         const VectorXd& eta) {
  std::vector<double> out(g.size());
  system.geometry().tau(eta.data(), out.data());
  system.geometry().compose(g.data(), out.data(), out.data());
  return out;
}

// Marks the heights of contacts that are drawn on the ground.
std::vector<bool> drawn_on_ground(const Multibody& system, bool wanted) {
  const std::vector<RowInfo>& words = system.row_info();
  std::vector<bool> out(words.size());
  if (!wanted) return out;
  const VectorXd drawn = RowValues(system, system.drawn()).phi;
  for (size_t i = 0; i < words.size(); ++i)
    out[i] = words[i].height && std::abs(drawn[static_cast<Eigen::Index>(i)]) < 1e-6;
  return out;
}

}  // namespace

RowValues::RowValues(const Multibody& system, const std::vector<double>& g, double t) {
  const auto rows = static_cast<Eigen::Index>(system.row_info().size());
  a.resize(rows, system.dim());
  b.resize(rows);
  phi = VectorXd::Zero(rows);
  system.look(t, g.data(), a, b, phi);
}

VectorXd least(const MatrixXd& a, const VectorXd& b) {
  if (a.size() == 0) return VectorXd::Zero(a.cols());
  return dense::least_norm(a, b, 1e-9);
}

std::vector<std::vector<double>> poses_around(const Multibody& system,
                                              const std::vector<double>& g) {
  std::vector<std::vector<double>> out{g};
  for (int seed = 1; seed <= 4; ++seed)
    out.push_back(move(system, g, 0.7 * scattered(system.dim(), seed)));
  return out;
}

double satisfy(const Multibody& system, const std::vector<bool>& fixed, std::vector<double>& g,
               int but_for, bool touching) {
  const std::vector<RowInfo>& words = system.row_info();
  const std::vector<Prescribed>& prescribed = system.all_rows().prescribed;
  const std::vector<bool> on_ground = drawn_on_ground(system, touching);
  for (int k = 0;; ++k) {
    RowValues looked(system, g);
    for (Eigen::Index i = 0; i < looked.a.rows(); ++i) {
      const RowInfo& word = words[static_cast<size_t>(i)];
      const bool open = word.slips && !on_ground[static_cast<size_t>(i)];
      if (!word.holonomic || open) looked.a.row(i).setZero();
      if (open) looked.phi[i] = 0;
    }
    for (size_t i = 0; i < prescribed.size(); ++i) {
      if (prescribed[i].dof != but_for) continue;
      const auto row = static_cast<Eigen::Index>(words.size() - prescribed.size() + i);
      looked.a.row(row).setZero();
      looked.phi[row] = 0;
    }
    const double off = looked.phi.size() == 0 ? 0 : looked.phi.lpNorm<Eigen::Infinity>();
    if (k == 30 || off < 1e-15 || !std::isfinite(off)) return off;
    for (int j = 0; j < system.dim(); ++j) {
      if (fixed[static_cast<size_t>(j)]) looked.a.col(j).setZero();
    }
    VectorXd step = -least(looked.a, looked.phi);
    if (step.norm() > 0.3) step *= 0.3 / step.norm();
    g = move(system, g, step);
  }
}

std::vector<std::vector<double>> poses_on_rows(const Multibody& system,
                                               const std::vector<double>& g) {
  std::vector<std::vector<double>> out{g};
  const std::vector<bool> fixed(static_cast<size_t>(system.dim()), false);
  for (int seed = 1; seed <= 3; ++seed) {
    const VectorXd any = 0.2 * scattered(system.dim(), seed);
    MatrixXd a = RowValues(system, g).a;
    a.bottomRows(static_cast<Eigen::Index>(system.all_rows().prescribed.size())).setZero();
    for (Eigen::Index i = 0; i < a.rows(); ++i)
      if (system.row_info()[static_cast<size_t>(i)].slips) a.row(i).setZero();
    std::vector<double> pose = move(system, g, any - least(a, VectorXd(a * any)));
    if (satisfy(system, fixed, pose) < 1e-12) out.push_back(std::move(pose));
  }
  return out;
}

// Gram-Schmidt on the rows of unit length, those of phi first: what is left of a row below 1e-9 is
// none.
std::map<int, Repeat> repeated_rows(const Multibody& system, const std::vector<double>& g,
                                    std::vector<int> rows, const std::vector<double>& times) {
  const std::vector<RowInfo>& words = system.row_info();
  std::stable_partition(rows.begin(), rows.end(),
                        [&](int i) { return words[static_cast<size_t>(i)].holonomic; });
  const MatrixXd a = RowValues(system, g).a;
  std::vector<VectorXd> drifts;
  for (const double t : times) drifts.push_back(RowValues(system, g, t).b);
  const Ground& ground = system.all_rows().ground;
  const double moves = ground.velocity.norm() + std::abs(ground.rate);
  MatrixXd basis(0, system.dim());      // rows of unit length
  std::vector<VectorXd> perpendicular;  // what each adds to those before, of unit length
  std::vector<int> taken;
  std::map<int, Repeat> out;
  for (const int i : rows) {
    const double length = a.row(i).norm();
    const VectorXd row = a.row(i).transpose() / std::max(length, 1e-300);
    VectorXd rest = row;
    for (int pass = 1; pass <= 2; ++pass)  // the second takes what round-off has left
      for (const VectorXd& e : perpendicular) rest -= e.dot(rest) * e;
    if (rest.norm() > 1e-9) {
      perpendicular.push_back(rest.normalized());
      basis.conservativeResize(basis.rows() + 1, Eigen::NoChange);
      basis.bottomRows(1) = row.transpose();
      taken.push_back(i);
      continue;
    }
    const VectorXd parts = least(basis.transpose(), row);
    Repeat& repeat = out[i];
    std::vector<double> factors;
    for (Eigen::Index j = 0; j < parts.size(); ++j) {
      if (!(std::abs(parts[j]) > 1e-6)) continue;
      repeat.others.push_back(taken[static_cast<size_t>(j)]);
      factors.push_back(length * parts[j] / a.row(repeat.others.back()).norm());
    }
    for (const VectorXd& b : drifts) {  // one that is not finite at this time decides nothing
      double apart = b[i], size = std::abs(b[i]);
      for (size_t j = 0; j < factors.size(); ++j) {
        const double part = factors[j] * b[repeat.others[j]];
        apart -= part;
        size += std::abs(part);
      }
      const double round_off = 1e-12 * (moves + b.lpNorm<Eigen::Infinity>());
      repeat.contradicts |= std::abs(apart) > 1e-6 * size + round_off;
    }
  }
  return out;
}

std::vector<int> rows_that_constrain(const Multibody& system, const std::vector<double>& drawn) {
  const std::vector<RowInfo>& words = system.row_info();
  const auto around = poses_around(system, drawn);
  std::vector<int> out;
  for (size_t i = 0; i < words.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if ((!words[i].holonomic && !words[i].slips) ||
        std::ranges::any_of(around, [&](const auto& pose) {
          return RowValues(system, pose).a.row(row).norm() > 1e-11;
        }))
      out.push_back(static_cast<int>(i));
  }
  return out;
}

Redundancy find_redundancy(const Multibody& system, const std::vector<std::vector<double>>& places,
                           const std::vector<int>& left_out) {
  const bool timed = !system.all_rows().prescribed.empty();  // are there rates b(t)?
  const std::vector<double> times =
      timed ? std::vector<double>{0, -1.3, 0.7, 1.9, 5.3, 14.1, 37.7, 101.3}  // s, of no period
            : std::vector<double>{0};
  std::vector<int> speaking = rows_that_constrain(system, places.front());
  std::erase_if(speaking, [&](int row) { return std::ranges::count(left_out, row) > 0; });
  Redundancy out;
  std::map<int, size_t> dependent;
  std::vector<std::vector<double>> poses;
  for (const auto& place : places) {
    for (auto& pose : poses_on_rows(system, place)) poses.push_back(std::move(pose));
  }
  for (const auto& pose : poses) {
    for (const auto& [row, here] : repeated_rows(system, pose, speaking, times)) {
      ++dependent[row];
      auto& [others, contradicts] = out.repeats[row];
      for (const int other : here.others)
        if (std::find(others.begin(), others.end(), other) == others.end()) others.push_back(other);
      contradicts |= here.contradicts;
    }
  }
  std::erase_if(out.repeats,
                [&](const auto& entry) { return dependent[entry.first] < poses.size(); });
  for (const int i : speaking)
    if (!out.repeats.contains(i)) out.rows.push_back(i);
  return out;
}

}  // namespace hamel::mechanisms
