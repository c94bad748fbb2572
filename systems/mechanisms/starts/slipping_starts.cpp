// Which contacts that may slide roll at a start.
#include <algorithm>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hamel/systems/mechanisms/starts/poses.hpp>
#include <hamel/systems/mechanisms/starts/start_velocity.hpp>
#include <hamel/systems/mechanisms/starts/starts.hpp>

namespace hamel::mechanisms {

using Eigen::VectorXd;

// Velocities of links that carry this contact and no other one: a wheel's, a ball's. All of them
// where it is no contact but a joint with friction.
std::vector<bool> Starts::own_velocities(const std::string& part) const {
  const Tree& tree = system_->tree(system_->drawn().data());
  const auto carries = [&tree](int link, int at) {
    while (at != kGround && at != link) at = tree.parent(at);
    return at == link;
  };
  std::vector<int> touching;  // links, once for each contact
  int own = kGround;
  for (const Contact& contact : system_->all_rows().contacts) {
    touching.push_back(contact.link);
    if (contact.name == part) own = contact.link;
  }
  for (const Loop& loop : system_->all_rows().loops) {
    if (!loop.surface) continue;
    touching.push_back(loop.b);
    touching.push_back(loop.a);
    if (loop.name == part) own = loop.b;
  }
  std::vector<bool> out(static_cast<size_t>(system_->dim()), own == kGround);
  for (int link = own; link != kGround; link = tree.parent(link)) {
    if (std::ranges::count_if(touching, [&](int at) { return carries(link, at); }) > 1) break;
    for (int i = 0; i < tree.count(link); ++i)
      out[static_cast<size_t>(tree.first(link) + i)] = true;
  }
  return out;
}

// The rows of each part that may slide or open and is closed.
std::vector<Starts::SlippingPart> Starts::closed_parts(const VectorXd& phi) const {
  const std::vector<RowInfo>& words = system_->row_info();
  std::vector<SlippingPart> parts;
  for (const int row : system_->kept()) {
    const RowInfo& word = words[static_cast<size_t>(row)];
    if (!word.slips || (word.holonomic && !word.height)) continue;  // stops and walls only push
    const auto part = std::ranges::find(parts, word.part, &SlippingPart::name);
    if (part != parts.end()) part->rows.push_back(row);
    else parts.push_back({word.part, {row}});
  }
  std::erase_if(parts, [&](const SlippingPart& part) {  // those that are open
    return std::ranges::any_of(system_->kept(), [&](int row) {
      return words[static_cast<size_t>(row)].part == part.name && phi[row] > 1e-9;
    });
  });
  return parts;
}

// Rows of a part, one after the other, that move nothing but its own velocities from `now`. Are
// there others?
bool Starts::add_own_rows(const SlippingPart& part, const StartVelocity& velocity,
                          const std::function<Equations(std::span<const int>)>& with, Equations& to,
                          VectorXd& now) const {
  const std::vector<bool> own = own_velocities(part.name);
  const auto moves_others = [&](const VectorXd& then) {
    double largest = 0;
    for (int i = 0; i < system_->dim(); ++i) largest = std::max(largest, velocity.size(i, then[i]));
    for (int i = 0; i < system_->dim(); ++i)
      if (!own[static_cast<size_t>(i)] && velocity.size(i, then[i] - now[i]) > 1e-9 * largest)
        return true;
    return false;
  };
  bool slips = false;
  // A ball on a body slips in directions that mean nothing: its rows hold together, or none.
  const bool at_once = std::ranges::any_of(
      system_->all_rows().loops, [&](const Loop& loop) { return loop.name == part.name; });
  const size_t size = at_once ? part.rows.size() : 1;
  for (size_t i = 0; i < part.rows.size(); i += size) {
    Equations more = with(std::span(part.rows).subspan(i, size));
    VectorXd then;
    if (more.solved()) then = velocity(more.a, more.solution());
    if (then.size() == 0 || moves_others(then)) {
      slips = true;
      continue;
    }
    to = std::move(more);
    now = then;
  }
  return slips;
}

std::vector<std::string> Starts::add_slipping(
    const std::vector<double>& g, double t,
    const std::vector<std::pair<int, Values::value_type>>& stated, Equations& to) const {
  const std::vector<RowInfo>& words = system_->row_info();
  const std::vector<SlippingPart> parts = closed_parts(RowValues(*system_, g, t).phi);
  std::vector<int> all = to.rows;
  for (const SlippingPart& part : parts) all.insert(all.end(), part.rows.begin(), part.rows.end());
  if (all.size() == to.rows.size()) return {};
  std::vector<std::string> out;
  if (Equations every = equations(g, t, stated, all); every.solved()) {
    to = std::move(every);
    return out;
  }
  // Contacts that slip stay on the ground, all of them, before one of them rolls.
  std::vector<int> grounded = to.rows;
  for (const int row : all)
    if (std::ranges::count(grounded, row) == 0 && words[static_cast<size_t>(row)].height)
      grounded.push_back(row);
  if (Equations closed = equations(g, t, stated, grounded); closed.solved()) to = std::move(closed);
  // Not all of them can roll. What several contacts carry does not move for one of them, which
  // would be that of an order; a wheel turns as it rolls ahead, though it slips across.
  const StartVelocity velocity(*system_, g);
  const auto with = [&](std::span<const int> rows) {
    std::vector<int> more = to.rows;
    for (const int row : rows)
      if (std::ranges::count(more, row) == 0) more.push_back(row);
    return equations(g, t, stated, more);
  };
  VectorXd now = velocity(to.a, to.solution());
  for (const SlippingPart& part : parts)
    if (add_own_rows(part, velocity, with, to, now) &&
        words[static_cast<size_t>(part.rows.front())].length)
      out.push_back("'" + part.name + "'");
  return out;
}

}  // namespace hamel::mechanisms
