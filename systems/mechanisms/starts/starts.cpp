#include <hamel/systems/mechanisms/starts/starts.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/systems/mechanisms/starts/poses.hpp>

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

// The velocity that "speed" is: ahead of the first planar or free root joint.
int Starts::ahead() const {
  const Tree& tree = system_->tree(system_->drawn().data());
  for (int link = 0; link < tree.links(); ++link) {
    if (tree.parent(link) != kGround || !tree.joint(link).turns_and_slides()) continue;
    return tree.first(link) + tree.joint(link).turning().back() + 1;
  }
  return -1;
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
    if (tree.link(link).is_time) out[columns_[column]] = t;
    column += tree.joint(link).columns().size();
  }
  return out;
}

// "a.angle = 0.3 would do; ", for each stated coordinate that could make up for the rest.
std::string Starts::would_do(const std::vector<Choice>& choices, const std::vector<double>& near,
                             const std::vector<bool>& fixed) const {
  std::string out;
  std::vector<double> coordinates(columns_.size());
  for (const Choice& choice : choices) {
    std::vector<double> g = near;
    std::vector<bool> others = fixed;
    others[static_cast<size_t>(choice.velocity)] = false;
    if (!(satisfy(*system_, others, g, choice.velocity) < 1e-12)) continue;
    system_->geometry().coordinates(g.data(), coordinates.data());
    out += fmt::format("{}{} = {:.6g}", out.empty() ? "" : " or ", columns_[choice.column],
                       coordinates[choice.column]);
  }
  return out.empty() ? out : out + " would do; ";
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
  std::vector<Choice> choices;
  size_t column = 0;
  for (int link = 0; link < tree.links(); ++link) {
    for (const std::string& name : tree.joint(link).columns()) {
      (void)name;
      const auto given = values.find(columns_[column]);
      if (given != values.end()) {
        coordinates[column] = given->second;
        stated.insert(*given);
        if (tree.count(link) == 1) choices.push_back({column, tree.first(link)});
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
  const std::vector<double> near = g;
  double off = satisfy(*system_, fixed, g, -1, true);
  if (!(off < 1e-12) && std::ranges::any_of(system_->row_info(), &RowInfo::slips)) {
    g = near;
    off = satisfy(*system_, fixed, g);
  }
  if (!(off < 1e-12)) {
    const VectorXd phi = RowValues(*system_, g).phi;
    std::vector<int> open;
    bool lengths = true;
    for (int i = 0; i < phi.size(); ++i) {
      if (std::abs(phi[i]) < 1e-9 || system_->row_info()[static_cast<size_t>(i)].slips) continue;
      open.push_back(i);
      lengths = lengths && system_->row_info()[static_cast<size_t>(i)].length;
    }
    refuse(open, stated, places,
           fmt::format(" cannot be reached, {:.3g}{} is left; {}leave out a coordinate: those that "
                       "are not given follow",
                       off, lengths ? " m" : "", would_do(choices, near, fixed)));
  }
  system_->geometry().coordinates(g.data(), coordinates.data());
  return coordinates;
}

// "steer.rate = 0.2, omega = 0.1": those of some velocities that were not given and are not 0.
std::string Starts::unasked(const std::vector<int>& some, const Values& values,
                            const StartVelocity& found, const VectorXd& xi) const {
  double most = 0;
  for (Eigen::Index i = 0; i < xi.size(); ++i)
    most = std::max(most, found.size(static_cast<int>(i), xi[i]));
  std::string out;
  for (const int i : some) {
    const std::string& name = rates_[static_cast<size_t>(i)];
    const bool given =
        std::ranges::any_of(values, [&](const auto& entry) { return rate(entry.first) == i; });
    const bool prescribed = std::ranges::any_of(system_->all_rows().prescribed,
                                                [&](const Prescribed& p) { return p.dof == i; });
    if (given || prescribed || !(found.size(i, xi[i]) > 1e-9 * most)) continue;
    out += fmt::format("{}{} = {:.6g}", out.empty() ? "" : ", ", name, xi[i]);
  }
  return out;
}

VectorXd Starts::Equations::solution() const { return least(a, b); }
bool Starts::Equations::solved() const {
  return (a * solution() - b).norm() <= 1e-9 * (1 + b.norm());
}

Starts::Equations Starts::equations(const std::vector<double>& g, double t,
                                    const std::vector<std::pair<int, Values::value_type>>& stated,
                                    const std::vector<int>& rows) const {
  const RowValues values(*system_, g, t);
  const auto k = static_cast<Eigen::Index>(rows.size()), more = std::ssize(stated);
  Equations out{MatrixXd::Zero(k + more, system_->dim()), VectorXd::Zero(k + more), rows};
  out.a.topRows(k) = values.a(rows, Eigen::all);
  out.b.head(k) = values.b(rows);
  for (Eigen::Index i = 0; i < more; ++i) {
    out.a(k + i, stated[static_cast<size_t>(i)].first) = 1;
    out.b[k + i] = stated[static_cast<size_t>(i)].second.second;
  }
  return out;
}

SystemStart Starts::solve(const Values& values, double t, const Places& places) const {
  std::vector<std::string> wrong;
  for (const auto& [name, value] : values) {
    const auto place = places.find(name);
    for (const std::string& text : mistakes({name}))
      wrong.push_back((place == places.end() ? "" : place->second) + text);
  }
  if (!wrong.empty()) throw ConfigError(wrong);
  SystemStart start;
  start.configuration = configuration(values, t, places);
  std::vector<double> g(system_->drawn().size());
  system_->geometry().from_coordinates(start.configuration, g.data());
  std::vector<std::pair<int, Values::value_type>> stated;
  for (const auto& entry : values) {
    if (const int i = rate(entry.first); i >= 0) stated.emplace_back(i, entry);
  }
  Equations equations = this->equations(g, t, stated, system_->holding());
  if (!equations.solved()) {  // rows contradict others
    const VectorXd left = equations.a * equations.solution() - equations.b;
    const auto k = static_cast<Eigen::Index>(equations.rows.size());
    std::vector<int> rows;
    Values against;
    for (int i = 0; i < left.size(); ++i) {
      if (std::abs(left[i]) <= 1e-3 * left.norm()) continue;
      if (i < k) rows.push_back(equations.rows[static_cast<size_t>(i)]);
      else against.insert(stated[static_cast<size_t>(i - k)].second);
    }
    refuse(rows, against, places,
           " are inconsistent; leave out a velocity: those that are not given follow");
  }
  const std::vector<std::string> slipping = add_slipping(g, t, stated, equations);
  const StartVelocity found(*system_, g);
  const VectorXd velocity = found(equations.a, equations.solution());
  start.velocity.assign(velocity.begin(), velocity.end());
  if (!slipping.empty())
    start.notes_of_projection.push_back(
        fmt::format("the start requires that {} slip{}: --slip starts so, without it they roll",
                    join(slipping), slipping.size() > 1 ? "" : "s"));
  if (const std::string joints = unasked(found.of_joints(), values, found, velocity);
      !joints.empty())
    start.notes.push_back(
        "joints whose rates are not given move at the start, as the rows require: " + joints);
  if (!values.contains("speed")) return start;
  if (const std::string root = unasked(found.of_turning_roots(), values, found, velocity);
      !root.empty())
    start.notes.push_back("the start is not straight ahead, its root turns: " + root);
  return start;
}

}  // namespace hamel::mechanisms
