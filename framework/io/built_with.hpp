// The containers that the library was compiled with: a program with others does not link, and the
// symbol names the reason.
#pragma once

#include <hamel/framework/io/export.hpp>

#ifdef _GLIBCXX_DEBUG
#define HAMEL_CONTAINERS_ARE hamel_was_built_with_GLIBCXX_DEBUG
#else
#define HAMEL_CONTAINERS_ARE hamel_was_built_without_GLIBCXX_DEBUG
#endif
extern "C" HAMEL_API const int HAMEL_CONTAINERS_ARE;
namespace hamel {
[[gnu::used]] static const int* const containers_are = &HAMEL_CONTAINERS_ARE;
}
