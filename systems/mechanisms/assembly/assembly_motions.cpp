// Assembly: parts that no inertia or nothing at all lets move, and what stands still or bears
// nothing.
#include <algorithm>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/assembly/assembly.hpp>

#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/systems/mechanisms/starts/mobility.hpp>

namespace hamel {

using namespace mechanisms;

// Massless bodies in the middle of a chain, axes that coincide: a motion that the rows admit and no
// inertia resists.
void Assembly::check_motions(const Multibody& system, const std::vector<RowLabel>& rows) {
  std::vector<double> g(system.drawn().size());
  system.geometry().from_coordinates(model_.start.configuration, g.data());
  const std::vector<int> holding = system.holding();
  const int n = system.dim(), k = static_cast<int>(holding.size());
  Eigen::MatrixXd inertia(n, n), free = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd a = RowValues(system, g).a(holding, Eigen::all);
  system.inertia(g.data(), inertia);
  // Each velocity in units of its inertia: that of a needle on a ship is not none.
  const Eigen::VectorXd unit = velocity_units(inertia);
  if (k > 0) {
    a = a * unit.asDiagonal();
    a.rowwise().normalize();
    free = dense::kernel(a);
  }
  if (free.isZero(0)) {
    if (mobility_at(system, g).any && model_.contact_laws.empty())
      return;  // what is prescribed decides the motion alone
    const RowLabel& last = rows[static_cast<size_t>(holding.back())];
    std::vector<std::string> others;
    for (const int i : holding) {
      const std::string& what = rows[static_cast<size_t>(i)].what;
      if (what != last.what && std::ranges::count(others, what) == 0) others.push_back(what);
    }
    mistakes_.push_back(fmt::format(
        "{}{}: the parts leave no motion, {} independent rows in dimension {}{}", last.where,
        last.what, k, n, others.empty() ? "" : ", with those of " + join(others)));
    return;
  }
  free = dense::qr(free).q.leftCols(free.cols()).eval();
  const dense::SymmetricEigen energies = dense::symmetric_eigen(
      free.transpose() * unit.asDiagonal() * inertia * unit.asDiagonal() * free);
  if (energies.values[0] > 1e-14 * energies.values.maxCoeff()) return;
  const Eigen::VectorXd idle = free * energies.vectors.col(0);
  std::string list;
  const Part* last = nullptr;
  const Tree& tree = system.tree(g.data());
  for (int link = 0; link < tree.links(); ++link) {
    const auto own = idle.segment(tree.first(link), tree.count(link));
    if (own.norm() <= 1e-6 * idle.norm()) continue;
    const auto j = static_cast<size_t>(link);
    list += fmt::format("{}'{}'", list.empty() ? "" : ", ", link_names_[j]);
    last = link_joints_[j];
  }
  wrong(*last, "joint",
        fmt::format("{} can move so that nothing that has inertia moves: give the bodies between "
                    "them masses, or let no axes coincide",
                    list));
}

void Assembly::note_what_stands(const Multibody& system, const Redundancy& redundancy) {
  const ConstraintRows& rows = system.all_rows();
  std::vector<double> g(system.drawn().size());
  system.geometry().from_coordinates(model_.start.configuration, g.data());
  const auto names = [&](auto&& which) {
    std::string out;
    for (size_t i = 0; i < rows.contacts.size(); ++i)
      if (which(i))
        out += fmt::format("{}{} '{}'", out.empty() ? "" : ", ", parts_.contacts_[i].kind,
                           rows.contacts[i].name);
    return out;
  };
  const std::vector<size_t> still = wheels_that_cannot_roll(system);
  const std::string stuck = names([&](size_t i) { return std::ranges::count(still, i) > 0; });
  if (!stuck.empty())
    model_.notes.push_back(
        fmt::format("{}: cannot roll, since no joint turns about the axle", stuck));

  const std::string all = names([](size_t) { return true; });
  const std::string slipping = names([&](size_t i) { return rows.contacts[i].slips; });
  const bool slips = !slipping.empty();  // a joint with friction is no contact
  const Mobility mobility = mobility_at(system, g), sticks = mobility_at(system, g, true);
  const int root = vehicle_root(system.tree(g.data()));
  if (!mobility.root)
    model_.notes.push_back(fmt::format("joint '{}' cannot move: {} and what is prescribed hold it",
                                       link_names_[static_cast<size_t>(root)], all));
  else if (slips && !sticks.root && mobility.root)
    model_.notes.push_back(fmt::format("joint '{}' moves only by slipping of {}",
                                       link_names_[static_cast<size_t>(root)], slipping));
  else if (slips && !sticks.turns && mobility.turns)
    model_.notes.push_back(fmt::format("joint '{}' turns only by slipping of {}",
                                       link_names_[static_cast<size_t>(root)], slipping));
  else if (!mobility.turns && !rows.contacts.empty())
    model_.notes.push_back(fmt::format(
        "joint '{}' cannot turn: {} allow straight motion only; a vehicle that turns by "
        "skidding slips, which contacts without `friction` exclude",
        link_names_[static_cast<size_t>(root)], all));

  // The height of a dropped row is kept by the other supports, and its multiplier is theirs.
  const std::vector<RowInfo>& words = system.row_info();
  std::vector<std::string> unloaded;
  for (const auto& [row, repeat] : redundancy.repeats) {
    const RowInfo& word = words[static_cast<size_t>(row)];
    if (word.height && !repeat.others.empty()) unloaded.push_back(word.part);
  }
  const std::string idle =
      names([&](size_t i) { return std::ranges::count(unloaded, rows.contacts[i].name) > 0; });
  if (!idle.empty())
    model_.notes.push_back(fmt::format(
        "{}: carries no load, since the other supports hold its height; it rolls all the same",
        idle));
}

}  // namespace hamel
