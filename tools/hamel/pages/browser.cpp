#include "pages/browser.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include <hamel/framework/io/output_file.hpp>

#include "words/interrupt.hpp"

extern "C" char** environ;

namespace hamel::tools {
namespace {

constexpr auto kPatience = std::chrono::minutes(2);

bool runs(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
}

// Its status; -1 where it did not end in time, or the program is interrupted, which leaves nothing.
int wait_for(pid_t child) {
  const std::atomic<bool>& interrupted = stop_when_asked();
  const auto until = std::chrono::steady_clock::now() + kPatience;
  for (int status = 0;;) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return -1;
    if (interrupted || std::chrono::steady_clock::now() > until) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return -1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

}  // namespace

std::string contents_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string browser() {
  if (const char* given = std::getenv("CHROMIUM"); given != nullptr && *given != '\0')
    return runs(given) ? given : "";
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
      if (const auto file = std::filesystem::path(folder) / name; runs(file)) return file;
  }
  return "";
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
  const std::string program = browser(), out = folder.file("out");
  std::vector<std::string> words = {program,
                                    "--headless",
                                    "--disable-gpu",
                                    "--no-first-run",
                                    "--disable-background-networking",
                                    "--hide-scrollbars",
                                    "--user-data-dir=" + folder.file("profile")};
  if (geteuid() == 0) words.emplace_back("--no-sandbox");  // it has none for root
  words.insert(words.end(), options.begin(), options.end());
  words.push_back("file://" + folder.file("page.html"));
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t ignored_here;
  sigemptyset(&ignored_here);
  sigaddset(&ignored_here, SIGPIPE);
  sigaddset(&ignored_here, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &ignored_here);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  pid_t child = 0;
  const int failed =
      posix_spawn(&child, program.c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (failed != 0)
    throw Unfinished(fmt::format("cannot start {}: {}", program, std::strerror(failed)));
  const int status = wait_for(child);
  if (stop_when_asked()) throw Unfinished("interrupted");
  if (status == -1)
    throw Unfinished(
        fmt::format("{} did not draw the figure within {} minutes", program, kPatience.count()));
  if (status != 0) throw Unfinished(fmt::format("{} failed to draw the figure", program));
  return contents_of(out);
}

}  // namespace hamel::tools
