#include <hamel/framework/io/text_file.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {

std::string read_text_file(const std::string& what, const std::string& path) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& why) {
    throw ConfigError({fmt::format("{}: cannot read '{}': {}", what, path, why)});
  };
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) refuse("there is no such file");
  if (!fs::is_regular_file(status)) refuse("it is no regular file");
  if (const auto size = fs::file_size(path, error); !error && size > kMaxText)
    refuse(fmt::format("it has {} characters, more than {}", size, kMaxText));
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) refuse("it cannot be opened");
  return text.str();
}

}  // namespace hamel
