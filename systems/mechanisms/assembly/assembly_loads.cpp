// Assembly: loads of contacts that statics determines, and how several share them.
//
// Loads of contacts without a height, as on a planar root, are those of statics in the drawn pose,
// with c the mass centre of all that the root carries, W = m g its weight, and N_i at (x_i, y_i):
//   sum N_i = -W_z,   sum y_i N_i = -(c x W)_x,   sum x_i N_i = (c x W)_y;
// friction at z = 0 has no moment about the horizontal axes. Where these leave the loads of more
// than three contacts open, they are those of the least sum of squares: supports of equal
// compliance.
#include <algorithm>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/assembly/assembly.hpp>
#include <hamel/systems/mechanisms/starts/mobility.hpp>

namespace hamel {

using namespace mechanisms;

namespace {

int root_of(const Tree& tree, int link) {
  while (tree.parent(link) != kGround) link = tree.parent(link);
  return link;
}

}  // namespace

void Assembly::check_distribution() {
  const Part& policy = parts_.distribution_;
  const std::vector<std::string> known = {"equal_compliance", "refuse", "stated"};
  if (std::ranges::count(known, policy.name) == 0)
    mistakes_.push_back(policy.where + unknown_name("distribution", policy.name, known));
}

void Assembly::check_share(const Part& part, const std::string& kind,
                           const ContactOptions& options) {
  const bool stated = parts_.distribution_.name == "stated";
  if (options.share && !stated)
    wrong(part, kind, "share: expected distribution = \"stated\" beside it");
  if (stated && options.friction && !(options.share && *options.share > 0))
    wrong(part, kind,
          "share: distribution is \"stated\": expected a positive number, its part of the loads "
          "that are not determined");
}

// Loads of the contacts without a height on what a root carries.
void Assembly::find_loads(const Multibody& system, int root, std::vector<double>& loads) {
  const Tree& tree = system.tree(system.drawn().data());
  const std::vector<Contact>& contacts = system.all_rows().contacts;
  double mass = 0;
  Vec3 first = Vec3::Zero();
  for (int link = 0; link < tree.links(); ++link) {
    if (root_of(tree, link) != root) continue;
    mass += links_[static_cast<size_t>(link)].inertia.mass;
    first += links_[static_cast<size_t>(link)].inertia.first;
  }
  const Vec3 g = vec(parts_.gravity_), moment = first.cross(g);
  Vec3 right(-mass * g[2], -moment[0], moment[1]);
  std::vector<size_t> open;
  bool wanted = false;
  for (size_t i = 0; i < contacts.size(); ++i) {
    if (root_of(tree, contacts[i].link) != root) continue;
    const Vec3 at = system.all_rows().touch(contacts[i], tree);
    if (parts_.contacts_[i].load) {
      loads[i] = *parts_.contacts_[i].load;
      right -= loads[i] * Vec3(1, at[1], at[0]);
      continue;
    }
    open.push_back(i);
    wanted = wanted || contacts[i].slips;
  }
  if (!wanted) return;
  Eigen::MatrixXd a(3, static_cast<Eigen::Index>(open.size()));
  for (size_t k = 0; k < open.size(); ++k) {
    const Vec3 at = system.all_rows().touch(contacts[open[k]], tree);
    a.col(static_cast<Eigen::Index>(k)) = Vec3(1, at[1], at[0]);
  }
  if (open.size() > 3 && parts_.distribution_.name == "refuse") {
    const Mechanism::ContactPart& part = parts_.contacts_[open.front()];
    wrong(part, part.kind,
          fmt::format("load: {} contacts share the weight, statics determines three, and "
                      "distribution is \"refuse\"; give the loads of the others",
                      open.size()));
    return;
  }
  const Eigen::VectorXd shares = shares_of(open);
  Eigen::VectorXd found = least(a * shares.cwiseSqrt().asDiagonal(), right);
  found.array() *= shares.array().sqrt();
  const Mechanism::ContactPart& part = parts_.contacts_[open.front()];
  if (!((a * found - right).norm() <= 1e-9 * (1 + right.norm()))) {
    wrong(part, part.kind,
          fmt::format("load: the contacts do not balance the weight, {:.6g} N at ({:.6g}, {:.6g}) "
                      "m; give the loads, or add the support that is missing",
                      -mass * g[2], first[0] / mass, first[1] / mass));
    return;
  }
  std::string list;
  for (size_t k = 0; k < open.size(); ++k) {
    const double load = found[static_cast<Eigen::Index>(k)];
    const Mechanism::ContactPart& of = parts_.contacts_[open[k]];
    if (load < -1e-9 * right.norm())
      wrong(of, of.kind,
            fmt::format("load: {:.6g} N by statics in the drawn pose: it would tip; give the loads",
                        load));
    loads[open[k]] = std::max(load, 0.0);
    if (contacts[open[k]].slips)
      list += fmt::format("{}{} '{}' {:.6g} N", list.empty() ? "" : ", ", of.kind, of.name, load);
  }
  const bool stated = parts_.distribution_.name == "stated";
  model_.notes.push_back(fmt::format("loads of statics in the drawn pose{}: {}",
                                     open.size() <= 3 ? ""
                                     : stated         ? ", as the shares have it"
                                                      : ", of least sum of squares",
                                     list));
}

// sum N^2/share is least.
Eigen::VectorXd Assembly::shares_of(const std::vector<size_t>& contacts) const {
  Eigen::VectorXd out = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(contacts.size()));
  for (size_t k = 0; k < contacts.size(); ++k)
    out[static_cast<Eigen::Index>(k)] = parts_.contacts_[contacts[k]].share.value_or(1);
  return out;
}

std::vector<double> Assembly::loads(const Multibody& system) {
  const Tree& tree = system.tree(system.drawn().data());
  const std::vector<RowInfo>& words = system.row_info();
  std::vector<double> out(parts_.contacts_.size(), 0);
  std::vector<int> roots;
  size_t row = 0;
  for (size_t i = 0; i < parts_.contacts_.size(); ++i) {
    const Mechanism::ContactPart& part = parts_.contacts_[i];
    const Contact& contact = system.all_rows().contacts[i];
    row += contact.row_count();
    if (!contact.slips) continue;
    const int height = static_cast<int>(row) - 1;
    const bool changes =
        std::ranges::count(system.kept(), height) > 0 && words[static_cast<size_t>(height)].height;
    if (changes && part.load)
      wrong(part, part.kind,
            "load: the height of this contact may change, so that its load is a reaction; leave it "
            "out");
    if (changes && part.unilateral && !*part.unilateral)
      wrong(part, part.kind, "unilateral: a contact with friction may open; leave friction out");
    if (!changes && part.unilateral && *part.unilateral)
      wrong(part, part.kind,
            "unilateral: no joint changes the height of this contact, so that it cannot open");
    if (changes) continue;
    if (part.restitution || part.tangential_restitution)
      wrong(part, part.kind,
            "restitution: no joint changes the height of this contact, so that it cannot strike");
    const int root = root_of(tree, contact.link);
    if (part.load) out[i] = *part.load;
    else if (!tree.joint(root).turns_and_slides())
      wrong(part, part.kind,
            "load: not given, and its joints, not the ground, may bear the weight; give it in N");
    else if (std::ranges::count(roots, root) == 0) roots.push_back(root);
  }
  for (const int root : roots) find_loads(system, root, out);
  return out;
}

}  // namespace hamel
