#include <hamel/framework/io/output_file.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {

void finish_file(const std::string& part, const std::string& path) {
  const int file = open(part.c_str(), O_RDONLY | O_CLOEXEC);
  const bool on_disk = file >= 0 && fsync(file) == 0;
  const int reason = errno;
  if (file >= 0) close(file);
  if (on_disk && std::rename(part.c_str(), path.c_str()) == 0) return;
  throw Unfinished(fmt::format("output: cannot finish '{}': {}; what was written is in '{}'", path,
                               std::strerror(on_disk ? errno : reason), part));
}

void write_file(const std::string& path, const std::string& text) {
  const std::string part = part_of(path);
  std::ofstream out(part, std::ios::binary);
  out << text;
  out.close();
  if (!out || std::rename(part.c_str(), path.c_str()) != 0) {
    std::remove(part.c_str());
    throw ConfigError({fmt::format("output: cannot write '{}'", path)});
  }
}

std::string unwritable(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (path.empty()) return "output: an empty path";
  if (fs::is_directory(path, error)) return fmt::format("output: '{}' is a directory", path);
  const std::string part = part_of(path);
  const bool there = fs::exists(part, error);
  const bool opened = std::ofstream(part, std::ios::app).is_open();
  if (!there) fs::remove(part, error);
  return opened ? "" : fmt::format("output: cannot write '{}'", path);
}

}  // namespace hamel
