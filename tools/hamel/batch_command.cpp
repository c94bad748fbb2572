#include "batch_command.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "screen.hpp"

namespace hamel::tools {

BatchCommand::BatchCommand(const PartOptions& options, const std::string& kind)
    : options_(options), kind_(kind), folder_(options.directory) {
  if (folder_.empty()) folder_ = std::filesystem::path(options.file).stem().string() + "-" + kind;
  rank_ = take_part_as_rank(options_);
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

}  // namespace hamel::tools
