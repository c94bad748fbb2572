// Assembly: couplings of joints.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/systems/mechanisms/assembly/assembly.hpp>

namespace hamel {

using namespace mechanisms;

std::vector<Coupling> Assembly::couplings() {
  std::vector<Coupling> out;
  for (const auto& part : parts_.couplings_) {
    const bool related = !part.joint.empty() || !part.to.empty();
    if (int(related) + int(!part.formula.empty()) + int(!part.rates.empty()) != 1) {
      wrong(part, "coupling",
            "expected one of: joint and to, with ratio and offset; formula; rates");
      continue;
    }
    if (!related && (part.ratio != 1 || part.offset != 0)) {
      wrong(part, "coupling", "ratio and offset: expected joint and to beside them");
      continue;
    }
    const char* const key = part.rates.empty() ? "formula" : "rates";
    if (auto found = related ? gear(part) : coupling(part, "coupling", key))
      out.push_back(std::move(*found));
  }
  add_state_rates(out);
  return out;
}

void Assembly::add_state_rates(std::vector<Coupling>& out) {
  for (const auto& part : parts_.states_) {
    if (part.rate.empty()) {
      wrong(part, "state", "rate: not given, expected a formula");
      continue;
    }
    Mechanism::CouplingPart row;
    row.name = part.name;
    row.where = part.where;
    row.constants = part.constants;
    QuantityNames names(model_);
    for (const auto& [constant, value] : part.constants) names.forget(constant);
    row.rates = names.in_formula(part.rate);
    if (auto found = coupling(row, "state", "rate")) out.push_back(std::move(*found));
  }
}

// joint - (ratio * to + offset).
std::optional<Coupling> Assembly::gear(const Mechanism::CouplingPart& part) {
  const auto link = [&](const std::string& what, const std::string& joint) {
    std::vector<std::string> known;
    for (size_t j = 0; j < links_.size(); ++j) {
      if (links_[j].joint->dim() != 1) continue;
      if (link_names_[j] == joint) return static_cast<int>(j);
      known.push_back(link_names_[j]);
    }
    unknown(part, "coupling", fmt::format("{} ({})", what, kinds_with_coordinate()), joint, known);
    return kGround;
  };
  const int joint = link("joint", part.joint), to = link("to", part.to);
  if (joint == kGround || to == kGround) return std::nullopt;
  if (joint == to) {
    wrong(part, "coupling", fmt::format("expected two joints, got '{}' twice", part.joint));
    return std::nullopt;
  }
  return Coupling{part.name,
                  Expression("joint - (ratio * to + offset)", {"joint", "to"},
                             {{"ratio", part.ratio}, {"offset", part.offset}}),
                  {joint, to},
                  {}};
}

// The text of a state's rate is first judged by itself, then subtracted from its velocity.
std::optional<Coupling> Assembly::coupling(const Mechanism::CouplingPart& part,
                                           const std::string& kind, const std::string& key) {
  const bool of_rates = !part.rates.empty(), of_state = kind == "state";
  std::map<std::string, double> constants;
  for (const auto& [name, value] : part.constants)
    if (value.size() == 1) constants[name] = value.front();
  std::vector<int> links, velocities;
  std::vector<std::string> names;
  size_t column = 0;
  for (size_t j = 0; j < links_.size(); ++j) {
    const Joint& joint = *links_[j].joint;
    if (joint.dim() == 1) {
      links.push_back(static_cast<int>(j));
      names.push_back(links_[j].is_time ? "t" : model_.group.columns[column]);
    }
    column += joint.columns().size();
  }
  for (size_t i = 0; i < model_.rates.size(); ++i) velocities.push_back(static_cast<int>(i));
  names.insert(names.end(), model_.rates.begin(), model_.rates.end());
  try {
    Coupling out{part.name, Expression(of_rates ? part.rates : part.formula, names, constants),
                 links, velocities};
    const std::vector<size_t> used = out.formula.used();
    const auto rate = std::ranges::find_if(used, [&](size_t i) { return i >= out.links.size(); });
    std::string mistake;
    if (out.formula.may_jump())
      mistake = "expected a formula without comparisons, a ? b : c, sign and rint";
    else if (!of_state && (used.empty() || (of_rates && rate == used.end())))
      mistake = fmt::format("expected a formula of {}",
                            of_rates ? "rates of joints" : "coordinates of joints");
    else if (!of_rates && rate != used.end())
      mistake = fmt::format("'{}' is a velocity; an equation of velocities is stated as `rates`",
                            names[*rate]);
    out.affine = of_state;
    if (mistake.empty() && of_rates) mistake = not_linear(out);
    if (mistake.empty()) {
      if (!of_rates) out.velocities.clear();
      if (of_state)
        out.formula =
            Expression(fmt::format("{}.rate - ({})", part.name, part.rates), names, constants);
      return out;
    }
    wrong(part, kind, fmt::format("{}: {}", key, mistake));
  } catch (const ExpressionError& error) {
    wrong(part, kind, fmt::format("{}: {}", key, error.what()));
  }
  return std::nullopt;
}

}  // namespace hamel
