// The page of an ensemble: what is kept over what is varied, distributions, statistics in time.
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/pages/page.hpp>
#include <hamel/framework/run/record/result.hpp>

namespace hamel::pages {

/// The member as a run, with the rows of a page; none where it does not start. output: the file of
/// its rows. Throws Unfinished where *stop becomes true.
std::optional<Result> run_of(const Ensemble& ensemble, const Member& member,
                             const std::atomic<bool>* stop = nullptr,
                             const std::string& output = "");

/// Page of all members, not of a shard. Those named in the file, else the first of each class, or
/// of all, that has not failed, are run again: the page has their motion.
Page ensemble_page(const Registry& registry, const EnsembleResult& result,
                   const std::atomic<bool>* stop = nullptr);

}  // namespace hamel::pages
