#include <hamel/systems/mechanisms/tree.hpp>

#include <hamel/groups/so2.hpp>

namespace hamel::mechanisms {
namespace {

// The element with this motion in the joint's frame: of a joint that is drawn at rest the identity, of one against
// the ground's own frame the place of the body.
std::vector<double> element_of(JointKind kind, const Rigid& x) {
  const JointType& type = type_of(kind);
  std::vector<double> values = type.group.identity;
  if (kind == JointKind::free) {
    for (int i = 0; i < 9; ++i) values[static_cast<size_t>(i)] = x.rotation(i / 3, i % 3);
    for (int i = 0; i < 3; ++i) values[static_cast<size_t>(9 + i)] = x.position[i];
  } else if (kind == JointKind::planar) {
    values = {0, x.position[0], x.position[1]};
  }
  std::vector<double> element(static_cast<size_t>(type.geometry->size()));
  type.geometry->from_coordinates(values, element.data());
  return element;
}

}  // namespace

Tree::Tree(const std::vector<Link>& links) : links_(links), momenta_(links.size()) {
  for (const Link& link : links) {
    Node node;
    const int j = static_cast<int>(nodes_.size());
    node.link = link;
    node.root = link.parent == kGround ? j : at(link.parent).root;
    node.dof = dim_;
    node.element = size_;
    const auto s = hamel::mechanisms::directions(link.kind);
    node.directions.resize(6, s.cols());
    for (Eigen::Index i = 0; i < s.cols(); ++i)
      node.directions.col(i) = link.on_child.move(s.col(i));
    node.columns = node.directions;
    node.after = link.on_child.inverse();
    if (link.kind == JointKind::hinge) {
      const Mat<3, 3>& p = link.on_parent.rotation;
      const Mat<3, 3> along = p.col(2) * Vec3::UnitZ().transpose(), even = p - along,
                      odd = p.col(1) * Vec3::UnitX().transpose() -
                            p.col(0) * Vec3::UnitY().transpose();
      const auto term = [&](const Mat<3, 3>& part) {
        return Rigid{part * node.after.rotation, part * node.after.position};
      };
      node.turning = {term(along), term(even), term(odd)};
      node.turning[0].position += link.on_parent.position;
    }
    dim_ += static_cast<int>(s.cols());
    size_ += type_of(link.kind).geometry->size();
    const auto drawn = element_of(link.kind, link.on_parent.inverse() * link.on_child);
    drawn_.insert(drawn_.end(), drawn.begin(), drawn.end());
    nodes_.push_back(std::move(node));
  }
  place(drawn_.data());
  carry();
}

Rigid Tree::Node::across(const double* g) const {
  if (link.kind != JointKind::hinge) return link.on_parent * motion(link.kind, g) * after;
  const auto turn = Packing<SO2>::load(g);
  return {turning[0].rotation + turn.c * turning[1].rotation + turn.s * turning[2].rotation,
          turning[0].position + turn.c * turning[1].position + turn.s * turning[2].position};
}

HAMEL_FLATTEN void Tree::place(const double* g) {
  carries_ = false;
  for (Node& node : nodes_) {
    const Rigid across = node.across(g + node.element);
    if (node.link.parent == kGround) {
      node.world = across;
      continue;
    }
    node.place = at(node.link.parent).place * across;
    for (Eigen::Index i = 0; i < node.columns.cols(); ++i) {
      node.columns.col(i) = node.place.move(node.directions.col(i));
    }
  }
}

HAMEL_FLATTEN void Tree::carry() {
  if (carries_) return;
  carries_ = true;
  for (Node& node : nodes_) {
    const bool root = node.link.parent == kGround;
    node.carried = node.own = root ? node.link.inertia : moved(node.place, node.link.inertia);
  }
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) {
    if (node->link.parent != kGround) at(node->link.parent).carried += node->carried;
  }
}

HAMEL_FLATTEN void Tree::move(Eigen::Ref<const Eigen::VectorXd> xi) {
  for (Node& node : nodes_) {
    node.twist.setZero();
    if (node.link.parent != kGround) node.twist = at(node.link.parent).twist;
    for (Eigen::Index i = 0; i < node.columns.cols(); ++i) {
      node.twist += xi[node.dof + i] * node.columns.col(i);
    }
  }
}

HAMEL_FLATTEN void Tree::inertia(Eigen::Ref<Eigen::MatrixXd> out) const {
  out.setZero();
  for (const Node& node : nodes_) {
    for (Eigen::Index b = 0; b < node.columns.cols(); ++b) {
      const Wrench momentum = node.carried * node.columns.col(b);
      const Eigen::Index column = node.dof + b;
      for (const Node* on_the_way = &node;;) {
        for (Eigen::Index a = 0; a < on_the_way->columns.cols(); ++a) {
          const Eigen::Index row = on_the_way->dof + a;
          out(row, column) = out(column, row) = on_the_way->columns.col(a).dot(momentum);
        }
        if (on_the_way->link.parent == kGround) break;
        on_the_way = &at(on_the_way->link.parent);
      }
    }
  }
}

HAMEL_FLATTEN void Tree::add_inertial_force(Eigen::Ref<Eigen::VectorXd> out) const {
  for (size_t j = 0; j < nodes_.size(); ++j) momenta_[j] = nodes_[j].own * nodes_[j].twist;
  for (size_t j = nodes_.size(); j-- > 0;) {
    const Node& node = nodes_[j];
    if (node.link.parent == kGround) continue;  // its own velocity is left-trivialised
    const Wrench force = ad_transpose(at(node.link.parent).twist, momenta_[j]);
    for (Eigen::Index i = 0; i < node.columns.cols(); ++i) {
      out[node.dof + i] += node.columns.col(i).dot(force);
    }
    momenta_[static_cast<size_t>(node.link.parent)] += momenta_[j];
  }
}

}  // namespace hamel::mechanisms
