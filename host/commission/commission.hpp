// From an axis of which nothing but the data sheet is known to one that follows better, step by step.
#pragma once

#include <string>

#include "host/commission/session.hpp"

namespace host {

/// Makes the steps from `from` to `to` (places in kCommissionSteps). However it ends, the axis stands disabled and the
/// folder holds what was found; a failure's message then says how to go on. Where the board had parameters of its own
/// before, a failure gives them back.
void commission_axis(BoardClient& board, const CommissionOptions& options, const CommissionTalk& talk,
                     CommissionFolder& folder, std::size_t from, std::size_t to);

}  // namespace host
