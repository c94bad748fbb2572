#include <hamel/systems/mechanisms/starts.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/systems/mechanisms/poses.hpp>

namespace hamel::mechanisms {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string in_words(const std::vector<int>& some, const std::vector<RowLabel>& rows) {
  std::vector<std::string> out;
  for (const int i : some) out.push_back(rows[static_cast<size_t>(i)].what);
  return join(out);
}
std::string contradiction(const RowLabel& row, const std::string& list) {
  return list.empty() ? fmt::format(
                            "{} contradicts the joints: its body cannot move with the "
                            "ground",
                            row.what)
                      : fmt::format("{} contradicts {}", row.what, list);
}

Starts::Starts(std::shared_ptr<const Multibody> system, std::string name,
               std::vector<std::string> columns, std::vector<std::string> rates,
               std::vector<RowLabel> rows)
    : system_(std::move(system)),
      name_(std::move(name)),
      columns_(std::move(columns)),
      rates_(std::move(rates)),
      rows_(std::move(rows)) {}

int Starts::root() const {
  const Tree& tree = system_->tree(system_->drawn().data());
  for (int link = 0; link < tree.links(); ++link)
    if (tree.parent(link) == kGround && tree.joint(link).turns_and_slides()) return link;
  return -1;
}

std::vector<int> Starts::turning() const {
  const int link = root();
  if (link < 0) return {};
  const Tree& tree = system_->tree(system_->drawn().data());
  std::vector<int> out = tree.joint(link).turning();
  for (int& velocity : out) velocity += tree.first(link);
  return out;
}

int Starts::ahead() const {
  const std::vector<int> angular = turning();
  return angular.empty() ? -1 : angular.back() + 1;
}

int Starts::rate(const std::string& name) const {
  const auto index = [&](const std::string& wanted) {
    const auto it = std::find(rates_.begin(), rates_.end(), wanted);
    return it == rates_.end() ? -1 : static_cast<int>(it - rates_.begin());
  };
  return name == "speed" ? ahead() : index(name);
}

std::vector<std::string> Starts::mistakes(const std::vector<std::string>& names) const {
  std::vector<std::string> known = columns_, out;
  known.insert(known.end(), rates_.begin(), rates_.end());
  if (rate("speed") >= 0) known.emplace_back("speed");
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      out.push_back(unknown_name("number of the start of " + name_, name, known));
  }
  return out;
}

void Starts::refuse(const std::vector<int>& rows, const Values& values, const Places& places,
                    const std::string& text) const {
  std::vector<std::string> parts, numbers;
  std::string where = name_ + ": ";
  for (const int i : rows) {
    const RowLabel& row = rows_[static_cast<size_t>(i)];
    if (std::find(parts.begin(), parts.end(), row.what) == parts.end()) parts.push_back(row.what);
    where = row.where.empty() ? where : row.where;
  }
  for (const auto& [name, value] : values) {
    numbers.push_back(fmt::format("{} = {}", name, value));
    const auto place = places.find(name);
    if (place != places.end() && !place->second.empty()) where = place->second;
  }
  throw ConfigError(
      {fmt::format("{}start: {}{}{}{}", where, join(parts),
                   parts.empty() || numbers.empty() ? "" : " with ", join(numbers), text)});
}

Starts::Values Starts::prescribed(double t) const {
  Values out;
  const Tree& tree = system_->tree(system_->drawn().data());
  size_t column = 0;
  for (int link = 0; link < tree.links(); ++link) {
    for (const Prescribed& p : system_->all_rows().prescribed)
      if (p.dof == tree.first(link) && p.angle) out[columns_[column]] = p.angle(t);
    column += tree.joint(link).columns().size();
  }
  return out;
}

// The given coordinates hold, before them the prescribed ones; the others follow from phi = 0.
std::vector<double> Starts::configuration(const Values& given_values, double t,
                                          const Places& places) const {
  Values values = prescribed(t);
  values.insert(given_values.begin(), given_values.end());
  const Tree& tree = system_->tree(system_->drawn().data());
  std::vector<double> g = tree.drawn(), coordinates(columns_.size());
  system_->geometry().coordinates(g.data(), coordinates.data());
  std::vector<bool> fixed(rates_.size(), false);
  Values stated;
  size_t column = 0;
  for (int link = 0; link < tree.links(); ++link) {
    for (const std::string& name : tree.joint(link).columns()) {
      (void)name;
      const auto given = values.find(columns_[column]);
      if (given != values.end()) {
        coordinates[column] = given->second;
        stated.insert(*given);
        for (int i = 0; i < tree.count(link); ++i)
          fixed[static_cast<size_t>(tree.first(link) + i)] = true;
      }
      ++column;
    }
  }
  try {
    system_->geometry().from_coordinates(coordinates, g.data());
  } catch (const std::invalid_argument& error) {
    refuse({}, stated, places, fmt::format(": {}", error.what()));
  }
  if (const double off = satisfy(*system_, fixed, g); !(off < 1e-12)) {
    const VectorXd phi = RowValues(*system_, g).phi;
    std::vector<int> open;
    for (int i = 0; i < phi.size(); ++i)
      if (!(std::abs(phi[i]) < 1e-9)) open.push_back(i);
    refuse(open, stated, places,
           fmt::format(" cannot be reached, {:.3g} m is left; leave out a coordinate: those that "
                       "are not given follow",
                       off));
  }
  system_->geometry().coordinates(g.data(), coordinates.data());
  return coordinates;
}

