#include <hamel/systems/mechanisms/tree.hpp>

#include <algorithm>

namespace hamel::mechanisms {
namespace {

bool same(const Inertia& a, const Inertia& b) {
  const double near = 1e-14 * a.second.lpNorm<Eigen::Infinity>();
  return (a.second - b.second).lpNorm<Eigen::Infinity>() <= near &&
         (a.first - b.first).squaredNorm() <= near * 1e-14 * a.mass;
}

}  // namespace

Tree::Tree(const std::vector<Link>& links) {
  nodes_.reserve(links.size());
  for (const Link& link : links) {
    Node node;
    const bool is_root = link.parent == kGround;
    node.link = link;
    node.root = is_root ? static_cast<int>(nodes_.size()) : at(link.parent).root;
    node.dof = dim_;
    node.element = size_;
    const Joint::Directions& s = link.joint->directions();
    node.columns.resize(6, s.cols());
    if (s.cols() > 0) node.axis = (is_root ? link.on_child : link.on_parent).move(s.col(0));
    node.after = link.on_child.inverse();
    node.inertia = link.inertia;
    dim_ += link.joint->dim();
    const std::vector<double> drawn =
        link.joint->element_of(link.on_parent.inverse() * link.on_child);
    size_ += static_cast<int>(drawn.size());
    drawn_.insert(drawn_.end(), drawn.begin(), drawn.end());
    nodes_.push_back(std::move(node));
  }
  find_rotors();
  place(drawn_.data());
}

void Tree::find_rotors() {
  for (Node& node : nodes_)
    node.rotor = node.link.joint->only_turns() && node.link.parent != kGround;
  for (const Node& node : nodes_)
    if (node.link.parent != kGround) at(node.link.parent).rotor = false;
  for (Node& node : nodes_) {
    if (!node.rotor) continue;
    const auto turned = [&](double angle) {
      const Geometry& geometry = *node.link.joint->geometry();
      std::vector<double> element(static_cast<size_t>(geometry.size()));
      geometry.tau(&angle, element.data());
      return moved(node.link.on_parent * node.link.joint->motion(element.data()) * node.after,
                   node.link.inertia);
    };
    const Inertia seen = turned(0);
    node.rotor = same(seen, turned(1)) && same(seen, turned(2.5));
    if (!node.rotor) continue;
    at(node.link.parent).inertia += seen;
    node.moment = (seen * node.axis).dot(node.axis);
  }
}

void Tree::place(const double* g) {
  const auto size = static_cast<size_t>(size_);
  if (placed_.size() == size && std::equal(g, g + size, placed_.begin())) return;
  placed_.assign(g, g + size);
  for (Node& node : nodes_) {
    const Link& link = node.link;
    const Rigid across = link.on_parent * link.joint->motion(g + node.element) * node.after;
    if (link.parent == kGround) node.world = across;
    else node.place = at(link.parent).place * across;
    const Joint::Directions& s = link.joint->directions();
    for (int i = 0; i < s.cols(); ++i)
      node.columns.col(i) = node.place.move(link.on_child.move(s.col(i)));
  }
}

}  // namespace hamel::mechanisms
