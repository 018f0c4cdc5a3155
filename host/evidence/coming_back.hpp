// Whether an axis returns to where it was: while it never does, what depends on the position may depend on the time.
#pragma once

#include "host/record/record.hpp"

namespace host {

/// Whether the position goes at least half of its range in each direction. False without a position.
bool comes_back(const Record& record);

}  // namespace host
