#include "words/screen.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include <hamel/framework/io/output_file.hpp>

namespace hamel::tools {
namespace {

[[noreturn]] void refuse() {
  throw Unfinished(
      fmt::format("output: cannot write to standard output: {}", std::strerror(errno)));
}

}  // namespace

void begin_screen() {
  // (Open for reading: a write to it fails, as one to the closed descriptor did.)
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF)
      static_cast<void>(open("/dev/null", O_RDONLY));
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void write_screen(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) refuse();
}

void finish_screen() {
  if (std::fflush(stdout) != 0) refuse();
}

void write_message(std::string_view text) {
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
  static_cast<void>(std::fflush(stderr));
}

}  // namespace hamel::tools
