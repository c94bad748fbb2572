// The parts of a mechanism, read from its file into it. Not installed.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/files/file_values.hpp>

namespace hamel::mechanisms {

class FileParts {
 public:
  /// held: joints that are locked beside those of the file, "arm" or "arm=0.3".
  FileParts(FileValues& read, const toml::table& file, Mechanism& to,
            const std::vector<std::string>& held)
      : read_(read), table_(file), m_(to), held_(held) {}
  void bodies();
  void joints();
  void inputs();
  // Their formulas may use the names of joints and inputs.
  void contacts();
  void chains();
  void forces();
  void sensors();
  void states();
  void hold();
  void surroundings();

 private:
  using Node = toml::node;

  // read(node) of a key, where the file has it; its messages carry its place.
  template <class Read>
  void stated(const std::string& key, Read&& read) {
    const Node* node = table_.get(key);
    if (node == nullptr) return;
    m_.place(read_.toml.place(*node) + ": ");
    read(*node);
  }
  // each(table) for the tables [[kind]].
  template <class Each>
  void tables(const std::string& kind, Each&& each) {
    stated(kind, [&](const Node& node) {
      const toml::array* array = node.as_array();
      if (array == nullptr || !array->is_array_of_tables())
        return read_.toml.wrong(node, kind, fmt::format("tables, [[{}]]", kind));
      for (const Node& entry : *array) {
        m_.place(read_.toml.place(entry) + ": ");
        each(*entry.as_table());
      }
    });
  }
  void add_fields(const std::vector<Field>& fields, Parameters& to, FileValues::Keys& keys);
  void coupling(const toml::table& table);
  void wall(const toml::table& table);
  void prescribed(const toml::table& table);
  void motor(const toml::table& table);
  void brake(const toml::table& table);
  void no_range(const toml::table& table);
  static bool is_input(const toml::table& table, std::initializer_list<const char*> keys);
  /// take(name, value) for each number of a table that may hold tables, steer.angle = 0.1.
  template <class Take>
  void numbers(const toml::table& table, const Take& take, const std::string& front = "");

  FileValues& read_;
  const toml::table& table_;
  bool is_held(const std::string& number) const;
  Mechanism& m_;
  const std::vector<std::string>& held_;
};

}  // namespace hamel::mechanisms
