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

}  // namespace hamel
