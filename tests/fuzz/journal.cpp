// Fuzz target: the lines of a study's journal, and what is made of them. Input that begins with '!'
// is given the checksums that it lacks, so that what follows them is reached.
#include <sstream>

#include <hamel/framework/batch/journal_file.hpp>
#include <hamel/framework/study/journal.hpp>
#include <hamel/framework/study/parts.hpp>

#include "registry.hpp"

namespace {

using namespace hamel;

StudyConfig two_systems() {
  StudyConfig config;
  config.until = 1;
  config.repeats = 2;
  config.systems = {{.label = "body", .name = "suslov"}, {.label = "disk", .name = "rolling_disk"}};
  config.axes["retraction"] = {"exp"};
  config.axes["step"] = {0.5, 0.25};
  return config;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const StudyConfig config = two_systems();
  static const StudyCells cells = study_cells(config, fuzz::registry());
  static const std::vector<study::Shape> shapes = study::shapes(fuzz::registry(), config);
  static const std::vector<std::vector<bool>> angles = {std::vector<bool>(9),
                                                        {true, false, false, true}};
  std::string text = fuzz::text_of(data, size);
  if (text.starts_with('!')) {
    std::istringstream in(text.substr(1));
    text.clear();
    for (std::string line; std::getline(in, line);) text += sealed(line) + "\n";
  }
  StudyResult result;
  result.config = config;
  result.cells = cells;
  result.metrics.resize(cells.size());
  for (StudyMetrics& m : result.metrics) m.nanoseconds.resize(2, study::kPending);
  result.references.resize(config.systems.size());
  std::istringstream lines(text);
  read_sealed(lines, "journal.jsonl",
              [&](const std::string& line) { study::take_line(line, shapes, result); });
  study::compare(config, cells, angles, result.references, result.metrics);
  fuzz::expect(result.table().rows() == cells.size(), "a row for each cell");
  return 0;
}
