// A table as a file .csv, written row by row.
#pragma once

#include <string>

#include <hamel/framework/io/table.hpp>

namespace hamel {

/// The file appears whole or not at all; Unfinished where it cannot be completed.
/// numbered: the name of a first column, the number of the row from 0 on; "" for none.
void write_csv(const Table& table, const std::string& path, const std::string& numbered = "");

}  // namespace hamel
