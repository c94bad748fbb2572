#include <hamel/framework/ensemble/vary.hpp>

#include <algorithm>
#include <cmath>
#include <exception>

#include <fmt/format.h>

#include <hamel/framework/batch/places.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>

namespace hamel::ensemble {
namespace {

using Law = Variation::Law;
using Kind = Target::Kind;

bool is_number(Law law) {
  return law == Law::values || law == Law::uniform || law == Law::normal ||
         law == Law::log_uniform || law == Law::function;
}

// Flaw of the numbers of a law; "" for none.
std::string flaw_of(const Variation& v) {
  const std::vector<double>& x = v.numbers;
  if (!std::ranges::all_of(x, [](double y) { return std::isfinite(y); }))
    return fmt::format("got {}, expected finite numbers", hamel::join(x));
  const auto wrong = [&](const char* law, const char* expected) {
    return fmt::format("{}: got [{}], expected {}", law, hamel::join(x), expected);
  };
  switch (v.law) {
    case Law::values: return x.empty() ? "a list without values has no members" : "";
    case Law::uniform:
      return x.size() == 2 && x[0] < x[1] ? ""
                                          : wrong("uniform", "[least, most], least below most");
    case Law::log_uniform:
      return x.size() == 2 && 0 < x[0] && x[0] < x[1]
                 ? ""
                 : wrong("log_uniform", "[least, most], 0 < least < most");
    case Law::normal:
      return x.size() == 2 && x[1] > 0 ? "" : wrong("normal", "[mean, sigma], sigma above 0");
    case Law::tau_normal:
      return !x.empty() && std::ranges::all_of(x, [](double s) { return s >= 0; })
                 ? ""
                 : wrong("tau_normal", "a deviation of at least 0, or one for each component");
    case Law::energy: return x.size() == 1 ? "" : wrong("energy", "one number, in J");
    case Law::function: return v.function ? "" : "expected a function of the member";
    case Law::haar: break;
  }
  return "";
}

// Resolves the names of variations.
class Resolver {
 public:
  explicit Resolver(const SystemModel& system)
      : system_(system),
        names_(system),
        units_(units_of_element(system.group)),
        components_(components_of(system)) {
    units_.resize(system.group.columns.size());
    for (const Field& field : system.fields)
      for (size_t i = 0; i < std::max<size_t>(field.value.size(), field.optional); ++i)
        known_.push_back(field.value.size() <= 1 ? field.name
                                                 : fmt::format("{}{}", field.name, i + 1));
    for (const InputField& input : system.inputs) known_.push_back(input.name);
    for (const Component& c : components_) known_.push_back("start." + c.name);
    for (const std::string& column : system.group.columns) known_.push_back("start." + column);
    known_.insert(known_.end(), {"start.configuration", "start.velocity"});
    if (system.start_at_speed) known_.emplace_back("speed");
  }

  // The target, or what is wrong.
  std::string resolve(const Variation& v, Target& out) const {
    if (v.name == "start.configuration") return configuration(v, out);
    if (v.name == "start.velocity") return energy(v, out);
    if (!is_number(v.law))
      return fmt::format("{}: expected values, range, uniform, normal or log_uniform", v.name);
    if (v.name == "speed" && system_.start_at_speed) {
      out = {Kind::speed, "", 0, "m/s", "straight ahead"};
      return "";
    }
    if (v.name.starts_with("start.")) return start(v.name, out);
    return field(v.name, out);
  }

