// Memory with machine code. Not installed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hamel::graph {

/// Pages that are readable and executable, and never writable: the bytes are written to an
/// anonymous file (memfd_create), which is then mapped. Null where the system refuses one of these.
class ExecutableMemory {
 public:
  explicit ExecutableMemory(const std::vector<std::uint8_t>& bytes);
  ~ExecutableMemory();
  ExecutableMemory(const ExecutableMemory&) = delete;
  ExecutableMemory& operator=(const ExecutableMemory&) = delete;

  const std::uint8_t* data() const { return data_; }

 private:
  const std::uint8_t* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace hamel::graph
