// Parts of a piece of work that is cut by index, on machines that share no more than a folder.
#pragma once

#include <hamel/framework/io/export.hpp>

namespace hamel {

/// The part `index` of `count`, from 1.
struct Shard {
  long index = 1, count = 1;
};

/// ConfigError where it is no part, or one of more than 100,000.
HAMEL_API Shard checked(const Shard& part);

}  // namespace hamel
