// Ctrl-C and SIGTERM: the first ends tidily, a second one at once.
#pragma once

#include <atomic>

namespace hamel::tools {

/// From now on they only set the flag that it returns.
const std::atomic<bool>& stop_when_asked();

}  // namespace hamel::tools
