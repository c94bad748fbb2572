#include <hamel/framework/run/run/contacts/run_contacts.hpp>

#include <utility>

namespace hamel {
namespace {

// The energy changes by what friction does, beside the forces of the system.
class WithFriction final : public Mechanics {
 public:
  WithFriction(std::shared_ptr<const Mechanics> system, std::shared_ptr<RunContacts> contacts)
      : system_(std::move(system)), contacts_(std::move(contacts)) {}
  int dim() const override { return system_->dim(); }
  int constraint_count() const override { return system_->constraint_count(); }
  int holonomic_rows() const override { return system_->holonomic_rows(); }
  bool has_force() const override { return true; }
  bool has_drift() const override { return system_->has_drift(); }
  void inertia(const double* g, Matrix out) const override { system_->inertia(g, out); }
  void constraints(double t, const double* g, Matrix a, Vector b) const override {
    system_->constraints(t, g, a, b);
  }
  double power(double t, const double* g, ConstVector xi) const override {
    const double forces = system_->has_force() ? system_->power(t, g, xi) : 0;
    if (!contacts_->any_slides()) return forces;
    contacts_->reactions(t, g, xi);
    return forces + contacts_->reaction_power();
  }

 private:
  std::shared_ptr<const Mechanics> system_;
  std::shared_ptr<RunContacts> contacts_;
};

const char* verb(const ContactLaw& law, ContactMode mode) {
  switch (mode) {
    case ContactMode::open: return "opens";
    case ContactMode::rolls: return law.rolls_name();
    case ContactMode::slides: return law.slides_name();
  }
  return "";
}

}  // namespace

RunContacts::RunContacts(std::shared_ptr<const Geometry> geometry, const SystemModel& system)
    : system_(std::make_shared<SystemModel>(system)),
      dynamics_(std::make_shared<ContactDynamics>(geometry, system.mechanics, system.contact_laws)),
      measured_(std::make_shared<ContactDynamics>(geometry, system.mechanics, system.contact_laws)),
      states_(std::make_shared<ContactStates>(system.contact_laws.size())),
      before_(*states_),
      followed_(system.contact_laws.size()) {}

void RunContacts::begin_anew() {
  known_ = looks_back_ = false;
  switches.clear();
  notes.clear();
  window = 0;
  met = 0;
}

void RunContacts::name_changes(const ContactStates& before, double t,
                               std::vector<std::pair<std::string, double>>& events) const {
  for (size_t i = 0; i < before.size(); ++i) {
    const ContactLaw& law = dynamics_->law(static_cast<int>(i));
    const ContactMode mode = (*states_)[i].mode;
    if (mode == before[i].mode) continue;
    if (mode != ContactMode::open && law.tangential.empty()) continue;
    events.emplace_back(law.name + "." + verb(law, mode), t);
  }
}

std::vector<double> RunContacts::mode_numbers() const {
  std::vector<double> out;
  for (const ContactState& state : looked_at()) out.push_back(static_cast<double>(state.mode));
  return out;
}

const Eigen::VectorXd& RunContacts::reactions(double t, const double* g,
                                              const Eigen::VectorXd& xi) {
  measured_->evaluate(t, g, xi);
  measured_->accelerate(looked_at());
  return measured_->reactions();
}

std::shared_ptr<const Mechanics> RunContacts::in_modes() const {
  return std::make_shared<ModeMechanics>(measured_, states_);
}

std::shared_ptr<const Mechanics> RunContacts::balanced(
    const std::shared_ptr<RunContacts>& self) const {
  return std::make_shared<WithFriction>(system_->mechanics, self);
}

}  // namespace hamel
