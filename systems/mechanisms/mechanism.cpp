#include <hamel/framework/io/let_names.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

#include <hamel/systems/mechanisms/assembly/assembly.hpp>

namespace hamel {
namespace {

std::vector<double> values_of(const Point& p) { return {p.begin(), p.end()}; }

template <class Options>
ContactOptions contact_options(const Options& o, Parameters values) {
  return {o.at,   std::move(values), o.friction,        o.restitution,
          o.load, o.unilateral,      o.static_friction, o.tangential_restitution,
          o.share};
}

}  // namespace

Mechanism::Mechanism(std::string name) : name_(std::move(name)) {}
Mechanism::Mechanism(const Mechanism&) = default;
Mechanism::Mechanism(Mechanism&&) noexcept = default;
Mechanism& Mechanism::operator=(const Mechanism&) = default;
Mechanism& Mechanism::operator=(Mechanism&&) noexcept = default;
Mechanism::~Mechanism() = default;

Mechanism::Part Mechanism::part(const std::string& name) const { return {name, where_}; }

std::string Mechanism::body(const std::string& name, const BodyOptions& options) {
  bodies_.push_back({part(name), options});
  return name;
}

void Mechanism::joint(const std::string& kind, const std::string& name, const std::string& parent,
                      const std::string& child, const JointOptions& options) {
  joints_.push_back({part(name), options, kind, parent, child});
}

void Mechanism::contact(const std::string& kind, const std::string& name, const std::string& body,
                        const ContactOptions& options) {
  if (options.on.empty() && options.inside.empty()) {
    contacts_.push_back({part(name), options, kind, body});
    return;
  }
  const auto radius = options.values.find("radius");
  LoopPart pair{part(name), LoopOptions{options.at}, options.on + options.inside, body, kind};
  if (radius != options.values.end() && radius->second.size() == 1) pair.radius = radius->second[0];
  pair.inside = !options.inside.empty();
  pair.both = pair.inside && !options.on.empty();
  pair.contact = options;
  loops_.push_back(std::move(pair));
}
void Mechanism::wheel(const std::string& name, const std::string& body, const WheelOptions& o) {
  contact("wheel", name, body,
          contact_options(o, {{"axle", values_of(o.axle)}, {"radius", {o.radius}}}));
}
void Mechanism::roller(const std::string& name, const std::string& body, const WheelOptions& o) {
  contact("roller", name, body,
          contact_options(
              o, {{"axle", values_of(o.axle)}, {"radius", {o.radius}}, {"angle", {o.angle}}}));
}
void Mechanism::blade(const std::string& name, const std::string& body, const BladeOptions& o) {
  contact("blade", name, body, contact_options(o, {{"along", values_of(o.along)}}));
}
void Mechanism::ball(const std::string& name, const std::string& body, const WheelOptions& o) {
  ContactOptions options = contact_options(o, {{"radius", {o.radius}}});
  options.on = o.on;
  options.inside = o.inside;
  contact("ball", name, body, options);
}
void Mechanism::point(const std::string& name, const std::string& body, const PointOptions& o) {
  contact("point", name, body, contact_options(o, {}));
}

void Mechanism::loop(const std::string& name, const std::string& a, const std::string& b,
                     const LoopOptions& options) {
  loops_.push_back({part(name), options, a, b});
}
void Mechanism::coupling(const std::string& name, const CouplingOptions& options) {
  time(options.formula + " " + options.rates);
  couplings_.push_back({part(name), options});
}
void Mechanism::wall(const std::string& name, const WallOptions& options) {
  time(options.distance + " " + options.slip);
  walls_.push_back({part(name), options});
}
void Mechanism::time(const std::string& formula) {
  const std::vector<std::string> words = LetNames::words(formula);
  if (std::ranges::find(words, "t") == words.end()) return;
  if (std::ranges::any_of(states_, &StateOfRate::is_time)) return;
  states_.push_back({part("clock"), {.rate = "1", .unit = "s"}, true});
}
void Mechanism::prescribe(const std::string& joint, std::function<double(double t)> rate,
                          std::function<double(double t)> angle,
                          std::function<double(double t)> slope) {
  rates_.push_back({part(joint), std::move(rate), std::move(angle), std::move(slope), true, {}});
}
void Mechanism::prescribe(const std::string& joint, double rate,
                          std::function<double(double t)> angle) {
  rates_.push_back({part(joint), [rate](double) { return rate; }, std::move(angle), {}, false, {}});
}
void Mechanism::prescribe(const std::string& joint, const Range& range) {
  rates_.push_back({part(joint), {}, {}, {}, false, range});
}
void Mechanism::ground(double rate, Point velocity) {
  ground_rate_ = rate;
  ground_velocity_ = velocity;
}
void Mechanism::ground_height(const std::string& formula, const Parameters& constants) {
  ground_height_ = {part(formula), constants};
}

void Mechanism::spring(const std::string& name, const std::string& a, const std::string& b,
                       const SpringOptions& options) {
  springs_.push_back({part(name), options, a, b});
}
void Mechanism::motor(const std::string& joint, Signal effort, bool time_dependent) {
  motors_.push_back({part(joint), std::move(effort), time_dependent});
}
void Mechanism::brake(const std::string& joint, const Range& range) {
  brakes_.push_back({part(joint), range});
}
void Mechanism::motor(const std::string& joint, const Range& range) {
  motors_.push_back({part(joint), {}, false, range});
}
void Mechanism::force(const std::string& name, const std::string& body,
                      const ForceOptions& options) {
  forces_.push_back({part(name), options, body});
}
void Mechanism::torque(const std::string& name, const std::string& body,
                       const TorqueOptions& options) {
  ForceOptions force;
  std::copy(std::begin(options.along), std::end(options.along), std::begin(force.along));
  force.of_body = options.of_body;
  force.time_dependent = options.time_dependent;
  forces_.push_back({part(name), force, body, true});
}

void Mechanism::state(const std::string& name, const StateOptions& options) {
  states_.push_back({part(name), options, false});
  time(options.rate);
}

void Mechanism::sensor(const std::string& name, const std::string& body, Point at) {
  sensors_.push_back({part(name), body, at});
}
void Mechanism::output(const std::string& name, const std::string& formula,
                       const OutputOptions& options) {
  outputs_.push_back({part(name), options, formula});
}

void Mechanism::redundant(const std::string& policy) { redundant_ = part(policy); }
void Mechanism::distribution(const std::string& policy) { distribution_ = part(policy); }
void Mechanism::input(const InputField& field) { inputs_.push_back({part(field.name), field}); }
void Mechanism::event(Event event) { events_.push_back(std::move(event)); }

void Mechanism::start(const std::map<std::string, double>& values) {
  start_.clear();
  for (const auto& [name, value] : values) start(name, value);
}
void Mechanism::start(const std::string& name, double value) {
  start_.push_back({part(name), value});
}
void Mechanism::push(const std::string& name, double value) {
  push_.push_back({part(name), value});
}
void Mechanism::start_arguments(std::vector<std::string> names) {
  start_arguments_ = {part("start_arguments"), std::move(names)};
}

SystemModel Mechanism::model() const { return Assembly(*this).model(); }
SystemModel Mechanism::outline() const { return Assembly(*this).outline(); }

std::function<SystemModel(const Parameters&)> maker(const Mechanism& mechanism) {
  return [mechanism](const Parameters& given) {
    detail::check_parameters(mechanism.name(), {}, given);
    return mechanism.model();
  };
}

SystemInfo system_info(const Mechanism& mechanism) {
  SystemInfo info;
  info.name = mechanism.name();
  info.summary = "mechanism by parts";
  const SystemModel outline = mechanism.outline();
  info.group = outline.group;
  info.inputs = outline.inputs;
  info.make = maker(mechanism);
  return info;
}

}  // namespace hamel
