// Studies and ensembles in parts: the rank of this process among those that mpirun has started, and
// the end of the parts. No library of MPI is needed, as ranks share a folder alone.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <hamel/framework/batch/shard.hpp>

#include "commands.hpp"

namespace hamel::tools {

struct Rank {
  long index = 0, count = 1;
};

/// "3/16". ConfigError.
Shard shard_of(const std::string& text);

/// The rank as Open MPI (OMPI_COMM_WORLD_*) or a launcher of PMI (MPICH, Intel, srun --mpi=pmi2)
/// states it, which becomes a shard, with one thread unless more are given, silent but for the
/// first; none for one process, and where a shard or a merge is requested. ConfigError where it is
/// no rank.
std::optional<Rank> take_part_as_rank(PartOptions& options);

/// Calls merge, which throws ConfigError where parts are missing or incomplete, until all are
/// there. A rank that has died leaves none: where no part grows for ten minutes, that is stated.
int merge_when_there(const std::string& folder, const std::function<int()>& merge);

}  // namespace hamel::tools
