// Functions of SE(3) that no step calls, compiled once.
#include <hamel/groups/se3.hpp>

namespace hamel {

std::vector<std::string> SE3::columns() {
  std::vector<std::string> names = SO3::columns();
  names.insert(names.end(), {"x", "y", "z"});
  return names;
}
std::vector<std::string> SE3::units() {
  std::vector<std::string> units = SO3::units();
  units.insert(units.end(), 3, "m");
  return units;
}
std::vector<Component> SE3::components() {
  std::vector<Component> components = SO3::components();
  components.insert(components.end(), {{"v1", "m/s"}, {"v2", "m/s"}, {"v3", "m/s"}});
  return components;
}

void SE3::coordinate_rates(std::span<const double> x, std::span<const double> xi,
                           std::span<double> out) {
  using Rows = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  SO3::coordinate_rates(x, xi, out);
  Eigen::Map<Vec<3>>(out.data() + 9) = Rows(x.data()) * Eigen::Map<const Vec<3>>(xi.data() + 3);
}

void SE3::add_pulled_back(std::span<const double> x, std::span<const double> slope,
                          std::span<double> out) {
  using Rows = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  SO3::add_pulled_back(x, slope, out);
  Eigen::Map<Vec<3>>(out.data() + 3) +=
      Rows(x.data()).transpose() * Eigen::Map<const Vec<3>>(slope.data() + 9);
}

SE3Element<double> SE3::from_coordinates(std::span<const double> values) {
  check_coordinates<SE3>(values);
  return {SO3::rotation_from("se3", values), {values[9], values[10], values[11]}};
}

SE3Element<double> SE3::nearest(std::span<const double> values) {
  return {SO3::nearest(values), {values[9], values[10], values[11]}};
}

template <>
GroupInfo group_info<SE3>() {
  return detail::erased_group<SE3>();
}

}  // namespace hamel
