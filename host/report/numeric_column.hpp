// Finds the columns of a table that contain numbers, which are aligned right.
#pragma once

#include <cstddef>

#include "host/report/content.hpp"

namespace host {

/// Whether every cell of the column starts with a number, a sign before a number, or a dash for "no value".
bool is_numeric_column(const Table& table, std::size_t column);

}  // namespace host
