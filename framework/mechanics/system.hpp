// A system: its physics, and its erasure to the data that a run needs.
//
// A system is any struct with
//   using Group = ...;                 the configuration group, of dimension n
//   auto inertia() const;              n x n symmetric positive definite, l(xi) = 1/2 xi^T I xi
//   auto constraints() const;          k x n rows A of full rank, A xi = 0 (k = 0: leave it out)
// (inertia(g), constraints(g), holonomic(g), potential(g), ... for those that are not
// left-invariant: general_system.hpp) and, where it has them,
//   void fields(auto& f);               parameters (fields.hpp):
//                                       f("mass", mass, "kg", "what it is", positive)
//   void inputs(auto& u) const;         what a run may be driven by (inputs.hpp):
//                                       u("torque", "N m", "what it is", range)
//   Start start() const;                the default start
//   Start at_speed(double v) const;     straight ahead at v m/s, the start of a run with `speed`
//   auto exact(g0, xi0) const;          a callable t -> std::pair{g, xi}; |t| increases
//   bool has_exact() const;             where the exact motion depends on the parameters
//   void invariants(auto& add) const;   add("name", [](const auto& g, const auto& xi) { ... })
//   std::vector<int> contacts() const;  the rows of A whose multiplier is a contact's normal
//                                       reaction, which pushes where it is positive (differentials
//                                       of a height, counted from 0)
//   void contacts(auto& add) const;     contacts that may slide, open and strike (contact_law.hpp):
//                                       add({.tangential = {0, 1}, .normal = 2, .friction = mu})
//   auto released() const;              std::optional<Other>: the system with its contacts free to
//                                       open, where that has another group
//   void events(auto& add) const;       add("name", "what it is", direction,
//                                           [](double t, const auto& g, const auto& xi) { ... }):
//                                       zero at the event; direction +1, -1, or 0 for both ways
//   static shape()                      names of the coordinates of the group's factors so2 and rn,
//                                       in order: {"right", "left"}
//   void draw(auto& scene) const;       how the report page shows it (drawing.hpp)
//   static name(), summary(), formula(), known(), source()
//                                       texts for `hamel describe`
#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/close_names.hpp>
#include <hamel/framework/mechanics/drawing.hpp>
#include <hamel/framework/mechanics/event.hpp>
#include <hamel/framework/mechanics/fields.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/mechanics/start.hpp>
#include <hamel/framework/mechanics/system_members.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

namespace detail {

// Passes the members that a system has to a visitor.
template <class S, class Visitor>
void tell_fields(S& system, Visitor& visitor) {
  if constexpr (requires { system.fields(visitor); }) system.fields(visitor);
  else
    static_assert(!named::fields<S>, "fields of this system cannot be called: expected fields(f)");
}
template <class S>
std::vector<std::string> shape_names(const S& system) {
  if constexpr (requires { system.shape(); }) {
    return system.shape();
  } else {
    static_assert(!named::shape<S>,
                  "shape of this system cannot be called: expected static shape()");
    return {};
  }
}
/// Is an invariant the energy, which states of a run have (systems/energy.hpp)?
template <class Value>
constexpr bool is_energy() {
  return requires { requires Value::is_energy; };
}

template <class S, class Visitor>
void tell_invariants(const S& system, Visitor& add) {
  if constexpr (requires { system.invariants(add); }) {
    system.invariants(add);
  } else {
    static_assert(
        !named::invariants<S>,
        "invariants of this system cannot be called: expected a const member invariants(add)");
  }
}
template <class S, class Visitor>
void tell_events(const S& system, Visitor& add) {
  if constexpr (requires { system.events(add); }) {
    system.events(add);
  } else {
    static_assert(!named::events<S>,
                  "events of this system cannot be called: expected a const member events(add)");
  }
}
template <class S, class Visitor>
void tell_drawing(const S& system, Visitor& scene) {
  if constexpr (requires { system.draw(scene); }) {
    system.draw(scene);
  } else {
    static_assert(!named::draw<S>,
                  "draw of this system cannot be called: expected a const member draw(scene)");
  }
}

template <class S>
void add_start_at_speed(const S& system, SystemModel& model) {
  if constexpr (requires {
                  { system.at_speed(0.0) } -> std::convertible_to<Start>;
                }) {
    model.start_at_speed = [system](double speed, double) { return system.at_speed(speed); };
  } else {
    static_assert(
        !named::at_speed<S>,
        "at_speed of this system cannot be called: expected a const member Start at_speed(v)");
  }
}

template <class S>
std::vector<Field> fields_of(S system) {
  FieldReader reader;
  tell_fields(system, reader);
  return reader.fields;
}

template <class S>
std::vector<InputField> inputs_of(const S& system) {
  InputReader reader;
  if constexpr (has_inputs<S>()) system.inputs(reader);
  return reader.inputs;
}

}  // namespace detail

