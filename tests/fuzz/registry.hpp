// What the fuzz targets run on: a few groups and systems, all of it erased, so that little is
// compiled.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel::fuzz {

const Registry& registry();

inline std::string text_of(const uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A finding.
inline void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "expected: %s\n", what);
  std::abort();
}

/// Runs read(); a refusal must say what is wrong.
template <class Read>
void accept_or_refuse(const Read& read) {
  try {
    read();
  } catch (const ConfigError& error) {
    expect(!error.mistakes().empty(), "a refusal with a mistake");
    for (const std::string& mistake : error.mistakes())
      expect(!mistake.empty(), "a mistake in words");
  }
}

}  // namespace hamel::fuzz
