#include <hamel/systems/mechanisms/rows.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <hamel/framework/lie/differences.hpp>

namespace hamel::mechanisms {
namespace {

// The derivative of a function that comes without one.
double by_differences(const std::function<double(double)>& rate, double t) {
  std::array<Vec<1>, 2> work;
  Vec<1> out = Vec<1>::Zero();
  differentiate_in_time(
      t, [&](double at) { return Vec<1>(rate(at)); }, work, out);
  return out[0];
}

// Adds the rows of a loop: add(part, number, meaning, holonomic, height).
template <class Add>
void add_loop_info(const Loop& loop, const Add& add, std::vector<RowInfo>& out) {
  if (loop.surface) {
    for (const int i : {1, 2}) add(loop.name, i, "rolls without slipping", false, false);
    add(loop.name, 3, "touches the other body", true, true);
    for (size_t i = 1; i <= 3; ++i) out[out.size() - i].slips = loop.slips;
    return;
  }
  for (int i = 1; i <= 3; ++i) add(loop.name, i, "the points of the joint coincide", true, false);
  for (int i = 4; i <= 5 && loop.is_hinge(); ++i)
    add(loop.name, i, "the axes of the joint coincide", true, false);
}

}  // namespace

std::vector<RowInfo> ConstraintRows::info() const {
  std::vector<RowInfo> out;
  const auto add = [&](const std::string& part, int number, std::string meaning, bool holonomic,
                       bool height = false) {
    out.push_back(
        {part, part + ".reaction" + std::to_string(number), std::move(meaning), holonomic, height});
  };
  for (const Contact& contact : contacts) {
    int number = 0;
    for (const std::string& meaning : contact.model->meanings())
      add(contact.name, ++number, meaning, false);
    add(contact.name, ++number, "touches the ground", true, true);
    for (int i = 1; i <= number; ++i)
      out[out.size() - static_cast<size_t>(i)].slips = contact.slips;
  }
  for (const Loop& loop : loops) add_loop_info(loop, add, out);
  for (const Coupling& coupling : couplings) {
    const char* const rates = coupling.slips    ? "sticks"
                              : coupling.affine ? "is the rate of a state"
                                                : "couples rates";
    const char* const joints = coupling.slips ? "stops" : "couples joints";
    const auto same = [&](const RowInfo& row) { return row.part == coupling.name; };
    add(coupling.name, 1 + static_cast<int>(std::ranges::count_if(out, same)),
        coupling.of_rates() ? rates : joints, !coupling.of_rates());
    out.back().length = false;
    out.back().slips = coupling.slips;
  }
  for (size_t i = 0; i < agreements.size(); ++i) {
    add(std::string(kAgreement), 1 + static_cast<int>(i), "the axles of wheels meet in one point",
        true);
    out.back().length = false;
  }
  for (const Prescribed& p : prescribed) {  // whose name may be that of a contact, too
    const auto same = [&](const RowInfo& row) { return row.part == p.name; };
    add(p.name, 1 + static_cast<int>(std::ranges::count_if(out, same)), "moves as prescribed",
        p.held >= 0);
  }
  return out;
}

void ConstraintRows::find_links(const Tree& tree) {
  for (const Coupling& coupling : couplings)
    for (const size_t i : coupling.formula.used())
      if (i < coupling.links.size() && std::ranges::count(coupled_links, coupling.links[i]) == 0)
        coupled_links.push_back(coupling.links[i]);
  for (Contact& contact : contacts) {
    contact.carrier = contact.link;
    if (!tree.rotor(contact.link)) continue;
    const Twist axis = tree.axis(contact.link);
    const double near = 1e-14 * (1 + contact.at.norm());
    const std::vector<Vec3> axes = contact.model->axes();
    const bool turns_about_itself = velocity_at(axis, contact.at).norm() <= near &&
                                    std::ranges::all_of(axes, [&](const Vec3& e) {
                                      return upper(axis).cross(e).norm() <= near;
                                    });
    if (turns_about_itself) contact.carrier = tree.parent(contact.link);
  }
}

double ConstraintRows::beyond(const Prescribed& p, const Joint& joint, const double* element) {
  const double apart = joint.coordinate(element) - p.angle(0);
  return joint.only_turns() ? std::remainder(apart, 2 * std::numbers::pi) : apart;
}

double ConstraintRows::slope(const Prescribed& p, double t) {
  return p.slope ? p.slope(t) : by_differences(p.rate, t);
}

}  // namespace hamel::mechanisms
