#include <hamel/framework/graph/executable_memory.hpp>

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace hamel::graph {

#ifdef __linux__

ExecutableMemory::ExecutableMemory(const std::vector<std::uint8_t>& bytes) : size_(bytes.size()) {
  const int file = memfd_create("hamel_code", MFD_CLOEXEC);
  if (file < 0) return;
  size_t written = 0;
  while (written < size_) {
    const ssize_t n = write(file, bytes.data() + written, size_ - written);
    if (n <= 0) break;
    written += static_cast<size_t>(n);
  }
  if (written == size_) {
    void* const pages = mmap(nullptr, size_, PROT_READ | PROT_EXEC, MAP_PRIVATE, file, 0);
    if (pages != MAP_FAILED) data_ = static_cast<const std::uint8_t*>(pages);
  }
  close(file);
}

ExecutableMemory::~ExecutableMemory() {
  if (data_) munmap(const_cast<std::uint8_t*>(data_), size_);
}

#else

ExecutableMemory::ExecutableMemory(const std::vector<std::uint8_t>&) {}
ExecutableMemory::~ExecutableMemory() = default;

#endif

}  // namespace hamel::graph
