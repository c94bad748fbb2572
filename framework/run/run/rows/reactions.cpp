#include <hamel/framework/run/run/rows/reactions.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace hamel {
namespace {

// Compares bits: an element may hold integers.
bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<size_t>(a.size()) * sizeof(double)) == 0;
}

}  // namespace

void load_element(const Geometry& geometry, const Snapshot& state, Eigen::VectorXd& out) {
  if (state.element.empty()) geometry.from_coordinates(state.coordinates, out.data());
  else std::copy(state.element.begin(), state.element.end(), out.data());
}

Reactions::Reactions(std::shared_ptr<const Geometry> geometry,
                     std::shared_ptr<const Mechanics> mechanics,
                     std::shared_ptr<const Inputs> inputs, std::shared_ptr<RunContacts> contacts)
    : geometry_(std::move(geometry)),
      inputs_(std::move(inputs)),
      contacts_(std::move(contacts)),
      motion_(DynamicProblem(geometry_, mechanics)),
      time_(std::numeric_limits<double>::quiet_NaN()),
      g_(Eigen::VectorXd::Zero(geometry_->size())),
      xi_(Eigen::VectorXd::Zero(mechanics->dim())),
      other_(g_) {}

const Eigen::VectorXd& Reactions::at(const Snapshot& state) {
  load_element(*geometry_, state, other_);
  if (contacts_ != nullptr) {
    xi_ = Eigen::Map<const Eigen::VectorXd>(state.velocity.data(), xi_.size());
    return contacts_->reactions(state.time, other_.data(), xi_);
  }
  const Eigen::Map<const Eigen::VectorXd> xi(state.velocity.data(), xi_.size());
  const long changes = inputs_ != nullptr ? inputs_->changes() : 0;
  if (lambda_ != nullptr && state.time == time_ && changes == changes_ && xi == xi_ &&
      same_bits(other_, g_))
    return *lambda_;
  g_.swap(other_);
  xi_ = xi;
  time_ = state.time;
  changes_ = changes;
  lambda_ = nullptr;  // should the next line throw
  motion_.solve(time_, g_, xi_);
  lambda_ = &motion_.reaction();
  return *lambda_;
}

std::shared_ptr<Reactions> reactions_of(const std::shared_ptr<const Geometry>& geometry,
                                        const std::shared_ptr<const Mechanics>& mechanics,
                                        const std::shared_ptr<const Inputs>& inputs,
                                        const std::shared_ptr<RunContacts>& contacts) {
  if (geometry == nullptr || mechanics->constraint_count() == 0) return nullptr;
  return std::make_shared<Reactions>(geometry, mechanics, inputs, contacts);
}

}  // namespace hamel
