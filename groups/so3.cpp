// Functions of SO(3) that no step calls, compiled once.
#include <hamel/groups/so3.hpp>

#include <stdexcept>

namespace hamel {

std::vector<std::string> SO3::columns() {
  return {"R11", "R12", "R13", "R21", "R22", "R23", "R31", "R32", "R33"};
}
std::vector<std::string> SO3::units() { return std::vector<std::string>(9); }
std::vector<Component> SO3::components() {
  return {{"omega1", "rad/s"}, {"omega2", "rad/s"}, {"omega3", "rad/s"}};
}

void SO3::coordinate_rates(std::span<const double> x, std::span<const double> xi,
                           std::span<double> out) {
  const Eigen::Map<const Vec<3>> turn(xi.data());
  for (std::size_t i = 0; i < 9; i += 3) {  // row by row
    const Eigen::Map<const Vec<3>> row(x.data() + i);
    Eigen::Map<Vec<3>>(out.data() + i) = row.cross(turn);
  }
}

void SO3::add_pulled_back(std::span<const double> x, std::span<const double> slope,
                          std::span<double> out) {
  using Rows = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  const Mat<3, 3> b = Rows(x.data()).transpose() * Rows(slope.data());
  out[0] += b(2, 1) - b(1, 2);
  out[1] += b(0, 2) - b(2, 0);
  out[2] += b(1, 0) - b(0, 1);
}

Mat<3, 3> SO3::from_coordinates(std::span<const double> values) {
  check_coordinates<SO3>(values);
  return rotation_from("so3", values);
}

Mat<3, 3> SO3::nearest(std::span<const double> values) {
  Element<double> g;
  for (int i = 0; i < 9; ++i) g(i / 3, i % 3) = values[static_cast<std::size_t>(i)];
  for (int i = 0; i < 6; ++i) g = normalise(g);
  return g;
}

Mat<3, 3> SO3::rotation_from(const char* group, std::span<const double> values) {
  Element<double> g;
  for (int i = 0; i < 9; ++i) g(i / 3, i % 3) = values[static_cast<std::size_t>(i)];
  const double error = defect(g);
  if (!(error <= 1e-6)) {
    throw std::invalid_argument(std::string(group) +
                                ": R11..R33 has max(|R^T R - I|, |det R - 1|) = " + to_text(error) +
                                ", expected a rotation matrix (at most 1e-6)");
  }
  return error > 2e-15 ? normalise(normalise(g)) : g;
}

template <>
GroupInfo group_info<SO3>() {
  return detail::erased_group<SO3>();
}

}  // namespace hamel
