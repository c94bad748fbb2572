// Fuzz target: a mechanism by parts, read, assembled, and run for two steps.
#include "mechanism_run.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hamel;
  fuzz::accept_or_refuse([&] { fuzz::run_mechanism(fuzz::text_of(data, size)); });
  return 0;
}
