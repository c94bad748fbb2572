#include <hamel/framework/mechanics/quantity_names.hpp>

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/formula_words.hpp>
#include <hamel/framework/mechanics/components.hpp>
#include <hamel/framework/mechanics/quantities.hpp>

namespace hamel {
namespace {

using Names = std::vector<std::string>;

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Names of columns that every run may have: t, energy, mu1, the reactions.
Names measured_columns(const SystemModel& model) {
  Names out = model.reactions;
  for (const Quantity& quantity : kMeasuredColumns) out.emplace_back(quantity.name);
  for (int i = 1; i <= model.group.dim; ++i) {
    out.push_back(fmt::format("mu{}", i));
    out.push_back(fmt::format("lambda{}", i));
  }
  return out;
}

// Names of parameters as formulas have them: mass, inertia1.
Names constants_of(const SystemModel& model) {
  Names out;
  for (const Field& field : model.fields) {
    out.push_back(field.name);
    for (size_t i = 1; i <= field.value.size() && field.value.size() > 1; ++i)
      out.push_back(fmt::format("{}{}", field.name, i));
  }
  return out;
}

// The namer of one model.
class Namer {
 public:
  explicit Namer(SystemModel& model)
      : model_(model),
        factors_(model.group.factors),
        columns_(measured_columns(model)),
        constants_(constants_of(model)) {
    for (const ShapeCoordinate& shape : shape_of(model.group))
      shape_.emplace_back(shape.column, shape.component);
    const Names& stated = model.shape;
    if (!stated.empty() && stated.size() != shape_.size())
      throw ConfigError({fmt::format("shape of {}: expected {} names, got {}", model.name,
                                     shape_.size(), stated.size())});
  }

  void name() {
    const Names coordinates = name_coordinates();
    const Names velocities = name_velocities(coordinates);
    add_others(coordinates, velocities);
    model_.group.columns = coordinates;
    model_.rates = velocities;
    model_.has_names = true;
  }

 private:
  Names name_coordinates() {
    const Names own = own_columns(), stated = stated_coordinates(own);
    Names out = stated;
    size_t at = 0;
    for (size_t f = 0; f < factors_.size(); ++f) {
      for (size_t k = 0; k < factors_[f].names.size(); ++k, ++at) {
        const std::string &name = stated[at], numbered = fmt::format("{}_{}", f + 1, own[at]);
        const bool measured = has(columns_, name),
                   twice = std::count(stated.begin(), stated.end(), name) > 1;
        if (measured) left_.push_back({name, at});
        if (measured || (factors_.size() > 1 && taken(name)) || (twice && name != own[at]))
          leave(out[at], numbered);
        else if (twice) out[at] = numbered;
      }
    }
    return out;
  }
  // Those of the groups, with stated names in place of those of the shape, or of all.
  Names stated_coordinates(Names own) const {
    if (!model_.coordinates.empty()) return model_.coordinates;
    for (size_t i = 0; i < model_.shape.size(); ++i)
      own[static_cast<size_t>(shape_[i].first)] = model_.shape[i];
    return own;
  }
  bool taken(const std::string& name) const {
    return has(constants_, name) ||
           std::any_of(model_.inputs.begin(), model_.inputs.end(),
                       [&](const InputField& input) { return input.name == name; });
  }
  // Columns have another name, since something else has this one.
  void leave(std::string& name, const std::string& other) {
    model_.notes.push_back(
        fmt::format("'{0}' of {1} is called {2} in columns: something else is called {0}", name,
                    model_.name, other));
    name = other;
  }

  Names name_velocities(const Names& coordinates) {
    Names out = model_.rates.empty() ? velocities_of_factors(coordinates) : model_.rates;
    std::set<std::string> before(coordinates.begin(), coordinates.end());
    for (size_t i = 0; i < out.size(); ++i) {
      std::string number = fmt::format("xi{}", i + 1);
      while (before.contains(number)) number += '_';
      const bool ambiguous = before.contains(out[i]),
                 known = has(columns_, out[i]) || has(constants_, out[i]);
      if (known && !ambiguous) left_.push_back({out[i], coordinates.size() + i});
      if (known || ambiguous) leave(out[i], number);
      before.insert(out[i]);
    }
    return out;
  }
  Names velocities_of_factors(const Names& coordinates) const {
    std::vector<Names> names;
    int number = 0;
    for (const GroupFactor& factor : factors_) {
      Names& own = names.emplace_back();
      for (int i = 0; i < factor.dim; ++i, ++number)
        own.push_back(factor.components.empty() ? fmt::format("xi{}", number + 1)
                                                : factor.components[static_cast<size_t>(i)].name);
    }
    Names out = number_repeated(names);
    const Names own = own_columns(), raw = flat(names);
    for (const auto& [column, component] : shape_) {
      const auto k = static_cast<size_t>(column), i = static_cast<size_t>(component);
      const bool stated = !model_.shape.empty() || !model_.coordinates.empty();
      if (stated || raw[i] == own[k] + "'") out[i] = coordinates[k] + "'";
    }
    return out;
  }
  static Names flat(const std::vector<Names>& names) {
    Names out;
    for (const Names& some : names) out.insert(out.end(), some.begin(), some.end());
    return out;
  }
  Names own_columns() const {
    Names out;
    for (const GroupFactor& factor : factors_)
      out.insert(out.end(), factor.names.begin(), factor.names.end());
    return out;
  }

