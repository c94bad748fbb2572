#include <hamel/framework/io/module.hpp>

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include <hamel/framework/io/version.hpp>

namespace hamel {
namespace {

// Relative to that of the code: of a Python module (a folder that is no package: they are none that
// Python could import), of libhamel.so installed and in the build, of the program in both, of an
// installed Python module.
constexpr const char* kModuleFolders[] = {"modules", "hamel", HAMEL_LIBDIR "/hamel",
                                          "../" HAMEL_LIBDIR "/hamel",
                                          "../../../../" HAMEL_LIBDIR "/hamel"};

// The folder of the program or shared library that has this code.
std::filesystem::path folder_of_code() {
  Dl_info info = {};
  std::error_code error;
#ifdef __GLIBC__  // the program has no name there, and in info the one that it was called by
  void* map = nullptr;
  if (dladdr1(&kModuleFolders, &info, &map, RTLD_DL_LINKMAP) == 0) return {};
  const char* const file = static_cast<const link_map*>(map)->l_name;
#else
  if (dladdr(&kModuleFolders, &info) == 0) return {};
  const char* const file = info.dli_fname;
#endif
  return std::filesystem::canonical(*file == '\0' ? "/proc/self/exe" : file, error).parent_path();
}

}  // namespace

std::string module_path(const std::string& name) {
  static const std::filesystem::path folder = folder_of_code();
  if (folder.empty()) return "";
  for (const char* const relative : kModuleFolders) {
    std::error_code error;
    const std::filesystem::path file = folder / relative / ("hamel_" + name + ".so");
    if (std::filesystem::exists(file, error)) return file.lexically_normal();
  }
  return "";
}

Module open_module(const std::string& name) {
  const std::string path = module_path(name);
  if (path.empty()) return {nullptr, fmt::format("there is no hamel_{}.so", name)};
  const auto reason = [] {
    const char* const text = dlerror();
    return std::string(text == nullptr ? "" : text);
  };
  void* const library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) return {nullptr, reason()};
  std::string entry = fmt::format("hamel_{}_{}", name, version());
  std::ranges::replace(entry, '.', '_');
  void* const function = dlsym(library, entry.c_str());
  return {function, function == nullptr ? reason() : ""};
}

}  // namespace hamel
