// Start of a run, as data. Standard-library types only.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace hamel {

/// The start of a run. Left empty: the system's default. At most one of velocity and momentum.
struct Start {
  std::vector<double> configuration = {};  // the element's CSV columns
  std::vector<double> velocity = {};       // body velocity xi, n entries
  std::vector<double> momentum = {};       // body momentum mu, n entries
};

/// A start that a system completes from fewer numbers, and what follows of them that a user may not
/// expect.
struct SystemStart : Start {
  std::vector<std::string> notes = {};
  std::vector<std::string> notes_of_projection =
      {};  // beside these where it is projected onto rows

  SystemStart() = default;
  SystemStart(Start start) : Start(std::move(start)) {}
};

}  // namespace hamel
