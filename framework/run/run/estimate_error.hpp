// The error of a run by two finer ones (check). Not installed.
#pragma once

#include <hamel/framework/run/run/plan/plan.hpp>

namespace hamel {

/// The steps of the first `runs` of a run and the two finer ones, in those of the run.
double check_work(const Config& config, int runs);

/// Estimated error and observed order of a run that ended well, or a note why they are not known.
void estimate_error(const Registry& registry, const RunRequest& request, const OwnSystem* own,
                    Result& result);

}  // namespace hamel
