// hamel live: the playground in one file, with a system in it, opened in a browser.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/names/system_file.hpp>
#include <hamel/systems/by_name.hpp>

#include "commands.hpp"
#include "pages/browser.hpp"
#include "pages/programs.hpp"
#include "words/interrupt.hpp"
#include "words/screen.hpp"

extern "C" char** environ;

namespace hamel::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = "<!--LIVE-->";

// The playground where it was built beside this program, or installed with it.
fs::path playground_file() {
  if (const char* given = std::getenv("HAMEL_PLAYGROUND"); given != nullptr && *given != '\0')
    return given;
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place : {"../playground/site/playground.html", "../share/hamel/playground.html"})
    if (const fs::path file = folder / place; fs::is_regular_file(file, error))
      return file.lexically_normal();
  return {};
}

std::string playground() {
  const fs::path file = playground_file();
  std::error_code error;
  if (file.empty() || !fs::is_regular_file(file, error))
    throw ConfigError({fmt::format(
        "live: the playground {}; tools/setup --playground and cmake --build build --target "
        "hamel_playground make build/playground/site/playground.html, which this program then "
        "finds, or set HAMEL_PLAYGROUND to it",
        file.empty() ? "was not built here" : fmt::format("'{}' is no file", file.string()))});
  std::string page = contents_of(file.string());
  if (page.find(kMark) == std::string::npos)
    throw ConfigError({fmt::format("live: '{}' is no playground of this version: it has no {}",
                                   file.string(), kMark)});
  return page;
}

// Content of the page: the name of a system, or the text of a file.
nlohmann::json content_of(const std::string& system) {
  if (registry().system(system) != nullptr) return {{"system", system}};
  if (!names_file(system))
    throw ConfigError({unknown_name("system", system, registry().systems_and_files())});
  if (fs::path(system).extension() != ".toml")
    throw ConfigError(
        {fmt::format("live: got '{}', expected a .toml file; of a robot, hamel describe --toml {} "
                     "writes one",
                     system, system)});
  return {{"text", read_system_file(system)}};
}

// Options, parameters and inputs, which are sliders of the page and go before its text.
void add_run(const LiveOptions& options, nlohmann::json& content) {
  if (!options.given.empty()) content["options"] = options.given;
  const Config& config = options.config;
  if (!config.parameters.empty()) content["parameters"] = config.parameters;
  for (const auto& [name, signal] : config.inputs) {
    if (!std::holds_alternative<double>(signal))
      throw ConfigError(
          {fmt::format("--input: {}: got '{}', expected a number: the playground "
                       "reads no tables",
                       name, text_of(signal))});
    content["inputs"][name] = std::get<double>(signal);
  }
}

std::vector<std::string> mistakes_of(const Config& config) {
  try {
    Simulation simulation(registry(), config.system);
    simulation.config(config);
    return simulation.mistakes();
  } catch (const ConfigError& error) {
    return error.mistakes();
  }
}

// Mistakes of what the line gives; the page shows those of the file, at their lines.
std::vector<std::string> mistakes_of_run(const LiveOptions& options) {
  const Config& config = options.config;
  if (options.given.empty() && config.parameters.empty() && config.inputs.empty()) return {};
  Config plain;
  plain.system = options.system;
  return mistakes_of(plain).empty() ? mistakes_of(config) : std::vector<std::string>();
}

std::string filled(std::string page, const nlohmann::json& content) {
  std::string text;
  for (const char c : content.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
    text += c == '<' ? "\\u003c" : std::string(1, c);
  return page.replace(
      page.find(kMark), kMark.size(),
      fmt::format("<script type=\"application/json\" id=\"live\">{}</script>", text));
}

// Where a desktop is; true where a browser was started.
bool open_in_browser(const std::string& address) {
  const bool desktop =
      std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  std::string program = desktop ? find_program("BROWSER", {"xdg-open", "firefox", "chromium"}) : "",
              word = address;
  if (program.empty()) return false;
  std::array<char*, 3> arguments = {program.data(), word.data(), nullptr};
  pid_t child = 0;
  return posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ) == 0;
}

