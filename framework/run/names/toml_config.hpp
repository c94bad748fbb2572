// The keys of a run's configuration in a TOML file, which files of more than one run have too. Not
// installed.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/framework/run/names/config.hpp>

namespace hamel {

/// "system", "set", "inputs" and the options of a run.
std::vector<std::string> config_keys();
/// Takes in the node where its key is one of these; false where it is another.
bool read_config_key(TomlReader& read, const std::string& key, const toml::node& node,
                     Config& config);

/// Is it the file of an ensemble?
inline bool is_ensemble(const toml::table& file) {
  return file.contains("vary") || file.contains("keep");
}

}  // namespace hamel
