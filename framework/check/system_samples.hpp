// Samples that the laws of a system use: its matrices at a configuration, an admissible start,
// other values of its parameters.
#pragma once

#include <cmath>
#include <exception>
#include <limits>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/mechanics/general_system.hpp>

namespace hamel {
namespace check {

/// I, A and b at a configuration; geometry: of any retraction, for systems that are not
/// left-invariant.
struct Matrices {
  Eigen::MatrixXd inertia, rows;
  Eigen::VectorXd drift;
};
inline Matrices matrices_at(const SystemModel& model, const Geometry* geometry,
                            const std::vector<double>& configuration, double t = 0) {
  const Mechanics& mechanics = *model.mechanics;
  const Eigen::Index n = mechanics.dim(), k = mechanics.constraint_count();
  Matrices out{Eigen::MatrixXd(n, n), Eigen::MatrixXd(k, n), Eigen::VectorXd(k)};
  Eigen::VectorXd g;
  if (geometry != nullptr) {  // else the system is left-invariant
    g.resize(geometry->size());
    geometry->from_coordinates(configuration, g.data());
  }
  mechanics.inertia(g.data(), out.inertia);
  mechanics.constraints(t, g.data(), out.rows, out.drift);
  return out;
}

/// The start as a run fills it in: configuration and an admissible velocity.
inline Start admissible_start(const SystemModel& model, const Geometry* geometry = nullptr) {
  Start start = model.start;
  if (start.configuration.empty()) start.configuration = model.group.identity;
  const auto& given = start.velocity.empty() ? start.momentum : start.velocity;
  if (static_cast<int>(given.size()) != model.group.dim) return start;
  const Eigen::VectorXd datum = Eigen::Map<const Eigen::VectorXd>(given.data(), model.group.dim);
  const Matrices at = matrices_at(model, geometry, start.configuration);
  const Eigen::VectorXd mu = start.velocity.empty() ? datum : Eigen::VectorXd(at.inertia * datum);
  const Eigen::MatrixXd e = hamel_frame(at.inertia, at.rows);
  Eigen::VectorXd xi = e * (e.transpose() * mu);
  if (at.drift.norm() > 0) {
    const Eigen::MatrixXd reach = at.inertia.inverse() * at.rows.transpose();
    xi += reach * (at.rows * reach).inverse() * at.drift;
  }
  start.velocity.assign(xi.begin(), xi.end());
  start.momentum.clear();
  return start;
}

/// Another value of a parameter: doubled (whole numbers stay whole), and something else for 0,
/// which stays only where the system takes neither 0.25 nor 1.
inline std::vector<double> changed_value(const SystemInfo& info, const Field& field) {
  for (const double for_zero : {0.25, 1.0, 0.0}) {
    std::vector<double> value = field.value;
    for (double& x : value) x = x == 0 ? for_zero : 2 * x;
    try {
      info.make({{field.name, value}});
      return value;
    } catch (const std::exception&) {
    }
  }
  return field.value;
}

inline double difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

}  // namespace check

}  // namespace hamel
