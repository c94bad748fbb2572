// Course and output of `hamel study` and `hamel ensemble`: work in pieces that share a folder.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <hamel/framework/batch/batch.hpp>
#include <hamel/framework/batch/shards.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
#include "page.hpp"
#include "ranks.hpp"

namespace hamel::tools {

/// Outputs of a result, each made when it is needed.
struct BatchOutput {
  std::string files;            // that write leaves: "cells.csv, record.json"
  std::function<void()> write;  // into the folder
  std::function<Page()> page;
  std::function<std::string()> record, summary;
};

class BatchCommand {
 public:
  /// kind: "study"; the folder is FILE's name with -study unless another one is given. ConfigError
  /// where the launcher's variables are no rank.
  BatchCommand(const PartOptions& options, const std::string& kind);

  const PartOptions& options() const { return options_; }
  const std::string& folder() const { return folder_; }

  /// Runs or joins the work, and passes the whole result, or that of a shard, to finish, which
  /// returns the status of the program; one process at a time writes a whole one. Of a work that
  /// was interrupted, finished(result) is stated: "3 of 7 cells are measured".
  template <class Work, class Finish, class Finished>
  int run(Work& work, const Finish& finish, const Finished& finished) const {
    const auto alone = [&](const auto& result_of) {
      const MergeLock lock(folder_, stop_when_asked());
      return finish(result_of());
    };
    const auto merge = [&] { return alone([&] { return work.merge(); }); };
    work.threads(options_.threads).folder(folder_).fresh(options_.fresh).stop(&stop_when_asked());
    if (options_.merge) return merge();
    if (!options_.shard.empty()) work.shard(shard_of(options_.shard));
    const auto result = [&] {
      Progress progress(kind_, options_.quiet);
      const auto out = work.progress([&](double fraction) { progress(fraction); }).run();
      work.progress({});
      return out;
    }();
    if (!result.complete) return interrupted(finished(result));
    if (rank_) return rank_->index > 0 ? 0 : merge_when_there(folder_, merge);
    return result.shard.count > 1 ? finish(result) : alone([&]() -> auto& { return result; });
  }

  /// Writes a whole result and its page, and prints the record or the summary.
  int show(const BatchResult& result, const BatchOutput& output) const;

 private:
  int interrupted(const std::string& finished) const;

  PartOptions options_;
  std::string kind_, folder_;
  std::optional<Rank> rank_;
};

}  // namespace hamel::tools
