// Upright straight ahead: the starts of falling_disk and segway for a run with `speed`.
#pragma once

namespace hamel {

/// For start_at_speed (framework/run/run/at_speed.hpp).
void add_starts_at_speed();

}  // namespace hamel
