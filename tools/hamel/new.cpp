// hamel new: a project outside the tree that compiles, runs and tests itself, made of the files in
// tools/new. `my_name` and `MyName` in these become the name and the type's.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/systems/by_name.hpp>

#include "commands.hpp"
#include "new_files.hpp"
#include "words/screen.hpp"

namespace hamel::tools {
namespace {

const std::vector<std::string> kProjectKinds = {"system", "group", "scheme", "project"};

// Names of targets that CMake has, and of members and types in the files of tools/new.
const std::vector<std::string> kTakenNames = {
    "all",      "clean",   "depend",        "edit_cache",  "element", "group",
    "help",     "hamel",   "install",       "node",        "package", "package_source",
    "particle", "problem", "rebuild_cache", "retractions", "step",    "test"};

// Small letters, digits, single underscores, a letter first; the name itself where it is so.
std::string valid_name(const std::string& given) {
  std::string out;
  char before = '_';
  for (const char c : given) {
    const bool plain = c > 0 && std::isalnum(c) != 0;
    const char next = plain ? static_cast<char>(std::tolower(c)) : '_';
    if (next != '_' || before != '_') out += next;
    before = next;
  }
  while (out.ends_with('_')) out.pop_back();
  if (out.empty() || std::isdigit(out.front()) != 0) out.insert(0, out.empty() ? "my_name" : "my_");
  return out;
}

// "my_sleigh" -> "MySleigh".
std::string type_name(const std::string& name) {
  std::string out;
  bool begins = true;
  for (const char c : name) {
    if (c != '_') out += begins ? static_cast<char>(std::toupper(c)) : c;
    begins = c == '_';
  }
  return out;
}

bool is_registered(const std::string& kind, const std::string& name) {
  const Registry& all = registry();
  return (kind == "system" && all.system(name) != nullptr) ||
         (kind == "group" && all.group(name) != nullptr) ||
         (kind == "scheme" && all.scheme(name) != nullptr);
}

// "" for a name that a project of this kind can have here.
std::string mistake_of_name(const std::string& kind, const std::string& name) {
  if (const std::string valid = valid_name(name); valid != name) {
    return fmt::format(
        "NAME: got '{}', expected small letters, digits and single underscores, a letter first: {}",
        name, valid);
  }
  if (std::find(kTakenNames.begin(), kTakenNames.end(), name) != kTakenNames.end()) {
    return fmt::format("NAME: '{0}' is taken by CMake or by the files of a project: my_{0}", name);
  }
  if (is_registered(kind, name))
    return fmt::format("NAME: '{0}' is a {1} of the library: my_{0}", name, kind);
  std::error_code error;
  if (std::filesystem::exists(std::filesystem::symlink_status(name, error)))
    return fmt::format("NAME: '{}' exists in this folder, and nothing is overwritten", name);
  return "";
}

using Tokens = std::map<std::string, std::string>;

// A text with each token replaced; values are not searched again.
std::string filled_in(std::string_view text, const Tokens& tokens) {
  std::string out;
  while (!text.empty()) {
    const auto token = std::find_if(tokens.begin(), tokens.end(),
                                    [&](const auto& t) { return text.starts_with(t.first); });
    if (token == tokens.end()) out += text.front();
    else out += token->second;
    text.remove_prefix(token == tokens.end() ? 1 : token->first.size());
  }
  return out;
}

Tokens tokens_of(const std::string& kind, const std::string& name) {
  const std::string release(version());
  return {{"my_name", name},
          {"MyName", type_name(name)},
          {"my_kind", kind == "project" ? "mechanism" : kind},
          {"my_source", name + (kind == "project" ? ".toml" : ".hpp")},
          {"hamel_version", release.substr(0, release.rfind('.'))},
          {"hamel_release", release}};
}

// The files under their paths in the project.
std::map<std::string, std::string> files_of(const std::string& kind, const std::string& name) {
  const Tokens tokens = tokens_of(kind, name);
  std::map<std::string, std::string> out;
  for (const auto& [of, path, text] : new_files)
    if (of == kind || of == std::string_view("common"))
      out[filled_in(path, tokens)] = filled_in(text, tokens);
  return out;
}

void write_files(const std::filesystem::path& folder,
                 const std::map<std::string, std::string>& files) {
  std::error_code error;
  if (!std::filesystem::create_directory(folder, error)) {
    throw ConfigError({fmt::format("NAME: cannot make the folder '{}': {}", folder.string(),
                                   error ? error.message() : "it exists")});
  }
  try {
    for (const auto& [path, text] : files) {
      std::filesystem::create_directories((folder / path).parent_path());
      write_file(folder / path, text);
    }
  } catch (...) {
    std::filesystem::remove_all(folder, error);
    throw;
  }
}

}  // namespace

int new_project(const NewOptions& options) {
  const std::string &kind = options.kind, &name = options.name;
  std::vector<std::string> mistakes;
  if (std::find(kProjectKinds.begin(), kProjectKinds.end(), kind) == kProjectKinds.end())
    mistakes.push_back(unknown_name("kind", kind, kProjectKinds));
  if (const std::string mistake = mistake_of_name(kind, name); !mistake.empty())
    mistakes.push_back(mistake);
  if (!mistakes.empty()) throw ConfigError(mistakes);
  const std::map<std::string, std::string> files = files_of(kind, name);
  write_files(name, files);
  for (const auto& [path, text] : files) say("{}/{}\n", name, path);
  say("\n  cd {0}\n  cmake -S . -B build && cmake --build build && ctest --test-dir build\n", name);
  return 0;
}

}  // namespace hamel::tools
