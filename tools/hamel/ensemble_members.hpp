// The members of an ensemble on its page: those that are drawn, what a click on one of them shows,
// and what is kept of them in pairs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <hamel/framework/ensemble/ensemble.hpp>

#include "page.hpp"

namespace hamel::tools {

/// A column of numbers, by member.
const std::vector<double>& numbers_of(const EnsembleResult& result, const std::string& name);

std::vector<bool> failed_members(const EnsembleResult& result);

/// Each stride-th member is drawn as a dot; on a grid it shares no factor with the lists, so that
/// it does not miss most of their values.
size_t stride_of_dots(const EnsembleResult& result);

/// "Each 25th member."; "" where all are shown.
std::string sampled(size_t stride);

/// The members whose motion is on the page: those named in the file, else the first of each class,
/// or of all, that has not failed.
std::vector<long> members_in_motion(const EnsembleResult& result);

/// The values, command lines and motions of members, by their number.
void add_members(Page& page, const EnsembleResult& result, const std::map<long, Page>& motions);

/// A dot for each member in each pair of what is kept, with the correlations; nothing where fewer
/// than two columns vary.
void add_scatter_matrix(Page& page, const EnsembleResult& result);

}  // namespace hamel::tools
