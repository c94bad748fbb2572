// nonsmooth: lift, with impulses of contacts at the ends of its steps
// (run/run/contacts/nonsmooth_kernel.hpp has the equations). Where no contact may slide, open or
// strike it is lift.
#pragma once

#include <optional>
#include <string>

#include <hamel/framework/schemes/lift.hpp>

namespace hamel {

struct Nonsmooth : Lift {
  static std::string name() { return "nonsmooth"; }
  static std::string formula() {
    return "lift between impulses of contacts at both ends of a step";
  }
  static std::string source() {
    return "Breuling, Capobianco, Eugster, Leine 2024: nonsmooth RATTLE, changed";
  }
  static constexpr StepChoice step_choice = StepChoice::none;
};

}  // namespace hamel
