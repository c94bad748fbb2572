// Fuzz target: the record of a run, JSON, read into a result.
#include <hamel/framework/run/record/result.hpp>
#include <hamel/framework/run/record/run_file.hpp>

#include "registry.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hamel;
  fuzz::accept_or_refuse([&] {
    static const auto system =
        std::make_shared<const SystemModel>(fuzz::registry().system("suslov")->make({}));
    Result result;
    result.config.system = "suslov";
    result.system = system;  // that of the file's configuration, for whoever reads a record
    read_record(fuzz::text_of(data, size), "fuzz.json", result);
    result.report();
  });
  return 0;
}
