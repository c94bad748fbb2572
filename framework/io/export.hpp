// HAMEL_API: what programs link that come in by name (<hamel/simulate.hpp>). It alone is visible in
// the shared library libhamel.so, of which all else is hidden.
#pragma once

#if defined(__GNUC__)
#define HAMEL_API __attribute__((visibility("default")))
#else
#define HAMEL_API
#endif
