#include "pages/programs.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>

#include "words/interrupt.hpp"

extern "C" char** environ;

namespace hamel::tools {
namespace {

bool runs(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
}

// Its status; -1 where it did not end in time, or the program is interrupted, which leaves nothing.
int wait_for(pid_t child, std::chrono::minutes patience) {
  const std::atomic<bool>& interrupted = stop_when_asked();
  const auto until = std::chrono::steady_clock::now() + patience;
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

std::string find_program(const char* variable, std::initializer_list<const char*> names) {
  if (const char* given = std::getenv(variable); given != nullptr && *given != '\0')
    return runs(given) ? given : "";
  const char* path = std::getenv("PATH");
  for (const char* name : names) {
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
      if (const auto file = std::filesystem::path(folder) / name; runs(file)) return file;
  }
  return "";
}

void run_program(const std::vector<std::string>& words, const std::string& out,
                 const std::string& purpose, int minutes) {
  std::vector<std::string> kept = words;
  std::vector<char*> arguments;
  for (std::string& word : kept) arguments.push_back(word.data());
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
      posix_spawn(&child, arguments[0], &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (failed != 0)
    throw Unfinished(fmt::format("cannot start {}: {}", words[0], std::strerror(failed)));
  const int status = wait_for(child, std::chrono::minutes(minutes));
  if (stop_when_asked()) throw Unfinished("interrupted");
  if (status == -1)
    throw Unfinished(fmt::format("{} did not {} within {} minutes", words[0], purpose, minutes));
  if (status != 0) throw Unfinished(fmt::format("{} failed to {}", words[0], purpose));
}

}  // namespace hamel::tools
