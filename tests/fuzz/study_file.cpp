// Fuzz target: a study's file, read and checked, and its cells.
#include <hamel/framework/study/study.hpp>

#include "registry.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hamel;
  fuzz::accept_or_refuse([&] {
    const StudyConfig config =
        parse_study(fuzz::text_of(data, size), "fuzz.toml", fuzz::registry());
    fuzz::expect(!study_cells(config, fuzz::registry()).empty(), "cells in an accepted study");
  });
  return 0;
}
