// Numbers below the normal range, flushed to zero for a while: a velocity that decays for ever
// would else slow every operation on it twenty times. Nothing of the size of a round-off changes.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace hamel {

/// From its construction to its destruction; the mode before comes back.
class FlushDenormals {
 public:
#if defined(__SSE2__)
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040); }  // FTZ and DAZ
  ~FlushDenormals() { _mm_setcsr(before_); }
#else
  FlushDenormals() = default;
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
#if defined(__SSE2__)
  unsigned before_;
#endif
};

}  // namespace hamel
