// Course and output of `hamel study` and `hamel ensemble`: work in pieces that share a folder,
// whole or in parts. A rank of mpirun is a part; no library of MPI is needed, as ranks share a
// folder alone.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <hamel/framework/batch/batch.hpp>
#include <hamel/framework/batch/shards.hpp>
#include <hamel/framework/pages/page.hpp>

#include "commands.hpp"
#include "words/interrupt.hpp"

namespace hamel::tools {

using pages::Page;

/// Outputs of a result, each made when it is needed.
struct BatchOutput {
  std::string files;            // that write leaves: "cells.csv, record.json"
  std::function<void()> write;  // into the folder
  std::function<Page()> page;
  std::function<std::string()> record, summary;
};

class BatchCommand {
 public:
  /// kind: "study"; the folder is FILE's name with -study unless another one is given. The rank of
  /// a launcher becomes a shard, with one thread unless more are given, silent but for the first;
  /// not where a shard or a merge is requested. ConfigError where it is no rank.
  BatchCommand(const PartOptions& options, const std::string& kind);

  const PartOptions& options() const { return options_; }
  const std::string& folder() const { return folder_; }

  /// Runs or joins the work, and passes the whole result, or that of a shard, to finish, which
  /// returns the status of the program; one process at a time writes a whole one. Of a work that
  /// was interrupted, finished(result) is stated: "3 of 7 cells are measured".
  template <class Work, class Finish, class Finished>
  int run(Work& work, const Finish& finish, const Finished& finished) const {
    const auto merge = [&] {
      const MergeLock alone(folder_, stop_when_asked());
      return finish(work.merge());
    };
    work.threads(options_.threads).folder(folder_).fresh(options_.fresh).stop(&stop_when_asked());
    if (options_.merge) return merge();
    if (!options_.shard.empty()) work.shard(shard());
    std::optional<Progress> progress(std::in_place, kind_, options_.quiet);
    const auto result = work.progress([&](double fraction) { (*progress)(fraction); }).run();
    progress.reset();
    if (!result.complete) return interrupted(finished(result));
    if (rank_) return *rank_ > 0 ? 0 : merge_when_there(merge);
    if (result.shard.count > 1) return finish(result);
    const MergeLock alone(folder_, stop_when_asked());
    return finish(result);
  }

  /// Writes a whole result and its page, and prints the record or the summary.
  int show(const BatchResult& result, const BatchOutput& output) const;

 private:
  Shard shard() const;
  int interrupted(const std::string& finished) const;
  /// Calls merge, which throws MissingParts, until all parts are there. A rank that has died leaves
  /// none: where no part grows for ten minutes, that is stated.
  int merge_when_there(const std::function<int()>& merge) const;

  PartOptions options_;
  std::string kind_, folder_;
  std::optional<long> rank_;  // of several
};

}  // namespace hamel::tools
