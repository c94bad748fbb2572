// Start of a run, as data. Standard-library types only.
#pragma once

#include <vector>

namespace hamel {

/// The start of a run. Left empty: the system's default. At most one of velocity and momentum.
struct Start {
  std::vector<double> configuration = {};  // the element's CSV columns
  std::vector<double> velocity = {};       // body velocity xi, n entries
  std::vector<double> momentum = {};       // body momentum mu, n entries
};

}  // namespace hamel
