#include "pages/browser.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include <hamel/framework/io/output_file.hpp>

#include "pages/programs.hpp"
#include "words/interrupt.hpp"

namespace hamel::tools {

std::string contents_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string browser() {
  return find_program("CHROMIUM", {"chromium", "chromium-browser", "google-chrome"});
}

Scratch::Scratch() {
  stop_when_asked();  // from now on it is removed
  std::error_code error;
  std::string pattern = std::filesystem::temp_directory_path(error) / "hamel-figure-XXXXXX";
  if (error || mkdtemp(pattern.data()) == nullptr)
    throw Unfinished(fmt::format("a figure needs a folder for its pieces: {}: {}", pattern,
                                 std::strerror(errno)));
  folder_ = pattern;
}

Scratch::~Scratch() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string browse(const Scratch& folder, const std::vector<std::string>& options) {
  const std::string out = folder.file("out");
  std::vector<std::string> words = {browser(),
                                    "--headless",
                                    "--disable-gpu",
                                    "--no-first-run",
                                    "--disable-background-networking",
                                    "--hide-scrollbars",
                                    "--user-data-dir=" + folder.file("profile")};
  if (geteuid() == 0) words.emplace_back("--no-sandbox");  // it has none for root
  words.insert(words.end(), options.begin(), options.end());
  words.push_back("file://" + folder.file("page.html"));
  run_program(words, out, "draw the figure");
  return contents_of(out);
}

}  // namespace hamel::tools
