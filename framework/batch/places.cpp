#include <hamel/framework/batch/places.hpp>

#include <fmt/format.h>

namespace hamel {

std::string placed(const std::map<std::string, std::string>& where, std::string key,
                   const std::string& mistake) {
  auto place = where.find(key);
  while (place == where.end() && key.find_last_of(".[") != std::string::npos) {
    key.resize(key.find_last_of(".["));
    place = where.find(key);
  }
  return place == where.end() ? mistake : fmt::format("{}: {}", place->second, mistake);
}

std::string no_journal(const std::string& folder, const std::string& system) {
  return fmt::format(
      "folder: got '{}', but a journal cannot have '{}', a system of this program: expected none, "
      "or a registered system, a file or its text",
      folder, system);
}

}  // namespace hamel
