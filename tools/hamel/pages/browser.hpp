// Headless Chromium, which draws what a file of a figure holds.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hamel::tools {

/// The program: $CHROMIUM, else the first of chromium, chromium-browser, google-chrome on the PATH;
/// empty where there is none.
std::string browser();

/// A temporary folder, gone with this object. Unfinished where none can be made.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  /// The path of a file in it.
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

/// The bytes of a file.
std::string contents_of(const std::string& path);

/// Loads the file page.html of the folder with these options -> what the browser wrote on standard
/// output. Unfinished where it fails, or has not ended within two minutes.
std::string browse(const Scratch& folder, const std::vector<std::string>& options);

}  // namespace hamel::tools
