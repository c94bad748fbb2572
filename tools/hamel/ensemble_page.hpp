// The page of an ensemble: what is kept over what is varied, distributions, statistics in time.
#pragma once

#include <map>

#include <hamel/framework/ensemble/ensemble.hpp>

#include "page.hpp"

namespace hamel::tools {

/// Page of all members, not of a shard. motions: the figures of some members, in a first section.
Page ensemble_page(const EnsembleResult& result, const std::map<long, Page>& motions);

}  // namespace hamel::tools