struct Socket {
  int number;
  explicit Socket(int of) : number(of) {}
  ~Socket() {
    if (number >= 0) close(number);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
};

void send_all(int to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t sent = send(to, text.data(), text.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;  // the browser has gone
    text.remove_prefix(static_cast<size_t>(sent));
  }
}

void answer(int to, const std::string& page) {
  std::array<char, 4096> buffer{};
  const ssize_t got = recv(to, buffer.data(), buffer.size(), 0);
  const std::string_view request(buffer.data(), static_cast<size_t>(std::max<ssize_t>(got, 0)));
  const bool known = request.starts_with("GET / ") || request.starts_with("GET /?");
  send_all(to, fmt::format("HTTP/1.1 {}\r\nContent-Type: text/html; charset=utf-8\r\n"
                           "Content-Length: {}\r\nConnection: close\r\n\r\n",
                           known ? "200 OK" : "404 Not Found", known ? page.size() : 0));
  if (known) send_all(to, page);
}

// This machine alone reaches it. Until Ctrl-C.
int serve(const std::string& page, long port, bool open) {
  const Socket socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int yes = 1;
  setsockopt(socket.number, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<uint16_t>(port));
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  auto* const address = reinterpret_cast<sockaddr*>(&at);
  if (socket.number < 0 || bind(socket.number, address, size) != 0 ||
      listen(socket.number, 8) != 0 || getsockname(socket.number, address, &size) != 0)
    throw Unfinished(fmt::format("live: port {}: {}", port, std::strerror(errno)));
  const std::string link = fmt::format("http://localhost:{}/", ntohs(at.sin_port));
  say("{}   (Ctrl-C ends it)\n", link);
  std::fflush(stdout);
  if (open) open_in_browser(link);
  const std::atomic<bool>& stopped = stop_when_asked();
  while (!stopped) {
    pollfd waiting{socket.number, POLLIN, 0};
    if (poll(&waiting, 1, 100) <= 0) continue;
    const Socket one(accept(socket.number, nullptr, nullptr));
    if (one.number < 0) continue;
    const timeval patience{5, 0};
    setsockopt(one.number, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(one.number, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    answer(one.number, page);
  }
  return 0;
}

std::string usual_file(const std::string& system) {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  return (folder / (fs::path(system).stem().string() + "-live.html")).string();
}

}  // namespace

int live(const LiveOptions& options) {
  std::vector<std::string> mistakes;
  constexpr long most = 65535;
  if (options.port && (*options.port < 0 || *options.port > most))
    mistakes.push_back(
        fmt::format("--port: got {}, expected a number from 0 to {}", *options.port, most));
  if (!options.output.empty()) {
    if (fs::path(options.output).extension() != ".html")
      mistakes.push_back(fmt::format("-o: got '{}', expected a .html file", options.output));
    else if (const std::string reason = unwritable(options.output); !reason.empty())
      mistakes.push_back(reason);
  }
  nlohmann::json content;
  try {
    content = content_of(options.system);
    add_run(options, content);
  } catch (const ConfigError& error) {
    mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
  }
  if (mistakes.empty()) mistakes = mistakes_of_run(options);
  if (!mistakes.empty()) throw ConfigError(mistakes);
  const std::string page = filled(playground(), content);
  if (options.port) {
    if (!options.output.empty()) write_file(options.output, page);
    return serve(page, *options.port, options.open);
  }
  const std::string path = options.output.empty() ? usual_file(options.system) : options.output;
  write_file(path, page);
  std::error_code error;
  const std::string link = "file://" + fs::absolute(path, error).string();
  const bool opened = options.open && open_in_browser(link);
  say("{}{}\n", link, opened ? "" : "   (open it in a browser)");
  return 0;
}

}  // namespace hamel::tools
