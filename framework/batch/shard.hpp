// Parts of a piece of work that is cut by index, on machines that share no more than a folder.
#pragma once

namespace hamel {

/// The part `index` of `count`, from 1.
struct Shard {
  long index = 1, count = 1;
};

}  // namespace hamel