/// How a system that is not left-invariant becomes Mechanics; defined in general_system.hpp, which
/// its file includes.
template <class S>
struct MechanicsOf {
  static std::shared_ptr<const Mechanics> make(const S& system);
  static std::shared_ptr<const Mechanics> drive(const S& system,
                                                std::shared_ptr<const Inputs> inputs);
};

namespace detail {

/// The contacts of a system; those with a law are no rows that only watch a reaction.
template <class S>
void tell_contacts(const S& system, SystemModel& model) {
  const auto add = [&model](ContactLaw law) { model.contact_laws.push_back(std::move(law)); };
  constexpr bool states_rows = requires { system.contacts(); };
  constexpr bool states_laws = requires { system.contacts(add); };
  if constexpr (states_rows) model.contacts = system.contacts();
  if constexpr (states_laws) system.contacts(add);
  static_assert(states_rows || states_laws || !named::contacts<S>,
                "contacts of this system cannot be called: expected a const member contacts(), or "
                "contacts(add)");
  for (const ContactLaw& law : model.contact_laws)
    if (law.normal) std::erase(model.contacts, *law.normal);
}

/// The system whose contacts may open, where it is another one.
template <class S>
std::optional<SystemModel> release(const S& system);

}  // namespace detail

/// The name, group and fields of a system; nothing that its parameters could break.
template <System S>
SystemModel erase_words(const S& system) {
  refuse_misspelt<S>();
  SystemModel model;
  if constexpr (requires { S::name(); }) {
    model.name = S::name();
  } else {
    static_assert(!named::name<S>, "name of this system cannot be called: expected static name()");
    model.name = "user system";
  }
  model.group = group_info<typename S::Group>();
  model.fields = detail::fields_of(system);
  return model;
}

/// Erases a system, parameters as they are. Throws what the system's own members throw.
template <System S>
SystemModel erase(const S& system) {
  using G = typename S::Group;
  constexpr int n = G::dim;
  using Element = typename G::template Element<double>;
  if (std::optional<SystemModel> released = detail::release(system)) return std::move(*released);
  SystemModel model = erase_words(system);
  if constexpr (is_left_invariant<S>()) {
    Eigen::MatrixXd rows(0, n);
    if constexpr (requires { system.constraints(); }) rows = system.constraints();
    model.mechanics = std::make_shared<LeftInvariantMechanics>(system.inertia(), rows);
  } else {
    model.mechanics = MechanicsOf<S>::make(system);
  }
  if constexpr (has_inputs<S>()) {
    model.inputs = detail::inputs_of(system);
    model.drive = [system](std::shared_ptr<const Inputs> inputs) {
      return MechanicsOf<S>::drive(system, std::move(inputs));
    };
  }
  if constexpr (requires { system.start(); }) {
    model.start = system.start();
  } else {
    static_assert(!named::start<S>,
                  "start of this system cannot be called: expected a const member start()");
  }
  detail::add_start_at_speed(system, model);
  bool exact = true;
  if constexpr (requires { system.has_exact(); }) {
    exact = system.has_exact();
  } else {
    static_assert(!named::has_exact<S>,
                  "has_exact of this system cannot be called: expected a const member has_exact()");
  }
  if constexpr (requires(Element g, Vec<n> xi) { system.exact(g, xi); }) {
    if (exact)
      model.exact = [system](const Start& start) -> ExactFlow {
        auto flow = std::make_shared<decltype(system.exact(std::declval<Element>(), Vec<n>()))>(
            system.exact(G::from_coordinates(start.configuration),
                         Eigen::Map<const Vec<n>>(start.velocity.data())));
        return [flow](double t) {
          const auto [g, xi] = (*flow)(t);
          return std::pair{G::coordinates(g), std::vector<double>(xi.begin(), xi.end())};
        };
      };
  } else {
    static_assert(!named::exact<S>,
                  "exact of this system cannot be called: expected a const member exact(g0, xi0)");
  }
  auto add = [&model](std::string name, auto value) {
    model.invariants.push_back(
        {std::move(name),
         [value](std::span<const double> g, std::span<const double> xi) -> double {
           return value(G::from_coordinates(g), Vec<n>(Eigen::Map<const Vec<n>>(xi.data())));
         },
         detail::is_energy<decltype(value)>()});
  };
  detail::tell_invariants(system, add);
  auto add_event = [&model](std::string name, std::string meaning, int direction, auto value) {
    model.events.push_back(
        {std::move(name), std::move(meaning), direction,
         [value](double t, std::span<const double> g, std::span<const double> xi) -> double {
           return value(t, G::from_coordinates(g), Vec<n>(Eigen::Map<const Vec<n>>(xi.data())));
         }});
  };
  detail::tell_events(system, add_event);
  detail::tell_contacts(system, model);
  model.shape = detail::shape_names(system);
  name_quantities(model);
  Scene<G> scene(model.drawing);
  detail::tell_drawing(system, scene);
  return model;
}

