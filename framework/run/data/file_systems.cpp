// Systems of files: by data, of a kind of its own, or converted from the format of another program.
#include <algorithm>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/names/toml_config.hpp>

namespace hamel {

std::function<SystemModel(const Parameters&)> data_system_maker(const Registry& registry,
                                                                const std::string& path) {
  return [&registry, path](const Parameters& given) {
    return data_system_maker(registry, path, read_system_file(path))(given);
  };
}

namespace {

// Refuses options that are not among those known.
void check_options(const std::string& path, const NameOptions& options,
                   const std::vector<std::string>& known) {
  for (const auto& [name, values] : options) {
    if (std::ranges::find(known, name) != known.end()) continue;
    if (known.empty())
      throw ConfigError({fmt::format(
          "{}: {} is an option of mechanisms, and this file is a system by data", path, name)});
    throw ConfigError({unknown_name("option of " + path, name, known)});
  }
}

SystemModel read_toml(const Registry& registry, const std::string& path, const std::string& text,
                      const Parameters& given, const NameOptions& options) {
  const toml::table table = TomlReader(path).parse(text);
  for (const FileKind& kind : registry.file_kinds()) {
    const bool its_own =
        std::ranges::any_of(kind.keys, [&](const auto& key) { return table.contains(key); });
    if (!its_own) continue;
    check_options(path, options, kind.options);
    return kind.read(text, path, given, options);
  }
  check_options(path, options, {});
  return data_system(registry, text, path, given);
}

// The options that are those of TOML files, not of the format that becomes one.
NameOptions options_of_toml(const Registry& registry, const NameOptions& all) {
  NameOptions out;
  for (const FileKind& kind : registry.file_kinds())
    for (const std::string& option : kind.options)
      if (const auto it = all.find(option); it != all.end()) out.insert(*it);
  return out;
}

const FileFormat* format_of(const Registry& registry, const std::string& system) {
  const std::string extension = extension_of_system(system);
  for (const FileFormat& format : registry.file_formats())
    if (format.extension == extension) return &format;
  return nullptr;
}

}  // namespace

FileFormat::Converted converted(const Registry& registry, const std::string& system,
                                const std::string& text) {
  const FileFormat* format = format_of(registry, system);
  if (format == nullptr) return {text};
  const std::string path = path_of_system(system);
  if (!format->convert)
    throw ConfigError(
        {fmt::format("{}: this build reads no {} files: install {} and build it "
                     "again",
                     path, format->extension, format->package)});
  NameOptions options = options_of_system(system);
  const NameOptions of_toml = options_of_toml(registry, options);
  std::vector<std::string> known = format->options;
  for (const FileKind& kind : registry.file_kinds())
    known.insert(known.end(), kind.options.begin(), kind.options.end());
  check_options(path, options, known);
  for (const auto& [name, values] : of_toml) options.erase(name);
  return format->convert(text, path, options);
}

std::function<SystemModel(const Parameters&)> data_system_maker(const Registry& registry,
                                                                const std::string& path,
                                                                const std::string& text) {
  return [&registry, path, text](const Parameters& given) {
    const NameOptions options = options_of_system(path);
    const std::string own = path_of_system(path);
    if (format_of(registry, path) == nullptr) return read_toml(registry, own, text, given, options);
    const auto [toml, notes] = converted(registry, path, text);
    SystemModel out =
        read_toml(registry, converted_origin(own), toml, given, options_of_toml(registry, options));
    out.notes.insert(out.notes.end(), notes.begin(), notes.end());
    return out;
  };
}

}  // namespace hamel
