// Where a run starts, as data. Standard-library types only.
#pragma once

#include <vector>

namespace hamel {

/// Where a run starts. Left empty: the system's own. At most one of velocity and momentum.
struct Start {
  std::vector<double> configuration = {};  // the element's CSV columns
  std::vector<double> velocity = {};       // body velocity xi, n entries
  std::vector<double> momentum = {};       // body momentum mu, n entries
};

}  // namespace hamel