  void add_others(const Names& coordinates, const Names& velocities) {
    all_.insert(coordinates.begin(), coordinates.end());
    all_.insert(velocities.begin(), velocities.end());
    const size_t count = coordinates.size();
    for (const OtherName& left : left_) add(left.name, left.place);
    for (size_t i = 0; i < velocities.size(); ++i) add(fmt::format("xi{}", i + 1), count + i);
    for (size_t k = 0; k < count; ++k) add(name_in_formula(coordinates[k]), k);
    for (size_t i = 0; i < velocities.size(); ++i) add(name_in_formula(velocities[i]), count + i);
    if (model_.coordinates.empty() && factors_.size() > 1) add_numbered(count);
    if (model_.rates.empty()) add_components(count);
    for (const auto& [column, component] : shape_) {
      const auto k = static_cast<size_t>(column);
      add_free(coordinates[k] + "'", count + static_cast<size_t>(component));
    }
  }
  // 4_theta and theta_4, whatever the system calls it, and its rate theta_4'.
  void add_numbered(size_t coordinates) {
    size_t place = 0, shape = 0;
    for (size_t f = 1; f <= factors_.size(); ++f) {
      for (const std::string& own : factors_[f - 1].names) {
        add(fmt::format("{}_{}", f, own), place);
        add(fmt::format("{}_{}", own, f), place++);
        if (factors_[f - 1].is_shape)
          add(fmt::format("{}_{}'", own, f),
              coordinates + static_cast<size_t>(shape_[shape++].second));
      }
    }
  }
  // Those of the groups, with the number of the factor behind where there are several alike:
  // angle_4', and of the coordinate angle_4.
  void add_components(size_t coordinates) {
    size_t place = coordinates, shape = 0;
    for (size_t f = 0; f < factors_.size(); ++f) {
      const auto alike = [&](const GroupFactor& other) { return other.name == factors_[f].name; };
      const bool several = std::count_if(factors_.begin(), factors_.end(), alike) > 1;
      for (const Component& component : factors_[f].components) {
        std::string stem = component.other.empty() ? component.name : component.other;
        const bool rate = stem.ends_with('\'');
        if (rate) stem.pop_back();
        if (several) stem += fmt::format("_{}", f + 1);
        add(stem + (rate ? "'" : ""), place++);
        if (!factors_[f].is_shape) continue;
        const auto column = static_cast<size_t>(shape_[shape++].first);
        if (model_.coordinates.empty()) add_free(stem, column);
      }
    }
  }
  void add_free(const std::string& name, size_t place) {
    if (!taken(name)) add(name, place);
  }
  // The first of a name has it.
  void add(const std::string& name, size_t place) {
    if (all_.insert(name).second) model_.other_names.push_back({name, place});
  }

  SystemModel& model_;
  const std::vector<GroupFactor>& factors_;
  const Names columns_, constants_;
  std::vector<std::pair<int, int>> shape_;  // column and component
  std::vector<OtherName> left_;  // to another column or a parameter, and read all the same
  std::set<std::string> all_;
};

}  // namespace

void name_quantities(SystemModel& model) {
  if (!model.has_names && model.group.dim > 0) Namer(model).name();
}

std::string name_in_formula(const std::string& name) {
  const size_t digits = name.find_first_not_of("0123456789");
  if (digits == 0 || digits == std::string::npos || name[digits] != '_') return name;
  const bool rate = name.ends_with('\'');
  const size_t end = name.size() - (rate ? 1 : 0);
  return name.substr(digits + 1, end - digits - 1) + "_" + name.substr(0, digits) +
         (rate ? "'" : "");
}

QuantityNames::QuantityNames(const SystemModel& model) : all_(model.group.columns) {
  all_.insert(all_.end(), model.rates.begin(), model.rates.end());
  variables_.emplace_back("t");
  for (size_t i = 0; i < all_.size(); ++i) {
    variables_.push_back(name_in_formula(all_[i]));
    places_.emplace(all_[i], i);
  }
  for (const OtherName& other : model.other_names) places_.emplace(other.name, other.place);
}

std::optional<std::size_t> QuantityNames::find(const std::string& name) const {
  const auto at = places_.find(name);
  if (at == places_.end()) return {};
  return at->second;
}

std::string QuantityNames::in_formula(const std::string& text) const {
  std::string out;
  for (size_t i = 0; i < text.size();) {
    size_t end = i;
    while (end < text.size() && may_be_in_name(text[end])) ++end;
    if (end == i) {
      out += text[i++];
      continue;
    }
    const std::string word = text.substr(i, end - i);
    const auto place = find(word);
    out += place ? variables_[*place + 1] : word;
    i = end;
  }
  return out;
}

std::string QuantityNames::in_words(std::string message) const {
  for (size_t i = 0; i < all_.size(); ++i) {
    const std::string variable = "'" + variables_[i + 1] + "'";
    const size_t at = all_[i] == variables_[i + 1] ? std::string::npos : message.find(variable);
    if (at != std::string::npos) message.replace(at, variable.size(), "'" + all_[i] + "'");
  }
  return message;
}

}  // namespace hamel
