// The page of an ensemble: what is kept over what is varied, distributions, statistics in time.
#pragma once

#include <map>
#include <vector>

#include <hamel/framework/ensemble/ensemble.hpp>

#include "pages/page.hpp"

namespace hamel::tools {

/// The members whose motion is on the page: those named in the file, else the first of each class,
/// or of all, that has not failed.
std::vector<long> members_in_motion(const EnsembleResult& result);

/// Page of all members, not of a shard. motions: the figures of some members, in a first section.
Page ensemble_page(const EnsembleResult& result, const std::map<long, Page>& motions);

}  // namespace hamel::tools
