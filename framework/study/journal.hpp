// The lines of a study's journal (batch/journal_file.hpp): a line for each reference, cell and
// timing. Not installed.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/study/study.hpp>

namespace hamel::study {

/// The numbers of what is kept for one system: common times, columns of its element, dimension.
struct Shape {
  size_t times = 0, columns = 0, dim = 0;
};
std::vector<Shape> shapes(const Registry& registry, const StudyConfig& config);

std::string line_of(size_t system, const StudyReference& reference);
std::string line_of(size_t cell, const StudyMetrics& metrics);
std::string line_of(size_t cell, size_t round, double nanoseconds);

/// Fills in what a line holds. An exception where it does not fit: no JSON object, an index or a
/// length that is none of the study's (shapes: one for each system).
void take_line(const std::string& line, const std::vector<Shape>& shapes, StudyResult& result);

/// Is all of this cell there: its reference, its metrics and its times?
bool finished_cell(const StudyResult& result, size_t cell);

}  // namespace hamel::study
