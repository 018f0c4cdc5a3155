// Commissions an axis step by step, from its data sheet alone.
#pragma once

#include <string>

#include "host/commission/session.hpp"

namespace host {

/// Makes the steps from `from` to `to` (indices in kCommissionSteps). At the end the axis is always disabled and the
/// folder holds the results; the message of a failure says how to continue. A failure restores the board's former
/// parameters, if it had any; so does Cancelled, which a computation throws.
void commission_axis(BoardClient& board, const CommissionOptions& options, const CommissionTalk& talk,
                     CommissionFolder& folder, std::size_t from, std::size_t to);

}  // namespace host
