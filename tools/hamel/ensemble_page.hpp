// The page of an ensemble: what is kept over what is varied, distributions, statistics in time.
#pragma once

#include <hamel/framework/ensemble/ensemble.hpp>

#include "page.hpp"

namespace hamel::tools {

/// Of all members: not of a shard.
Page ensemble_page(const EnsembleResult& result);

}  // namespace hamel::tools
