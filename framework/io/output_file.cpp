#include <hamel/framework/io/output_file.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {

std::string place_of(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path whole = fs::absolute(path, error);
  const fs::path folder = fs::weakly_canonical(whole.parent_path(), error);
  return error ? path : (folder / whole.filename()).string();
}

void finish_file(const std::string& part, const std::string& path) {
  const int file = open(part.c_str(), O_RDONLY | O_CLOEXEC);
  const bool on_disk = file >= 0 && fsync(file) == 0;
  const int reason = errno;
  if (file >= 0) close(file);
  if (on_disk && std::rename(part.c_str(), path.c_str()) == 0) return;
  throw Unfinished(fmt::format("output: cannot finish '{}': {}; what was written is in '{}'", path,
                               std::strerror(on_disk ? errno : reason), part));
}

// (Of the open file, not of the process, and apart from those by which HDF5 keeps readers away from
// a file.)
static struct flock whole_file() {
  struct flock out = {};
  out.l_type = F_WRLCK;
  out.l_whence = SEEK_SET;
  return out;
}

// Is the open file still the one of that name? Who had it may have finished it in the meantime.
static bool same_file(int file, const std::string& path) {
  struct stat here = {}, there = {};
  return fstat(file, &here) == 0 && stat(path.c_str(), &there) == 0 && here.st_ino == there.st_ino;
}

FileLock::FileLock(const std::string& path) {
  for (;;) {
    file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    struct flock all = whole_file();
    if (file_ < 0) return;  // unwritable: reported by the writer
    const bool got = fcntl(file_, F_OFD_SETLK, &all) == 0;
    const bool held = !got && (errno == EAGAIN || errno == EACCES);
    if (!held && (!got || same_file(file_, path))) return;  // (or a file system without locks)
    close(file_);
    if (held) throw ConfigError({fmt::format("output: another process is writing '{}'", path)});
  }
}

FileLock::~FileLock() {
  if (file_ >= 0) close(file_);
}

bool locked(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  struct flock all = whole_file();
  const bool out = fcntl(file, F_OFD_GETLK, &all) == 0 && all.l_type != F_UNLCK;
  close(file);
  return out;
}

void write_file(const std::string& path, const std::string& text) {
  const std::string part = part_of(path);
  std::ofstream out(part, std::ios::binary);
  out << text;
  out.close();
  if (!out || std::rename(part.c_str(), path.c_str()) != 0) {
    const int reason = errno;
    std::remove(part.c_str());
    throw Unfinished(fmt::format("output: cannot write '{}': {}", path, std::strerror(reason)));
  }
}

// Queries, does not try: a file made for a moment stays there when the program is killed at that
// moment.
std::string unwritable(const std::string& path) {
  namespace fs = std::filesystem;
  if (path.empty()) return "output: an empty path";
  const auto no = [&](const char* reason) {
    return fmt::format("output: cannot write '{}': {}", path, reason);
  };
  std::error_code error;
  const std::string part = part_of(path);
  for (const std::string& file : {path, part})
    if (fs::is_directory(file, error)) return fmt::format("output: '{}' is a directory", file);
  const fs::path parent = fs::path(path).parent_path(), folder = parent.empty() ? "." : parent;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    return no(std::strerror(ENOTDIR));
  if (access(folder.c_str(), W_OK | X_OK) != 0) return no(std::strerror(errno));
  if (fs::exists(part, error) && access(part.c_str(), W_OK) != 0) return no(std::strerror(errno));
  return "";
}

}  // namespace hamel
