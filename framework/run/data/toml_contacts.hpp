// Contacts with friction of a file that describes a system (mechanics/contact_law.hpp). Not
// installed.
//
//   [[contact]]
//   name = "blade"         # left out: contact
//   tangential = [1]       # one or two rows, from 1: orthonormal directions of the slip
//   normal = 2             # the row of a gap, one of the holonomic ones; or in its place
//   load = "m*g"           # a constant normal force, N
//   friction = "mu"        # also static_friction, restitution, tangential_restitution, share
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/toml_formulas.hpp>
#include <hamel/framework/mechanics/contact_law.hpp>

namespace hamel {

/// Rows as a file counts them, from 1: those that it states, then the holonomic ones, between which
/// the system has rows of its states.
struct StatedRows {
  int stated = 0, of_states = 0, holonomic = 0;
  int count() const { return stated + holonomic; }
  int index(int row) const { return row - 1 + (row > stated ? of_states : 0); }
};

class ContactReader {
 public:
  ContactReader(TomlReader& read, TomlFormulas& formulas, const StatedRows& rows)
      : read_(read), formulas_(formulas), rows_(rows) {}

  std::vector<ContactLaw> read(const toml::table& file) const {
    std::vector<ContactLaw> out;
    const toml::node* node = file.get("contact");
    if (node == nullptr) return out;
    if (!node->is_array_of_tables())
      return read_.wrong(*node, "contact", "tables [[contact]]"), out;
    for (const toml::node& entry : *node->as_array()) {
      ContactLaw law = this->law(*entry.as_table());
      const bool taken =
          std::ranges::any_of(out, [&](const ContactLaw& other) { return other.name == law.name; });
      if (taken) read_.wrong_value(entry, "contact", "another name than '" + law.name + "'");
      out.push_back(std::move(law));
    }
    return out;
  }

 private:
  ContactLaw law(const toml::table& table) const {
    ContactLaw out;
    bool rubs = false;
    const std::pair<const char*, double*> numbers[] = {
        {"load", &out.load},
        {"friction", &out.friction},
        {"static_friction", &out.static_friction},
        {"restitution", &out.restitution},
        {"tangential_restitution", &out.tangential_restitution},
        {"share", &out.share}};
    std::vector<std::string> known = {"name", "tangential", "normal"};
    for (const auto& [name, unused] : numbers) known.emplace_back(name);
    for (const auto& [word, node] : table) {
      const std::string key(word.str());
      const auto number = std::ranges::find(numbers, key, [](const auto& n) { return n.first; });
      if (number != std::end(numbers)) *number->second = formulas_.number(node, key);
      else if (key == "name") read_.value(node, key, out.name);
      else if (key == "tangential") out.tangential = tangential(node, key);
      else if (key == "normal") normal(node, key, out);
      else read_.unknown_key(node, key, known);
      rubs = rubs || key == "friction";
    }
    if (!rubs) read_.wrong(table, "contact", "friction = ...; 0 for a smooth one");
    if (!table.contains("normal") && !table.contains("load"))
      read_.wrong(table, "contact", "normal = the row of its gap, or load = a force in N");
    if (table.contains("normal") && table.contains("load"))
      read_.wrong(table, "contact", "normal or load, not both");
    if (out.tangential.size() > 2) read_.wrong(table, "tangential", "at most two rows");
    return out;
  }
  std::vector<int> tangential(const toml::node& node, const std::string& key) const {
    std::vector<int> out;
    for (const double row : formulas_.numbers(node, key)) out.push_back(row_of(node, key, row, 1));
    return out;
  }
  void normal(const toml::node& node, const std::string& key, ContactLaw& out) const {
    out.normal = row_of(node, key, formulas_.number(node, key), rows_.stated + 1);
  }
  // Rows from `least` on; the first row, with a mistake, where there is no such one.
  int row_of(const toml::node& node, const std::string& key, double row, int least) const {
    if (row >= least && row <= rows_.count() && row == std::floor(row))
      return rows_.index(static_cast<int>(row));
    if (least > rows_.count()) read_.wrong(node, key, "a holonomic row, of which there is none");
    else read_.wrong(node, key, fmt::format("rows, {} to {}, got {}", least, rows_.count(), row));
    return 0;
  }

  TomlReader& read_;
  TomlFormulas& formulas_;
  StatedRows rows_;
};

}  // namespace hamel