namespace {

// some + free z -> those of least angular velocity.
void keep_from_turning(const std::vector<int>& angular, VectorXd& some, MatrixXd& free) {
  MatrixXd turns(angular.size(), free.cols());
  VectorXd omega(angular.size());
  for (size_t i = 0; i < angular.size(); ++i) {
    turns.row(static_cast<Eigen::Index>(i)) = free.row(angular[i]);
    omega[static_cast<Eigen::Index>(i)] = some[angular[i]];
  }
  if (turns.norm() <= 1e-9 * free.norm()) return;
  some += free * least(turns, VectorXd(-omega));
  Eigen::FullPivLU<MatrixXd> decomposition(turns);
  decomposition.setThreshold(1e-9);
  free = (free * decomposition.compute(turns).kernel()).eval();
}

}  // namespace

// Least 1/2 xi^T I xi with A xi = b and the given velocities. At a speed in the drawn pose the root
// turns as little as these allow; where coordinates are given, a steering angle, keeping it from
// turning would spin the joints.
Start Starts::solve(const Values& values, double t, const Places& places) const {
  std::vector<std::string> wrong;
  for (const auto& [name, value] : values) {
    const auto place = places.find(name);
    for (const std::string& text : mistakes({name}))
      wrong.push_back((place == places.end() ? "" : place->second) + text);
  }
  if (!wrong.empty()) throw ConfigError(wrong);
  Start start;
  start.configuration = configuration(values, t, places);
  std::vector<double> g(system_->drawn().size());
  system_->geometry().from_coordinates(start.configuration, g.data());
  const int n = system_->dim(), k = system_->constraint_count();
  std::vector<std::pair<int, Values::value_type>> stated;
  for (const auto& entry : values) {
    if (const int i = rate(entry.first); i >= 0) stated.emplace_back(i, entry);
  }
  MatrixXd inertia(n, n), a = MatrixXd::Zero(k + static_cast<int>(stated.size()), n);
  VectorXd b = VectorXd::Zero(a.rows()), b_rows(k);
  MatrixXd a_rows(k, n);
  system_->inertia(g.data(), inertia);
  system_->constraints(t, g.data(), a_rows, b_rows);
  a.topRows(k) = a_rows;
  b.head(k) = b_rows;
  for (size_t i = 0; i < stated.size(); ++i) {
    const Eigen::Index row = k + static_cast<Eigen::Index>(i);
    a(row, stated[i].first) = 1;
    b[row] = stated[i].second.second;
  }
  VectorXd some = least(a, b);
  const VectorXd left = a * some - b;  // where rows contradict others
  if (const double size = 1e-9 * (1 + b.norm()); !(left.norm() <= size)) {
    std::vector<int> rows;
    Values against;
    for (int i = 0; i < left.size(); ++i) {
      if (std::abs(left[i]) <= 1e-3 * left.norm()) continue;
      if (i < k) rows.push_back(system_->kept()[static_cast<size_t>(i)]);
      else against.insert(stated[static_cast<size_t>(i - k)].second);
    }
    refuse(rows, against, places,
           " are inconsistent; leave out a velocity: those that are not given follow");
  }
  // some + N z, N a basis of what is free: least energy where N^T I (some + N z) = 0.
  MatrixXd free = dense::kernel(a);
  const bool as_drawn = std::ranges::none_of(
      values, [&](const auto& entry) { return std::ranges::count(columns_, entry.first) > 0; });
  if (as_drawn && values.contains("speed")) keep_from_turning(turning(), some, free);
  const MatrixXd reduced = free.transpose() * inertia * free;
  const VectorXd z = least(reduced, VectorXd(-(free.transpose() * (inertia * some))));
  const VectorXd velocity = some + free * z;
  start.velocity.assign(velocity.begin(), velocity.end());
  return start;
}

}  // namespace hamel::mechanisms