 private:
  std::string configuration(const Variation& v, Target& out) const {
    if (v.law == Law::haar && !rotations_of(system_.group).empty()) {
      out.kind = Kind::rotation;
      return "";
    }
    const auto n = static_cast<size_t>(system_.group.dim);
    if (v.law == Law::tau_normal && (v.numbers.size() == 1 || v.numbers.size() == n)) {
      out.kind = Kind::moved;
      return "";
    }
    return fmt::format(
        "start.configuration: expected {{ uniform = \"so3\" }} of a group with rotations of space, "
        "or {{ tau_normal = sigma }} with one number or {} of them; {} is of {}",
        n, system_.name, system_.group.name);
  }
  static std::string energy(const Variation& v, Target& out) {
    out.kind = Kind::energy;
    return v.law == Law::energy ? "" : "start.velocity: expected { energy = E }";
  }
  std::string start(const std::string& name, Target& out) const {
    const auto place = names_.find(name.substr(6));
    if (!place) return unknown_name("name to vary", name, known_);
    const size_t columns = system_.group.columns.size();
    if (*place >= columns) {
      const size_t i = *place - columns;
      out = {Kind::velocity, "", i, components_[i].unit, "requested at the start"};
      return "";
    }
    for (const size_t first : rotations_of(system_.group))
      if (*place >= first && *place < first + 9)
        return fmt::format("{}: an entry of a rotation is not free; vary start.configuration",
                           name);
    out = {Kind::coordinate, "", *place, units_[*place], "requested at the start"};
    return "";
  }
  std::string field(const std::string& name, Target& out) const {
    for (const Field& f : system_.fields) {
      for (size_t i = 0; i < std::max<size_t>(f.value.size(), f.optional); ++i) {
        if (name != (f.value.size() <= 1 ? f.name : fmt::format("{}{}", f.name, i + 1))) continue;
        out = {Kind::parameter, f.name, i, f.unit, f.meaning};
        return "";
      }
    }
    for (const InputField& input : system_.inputs) {
      if (name != input.name) continue;
      out = {Kind::input, name, 0, input.unit, input.meaning};
      return "";
    }
    return unknown_name("name to vary", name, known_);
  }

