// Fuzz target: a robot in URDF, converted to the TOML of a mechanism, which is read and run for two
// steps. A first line that begins with '?' has the options: ?wheel=left,right&root=free.
#include <algorithm>

#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/framework/run/names/system_file.hpp>
#include <hamel/systems/mechanisms/urdf/urdf.hpp>

#include "mechanism_run.hpp"

namespace {

using namespace hamel;

bool is_toml(const std::string& text) {
  try {
    TomlReader("fuzz.toml").parse(text);
  } catch (const ConfigError&) {
    return false;
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const FileFormat urdf = urdf_formats().front();
  fuzz::accept_or_refuse([&] {
    std::string text = fuzz::text_of(data, size);
    NameOptions options;
    if (text.starts_with('?')) {
      const size_t end = std::min(text.find('\n'), text.size());
      options = options_of_system("fuzz.urdf" + text.substr(0, end));
      text.erase(0, end);
    }
    const std::string toml = urdf.convert(text, "fuzz.urdf", options).toml;
    fuzz::expect(is_toml(toml), "a robot that is read as TOML");
    fuzz::run_mechanism(toml);
  });
  return 0;
}
