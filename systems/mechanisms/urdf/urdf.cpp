#include <hamel/systems/mechanisms/urdf/urdf.hpp>

#include <hamel/framework/run/names/robot_file.hpp>

#ifdef HAMEL_HAS_URDFDOM
#include <hamel/systems/mechanisms/urdf/urdf_mechanism.hpp>
#endif

namespace hamel {

std::vector<FileFormat> urdf_formats() {
  std::vector<FileFormat> out;
  for (const std::string& extension : robot_extensions()) {
    FileFormat format{extension,
                      {"joint-friction", "motor", "root", "weld", "weld-all-but", "wheel"},
                      "liburdfdom-dev"};
#ifdef HAMEL_HAS_URDFDOM
    format.convert = [](const std::string& text, const std::string& path,
                        const NameOptions& options) {
      return mechanisms::mechanism_of(mechanisms::read_robot(text, path), path, options);
    };
#endif
    out.push_back(std::move(format));
  }
  return out;
}

}  // namespace hamel
