#include <hamel/framework/run/run/plan/start_contacts.hpp>

#include <vector>

#include <fmt/format.h>

#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {
namespace {

// Gaps up to this are closed, m (contact_kernel.cpp).
constexpr double kClosedStart = 1e-9;

// The gap of a contact at the values of the holonomic rows; 0 without a height.
double gap_of(const SystemModel& system, const ContactLaw& law, const Eigen::VectorXd& phi) {
  if (!law.normal) return 0;
  return phi[*law.normal - (system.mechanics->constraint_count() - phi.size())];
}

// Is a row a combination of those before it?
class IndependentRows {
 public:
  bool add(Eigen::VectorXd row) {
    const double length = row.norm();
    for (int pass = 1; pass <= 2; ++pass)
      for (const Eigen::VectorXd& e : basis_) row -= e.dot(row) * e;
    if (!(row.norm() > 1e-9 * length)) return false;
    basis_.push_back(row.normalized());
    return true;
  }

 private:
  std::vector<Eigen::VectorXd> basis_;
};

}  // namespace

bool look_at_gaps(const SystemModel& system, const Eigen::VectorXd& phi, Mistakes& mistakes) {
  bool open = false;
  for (const ContactLaw& law : system.contact_laws) {
    const double gap = gap_of(system, law, phi);
    open = open || gap > kClosedStart;
    if (gap >= -kClosedStart) continue;
    const char* const text =
        law.of_joint
            ? "configuration: '{}' of {} is passed by {:.6g}, expected at it or before"
            : "configuration: contact '{}' of {} is {:.6g} m below its ground, expected on "
              "it or above";
    mistakes.add(fmt::format(fmt::runtime(text), law.name, system.name, -gap));
  }
  return open;
}

void release_rows(const SystemModel& system, const Eigen::VectorXd& phi, bool slip,
                  PlannedStart& planned) {
  std::vector<bool> on(static_cast<size_t>(planned.constraints.rows()), true);
  for (const ContactLaw& law : system.contact_laws) {
    if (!slip && !law.of_joint && !(gap_of(system, law, phi) > kClosedStart)) continue;
    if (law.normal) on[static_cast<size_t>(*law.normal)] = false;
    for (const int row : law.tangential) on[static_cast<size_t>(row)] = false;
  }
  std::vector<bool> of_contact(on.size(), false);
  for (const ContactLaw& law : system.contact_laws) {
    if (law.normal) of_contact[static_cast<size_t>(*law.normal)] = true;
    for (const int row : law.tangential) of_contact[static_cast<size_t>(row)] = true;
  }
  IndependentRows rows;
  for (const bool slips : {false, true})
    for (size_t row = 0; row < on.size(); ++row) {
      if (!on[row] || of_contact[row] != slips) continue;
      const bool adds = rows.add(planned.constraints.row(static_cast<Eigen::Index>(row)));
      on[row] = adds || !slips;
    }
  Eigen::Index kept = 0;
  for (size_t row = 0; row < on.size(); ++row) {
    if (!on[row]) continue;
    planned.constraints.row(kept) = planned.constraints.row(static_cast<Eigen::Index>(row)).eval();
    planned.drift[kept++] = planned.drift[static_cast<Eigen::Index>(row)];
  }
  planned.constraints.conservativeResize(kept, Eigen::NoChange);
  planned.drift.conservativeResize(kept);
}

}  // namespace hamel
