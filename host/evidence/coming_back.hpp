// Whether an axis returns to earlier positions. If it never does, a dependence on position cannot be told from a
// dependence on time.
#pragma once

#include "host/record/record.hpp"

namespace host {

/// Whether the position moves by at least half of its range in each direction. False if there is no position.
bool comes_back(const Record& record);

}  // namespace host
