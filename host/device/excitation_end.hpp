// Errors for an excitation that did not complete.
#pragma once

#include <string>

#include "host/device/excitation.hpp"

namespace host {

/// Throws, with the remedy, Failure(device_fault) if the axis has a fault, Failure(refused) if it was stopped, left its
/// box or did not move, Failure(protocol) if rows were lost. `kept`: text that says where the record is; may be empty.
void require_completed(BoardClient& board, std::uint8_t axis, const ExcitationOutcome& outcome,
                       const std::string& kept);

}  // namespace host
