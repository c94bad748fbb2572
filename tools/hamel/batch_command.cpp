#include "batch_command.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <thread>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

#include "words/screen.hpp"

namespace hamel::tools {

using pages::report_page;
namespace {

long count_of(const char* name, const char* text) {
  const std::string_view all = text;
  long out = -1;
  const auto [end, error] = std::from_chars(all.data(), all.data() + all.size(), out);
  if (error != std::errc() || end != all.data() + all.size() || out < 0)
    throw ConfigError({fmt::format("{}: got '{}', expected a number of ranks", name, all)});
  return out;
}

struct Rank {
  long index = 0, count = 1;
};

// As Open MPI (OMPI_COMM_WORLD_*) or a launcher of PMI (MPICH, Intel, srun --mpi=pmi2) states it;
// none for one process.
std::optional<Rank> rank_of_launcher() {
  constexpr const char* kNames[][2] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                       {"PMI_RANK", "PMI_SIZE"}};
  for (const auto& [rank, size] : kNames) {
    const char *mine = std::getenv(rank), *all = std::getenv(size);
    if (mine == nullptr || all == nullptr) continue;
    const Rank out{count_of(rank, mine), count_of(size, all)};
    if (out.index >= out.count)
      throw ConfigError({fmt::format("{}: got {}, expected less than {} = {}", rank, out.index,
                                     size, out.count)});
    if (out.count > 1) return out;
  }
  return {};
}

}  // namespace

BatchCommand::BatchCommand(const PartOptions& options, const std::string& kind)
    : options_(options), kind_(kind), folder_(options.directory) {
  if (folder_.empty()) folder_ = std::filesystem::path(options.file).stem().string() + "-" + kind;
  const std::optional<Rank> rank = rank_of_launcher();
  if (!rank || options.merge || !options.shard.empty()) return;
  rank_ = rank->index;
  options_.shard = fmt::format("{}/{}", rank->index + 1, rank->count);
  if (options.threads == 0) options_.threads = 1;
  if (rank->index > 0) options_.quiet = true;
}

Shard BatchCommand::shard() const {
  Shard out;
  const std::string& text = options_.shard;
  int used = 0;
  if (std::sscanf(text.c_str(), "%ld/%ld%n", &out.index, &out.count, &used) != 2 ||
      static_cast<size_t>(used) != text.size())
    throw ConfigError({fmt::format("shard: got '{}', expected i/n, as 1/4", text)});
  return out;
}

int BatchCommand::interrupted(const std::string& finished) const {
  complain("hamel: interrupted: {} and kept in {}; the same command resumes there\n", finished,
           folder_);
  return 1;
}

int BatchCommand::show(const BatchResult& result, const BatchOutput& output) const {
  const bool part = result.shard.count > 1, page = !report_page().empty();
  if (!part) {
    output.write();
    if (page) output.page().write((std::filesystem::path(folder_) / "report.html").string());
    else complain("hamel: no report.html: this program was built without node and npm\n");
  }
  if (options_.json) {
    say("{}\n", output.record());
  } else if (!options_.quiet) {
    say("{}{}", output.summary(),
        part ? fmt::format("  kept in                {}/: --merge joins the {} shards when all are "
                           "there\n",
                           folder_, result.shard.count)
             : fmt::format("  written to             {}/: {}{}\n", folder_, output.files,
                           page ? ", report.html" : ""));
  }
  return 0;
}

int BatchCommand::merge_when_there(const std::function<int()>& merge) const {
  constexpr auto patience = std::chrono::minutes(10);
  const auto size_of_parts = [&] {
    std::uintmax_t out = 0;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored))
      if (entry.path().extension() == ".jsonl") out += entry.file_size(ignored);
    return out;
  };
  auto pause = std::chrono::milliseconds(50);
  const auto begun = std::chrono::steady_clock::now();
  auto grown = begun;
  bool noted = false;
  for (std::uintmax_t before = 0;;) {
    std::string lacks;
    try {
      return merge();
    } catch (const MissingParts& incomplete) {  // all else does not change by waiting
      lacks = incomplete.what();
    }
    const auto now = std::chrono::steady_clock::now();
    if (const std::uintmax_t size = size_of_parts(); size != before) {
      before = size;
      grown = now;
    }
    if (!noted && now - begun > std::chrono::seconds(2)) {
      complain("hamel: waiting for the other ranks: {}\n", lacks.substr(0, lacks.find('\n')));
      noted = true;
    }
    if (stop_when_asked() || now - grown > patience) {
      complain("hamel: {}\nhamel: the same command computes what is missing\n", lacks);
      return 1;
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::milliseconds(2000));
  }
}

}  // namespace hamel::tools
