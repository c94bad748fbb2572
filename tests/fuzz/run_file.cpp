// Fuzz target: a finished and an unfinished .h5 of a run with changed bytes. Each three bytes of
// the input are a place and the byte that is written there. A file that is accepted has the
// configuration and, if finished, the rows that were written.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <hamel/framework/run/record/run_file.hpp>
#include <hamel/framework/run/run/simulation.hpp>

#include "registry.hpp"

namespace {

using namespace hamel;

constexpr size_t kMostRows = 1000;
const std::string kFolder = "/dev/shm/hamel_fuzz_" + std::to_string(getpid());

struct Original {
  std::string bytes, path, config;
  std::vector<double> rows;
};

std::string contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
// Of an unfinished file none: a damaged checkpoint is left for the one before it.
std::vector<double> rows_of(const RunFile& file) {
  if (!file.finished()) return file.kept(), std::vector<double>();
  const Trajectory rows = read_rows(file, kMostRows);
  return {rows.values().begin(), rows.values().end()};
}

Original original(bool finished) {
  std::filesystem::create_directories(kFolder);
  const std::string path = kFolder + (finished ? "/whole.h5" : "/part.h5");
  Simulation simulation(fuzz::registry(), "suslov");
  simulation.scheme("lift").start({.velocity = {1, 0.5, 0}}).step(0.1).until(2).record_to(path);
  std::string found = path;
  if (finished) {
    simulation.run();
  } else {  // a copy of what a run that is not finished has written
    Run run = simulation.build();
    run.step(10);
    found = path + ".part";
    std::filesystem::copy(found, found + ".copy");
  }
  Original out{contents(finished ? found : found + ".copy"), found, "", {}};
  std::ofstream(found, std::ios::binary) << out.bytes;
  const RunFile file(path);
  out.config = file.config().to_toml();
  out.rows = rows_of(file);
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::vector<Original> originals = {original(true), original(false)};
  if (size < 4) return 0;
  const Original& from = originals[data[0] % 2];
  std::string bytes = from.bytes;
  for (size_t i = 1; i + 2 < size; i += 3)
    bytes[(data[i] * 256u + data[i + 1]) % bytes.size()] = static_cast<char>(data[i + 2]);
  std::ofstream(from.path, std::ios::binary) << bytes;
  fuzz::accept_or_refuse([&] {
    const RunFile file(from.path);
    fuzz::expect(file.config().to_toml() == from.config, "the configuration that was written");
    fuzz::expect(rows_of(file) == from.rows, "the rows that were written");
  });
  return 0;
}