  const SystemModel& system_;
  QuantityNames names_;
  std::vector<std::string> units_;
  std::vector<Component> components_;
  std::vector<std::string> known_;
};

// The numbers that the field of a target allows; null: all.
const Range* range_of(const SystemModel& system, const Target& target) {
  if (target.kind == Kind::parameter) {
    for (const Field& f : system.fields) {
      const bool matrix = f.range.moments && f.value.size() > 3;  // checked with the system's
      if (f.name == target.field && !matrix) return &f.range;
    }
  }
  for (const InputField& input : system.inputs)
    if (target.kind == Kind::input && input.name == target.field) return &input.range;
  return nullptr;
}

// Two variations of one thing, or a start in two ways.
std::string conflict(const std::vector<Target>& targets, size_t i) {
  for (size_t j = 0; j < i; ++j) {
    const Target &a = targets[j], &b = targets[i];
    if (a.kind == b.kind && a.field == b.field && a.index == b.index) return "this is varied twice";
    if ((a.kind == Kind::energy && b.kind == Kind::velocity) ||
        (a.kind == Kind::velocity && b.kind == Kind::energy))
      return "a velocity on an energy surface has no component given";
  }
  return "";
}

}  // namespace

std::vector<size_t> rotations_of(const GroupInfo& group) {
  std::vector<size_t> out;
  size_t column = 0;
  for (const GroupFactor& factor : group.factors) {
    if (factor.name == "so3" || factor.name == "se3") out.push_back(column);
    column += static_cast<size_t>(factor.columns);
  }
  return out;
}

Variations::Variations(EnsembleConfig& config, const SystemModel& system,
                       std::vector<std::string>& mistakes)
    : vary_(config.vary),
      targets_(vary_.size()),
      streams_(vary_.size()),
      strides_(vary_.size(), 1),
      seed_(config.seed) {
  std::vector<std::string> wrong(vary_.size());  // of each
  resolve(system, wrong);
  const size_t before = mistakes.size();
  count_members(config, mistakes, wrong);
  const bool fine = mistakes.size() == before && std::ranges::all_of(wrong, &std::string::empty);
  if (fine) check_ranges(config.members, system, wrong);
  for (size_t i = 0; i < wrong.size(); ++i) {
    if (wrong[i].empty()) continue;
    const std::string key = "vary." + vary_[i].name;
    const bool named = wrong[i].find(vary_[i].name) != std::string::npos;
    mistakes.push_back(placed(config.where, key, named ? wrong[i] : key + ": " + wrong[i]));
  }
}

void Variations::resolve(const SystemModel& system, std::vector<std::string>& wrong) {
  const Resolver resolver(system);
  for (size_t i = 0; i < vary_.size(); ++i) {
    streams_[i] = stream_of(vary_[i].name);
    const auto mine = streams_.begin() + static_cast<std::ptrdiff_t>(i);
    wrong[i] = flaw_of(vary_[i]);
    if (wrong[i].empty()) wrong[i] = resolver.resolve(vary_[i], targets_[i]);
    if (wrong[i].empty()) wrong[i] = conflict(targets_, i);
    if (wrong[i].empty() && std::find(streams_.begin(), mine, streams_[i]) != mine)
      wrong[i] = "it would draw the numbers of another name: use another name of it";
    if (is_number(vary_[i].law)) numbered_.push_back(i);
  }
}

// The members, and how far the lists run with them.
void Variations::count_members(EnsembleConfig& config, std::vector<std::string>& mistakes,
                               std::vector<std::string>& wrong) {
  constexpr long most = 1'000'000'000;
  long lists = 1, longest = 0;
  for (size_t i = vary_.size(); i-- > 0;) {
    if (vary_[i].law != Law::values) continue;
    const auto size = static_cast<long>(vary_[i].numbers.size());
    if (config.grid) strides_[i] = lists;
    lists = std::min(lists * std::max(size, 1L), most);
    longest = std::max(longest, size);
  }
  if (config.members == 0) config.members = config.grid ? lists : longest;
  const long members = config.members;
  const auto add = [&](const std::string& text) {
    mistakes.push_back(placed(config.where, "members", text));
  };
  if (members <= 0 || members >= most)
    return add(fmt::format("members: got {}, expected 1 to {}", members, most - 1));
  if (config.grid && members % lists != 0)
    add(fmt::format("members: got {}, expected a multiple of the {} combinations, or none", members,
                    lists));
  for (size_t i = 0; i < vary_.size() && !config.grid; ++i) {
    const auto size = static_cast<long>(vary_[i].numbers.size());
    if (vary_[i].law == Law::values && size != members && wrong[i].empty())
      wrong[i] =
          fmt::format("{} values for {} members; all combinations: grid = true", size, members);
  }
}

// Numbers out of a field's range: those that may be drawn, of a normal or a function those that
// are.
void Variations::check_ranges(long members, const SystemModel& system,
                              std::vector<std::string>& wrong) const {
  for (const size_t i : numbered_) {
    const Range* range = range_of(system, targets_[i]);
    const bool function = vary_[i].law == Law::function;
    if (range == nullptr && !function) continue;
    if (vary_[i].law == Law::normal || function) {
      const auto allowed = [&](double x) {
        return std::isfinite(x) && (range == nullptr || range->allows(x));
      };
      long member = 0;
      try {
        while (member < members && allowed(number(i, member))) ++member;
        if (member < members)
          wrong[i] = fmt::format("member {} would have {}, expected {}", member, number(i, member),
                                 range == nullptr ? "a finite number" : range->words());
      } catch (const std::exception& error) {  // of a function
        wrong[i] = fmt::format("of member {}: {}", member, error.what());
      }
      continue;
    }
    std::vector<double> ends = vary_[i].numbers;
    if (vary_[i].law != Law::values) {  // an open end is never drawn
      const double part = 1e-9 * (ends[1] - ends[0]);
      ends = {ends[0] + part, ends[1] - part};
    }
    if (!std::ranges::all_of(ends, [&](double x) { return range->allows(x); }))
      wrong[i] = fmt::format("got {}, expected {}", hamel::join(vary_[i].numbers), range->words());
  }
}

bool Variations::any(Kind kind) const {
  return std::ranges::any_of(targets_, [&](const Target& t) { return t.kind == kind; });
}

double Variations::number(size_t variation, long member) const {
  const Variation& v = vary_[variation];
  const std::vector<double>& x = v.numbers;
  if (v.law == Law::values) {
    const auto at = static_cast<size_t>(member / strides_[variation]);
    return x[at % x.size()];
  }
  if (v.law == Law::function) return v.function(member);
  Draws random = draws(variation, member);
  switch (v.law) {
    case Law::uniform: return x[0] + (x[1] - x[0]) * random.uniform();
    case Law::log_uniform: return x[0] * std::exp(std::log(x[1] / x[0]) * random.uniform());
    default: return x[0] + x[1] * random.normal();
  }
}

}  // namespace hamel::ensemble
