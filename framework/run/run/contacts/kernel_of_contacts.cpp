#include <hamel/framework/run/run/contacts/kernel_of_contacts.hpp>

#include <hamel/framework/io/errors.hpp>

namespace hamel {

void KernelOfContacts::restart(double t, std::span<const double> coordinates,
                               std::span<const double> velocity, double step) {
  time_ = t;
  coordinates_.assign(coordinates.begin(), coordinates.end());
  velocity_.assign(velocity.begin(), velocity.end());
  setup_.step = step;
  limit_ = std::copysign(std::numeric_limits<double>::infinity(), step);
  contacts_->set_known(false);
  begin();
}

void KernelOfContacts::evaluate_start() {
  setup_.geometry->from_coordinates(coordinates_, g_.data());
  xi_ = Eigen::Map<const Eigen::VectorXd>(velocity_.data(), std::ssize(velocity_));
  dynamics().evaluate(time_, g_.data(), xi_);
}

void KernelOfContacts::turn_back() {
  throw ConfigError(
      {"turn_back: a motion with friction or impacts is not determined backwards in time"});
}

}  // namespace hamel