namespace detail {
template <class S>
std::optional<SystemModel> release([[maybe_unused]] const S& system) {
  if constexpr (requires { system.released(); }) {
    if (const auto other = system.released()) {
      SystemModel model = erase(*other);
      model.name = erase_words(system).name;
      model.fields = fields_of(system);
      return model;
    }
  } else {
    static_assert(!named::released<S>,
                  "released of this system cannot be called: expected a const member released()");
  }
  return {};
}
}  // namespace detail

/// A system whose dimension is one of its parameters: it names its group ("se2*so2^5") and gives
/// its Mechanics itself. start() as for any system; invariants(add), events(add) and draw(scene)
/// see coordinates.
template <class S>
concept RunTimeSystem = requires(const S& s) {
  { s.group() } -> std::convertible_to<std::string>;
  { s.mechanics() } -> std::convertible_to<std::shared_ptr<const Mechanics>>;
};

template <RunTimeSystem S>
SystemModel erase_words(const S& system) {
  refuse_misspelt<S>();
  SystemModel model;
  model.name = S::name();
  model.group.name = system.group();  // completed by the registry
  model.fields = detail::fields_of(system);
  return model;
}

template <RunTimeSystem S>
SystemModel erase(const S& system) {
  SystemModel model = erase_words(system);
  model.mechanics = system.mechanics();
  model.start = system.start();
  detail::add_start_at_speed(system, model);
  auto add = [&model](std::string name, auto value) {
    model.invariants.push_back({std::move(name), value});
  };
  detail::tell_invariants(system, add);
  auto add_event = [&model](std::string name, std::string meaning, int direction, auto value) {
    model.events.push_back({std::move(name), std::move(meaning), direction, value});
  };
  detail::tell_events(system, add_event);
  model.shape = detail::shape_names(system);
  detail::tell_drawing(system, model.drawing);
  return model;
}

/// From parameters to the erased system; everything not given stays as it is in `system`.
template <class S>
std::function<SystemModel(const Parameters&)> maker(const S& system) {
  return [system](const Parameters& given) {
    if (given.empty()) return erase(system);
    S copy = system;
    const SystemModel as_is = erase_words(copy);
    detail::check_parameters(as_is.name, as_is.fields, given);
    detail::FieldWriter writer{given};
    detail::tell_fields(copy, writer);
    return erase(copy);
  };
}

/// The registry entry of the system type S; S{} holds the defaults.
template <class S>
SystemInfo system_info() {
  SystemInfo info;
  info.name = S::name();
  if constexpr (requires { S::summary(); }) info.summary = S::summary();
  else static_assert(!named::summary<S>, "expected static std::string summary()");
  if constexpr (requires { S::formula(); }) info.formula = S::formula();
  else static_assert(!named::formula<S>, "expected static std::string formula()");
  if constexpr (requires { S::known(); }) info.known = S::known();
  else static_assert(!named::known<S>, "expected static std::string known()");
  if constexpr (requires { S::source(); }) info.source = S::source();
  else static_assert(!named::source<S>, "expected static std::string source()");
  info.group = erase_words(S{}).group;
  info.fields = detail::fields_of(S{});
  if constexpr (System<S>) info.inputs = detail::inputs_of(S{});
  info.make = maker(S{});
  return info;
}

}  // namespace hamel
